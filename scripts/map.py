"""The command `slipgym map`."""

from policies.console import run

if __name__ == "__main__":
    run("map")
