"""The command `slipgym validate`."""

from policies.commands.validate import app

if __name__ == "__main__":
    app()
