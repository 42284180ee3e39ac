"""The command `slipgym play`."""

from policies.console import run

if __name__ == "__main__":
    run("play")
