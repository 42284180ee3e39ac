"""The command `slipgym live`."""

from policies.console import run

if __name__ == "__main__":
    run("live")
