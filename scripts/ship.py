"""The command `slipgym ship`."""

from policies.commands.ship import app

if __name__ == "__main__":
    app()
