"""The command `slipgym train`."""

from policies.console import run

if __name__ == "__main__":
    run("train")
