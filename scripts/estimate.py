"""The command `slipgym estimate`."""

from policies.console import run

if __name__ == "__main__":
    run("estimate")
