"""The command `slipgym record`."""

from policies.commands.record import app

if __name__ == "__main__":
    app()
