"""The command `slipgym imitate`."""

from policies.console import run

if __name__ == "__main__":
    run("imitate")
