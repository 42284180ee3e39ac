"""The command `slipgym record`."""

from policies.console import run

if __name__ == "__main__":
    run("record")
