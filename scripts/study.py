"""The command `slipgym study`."""

from policies.console import run

if __name__ == "__main__":
    run("study")
