"""The command `slipgym rank`."""

from policies.commands.rank import app

if __name__ == "__main__":
    app()
