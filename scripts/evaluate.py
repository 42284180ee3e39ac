"""The command `slipgym evaluate`."""

from policies.commands.evaluate import app

if __name__ == "__main__":
    app()
