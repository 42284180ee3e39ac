"""The command `slipgym validate`."""

from policies.console import run

if __name__ == "__main__":
    run("validate")
