"""The command `slipgym identify`."""

from policies.console import run

if __name__ == "__main__":
    run("identify")
