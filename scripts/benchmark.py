"""The command `slipgym benchmark`."""

from policies.commands.benchmark import app

if __name__ == "__main__":
    app()
