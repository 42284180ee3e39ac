"""The command `slipgym benchmark`."""

from policies.console import run

if __name__ == "__main__":
    run("benchmark")
