"""The command `slipgym evaluate`."""

from policies.console import run

if __name__ == "__main__":
    run("evaluate")
