"""The command `slipgym train`."""

from policies.commands.train import app

if __name__ == "__main__":
    app()
