"""The command `slipgym estimate`."""

from policies.commands.estimate import app

if __name__ == "__main__":
    app()
