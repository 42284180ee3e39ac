"""The command `slipgym demonstrate`."""

from policies.console import run

if __name__ == "__main__":
    run("demonstrate")
