"""The command `slipgym data`."""

from policies.console import run

if __name__ == "__main__":
    run("data")
