"""The command `slipgym play`."""

from policies.commands.play import app

if __name__ == "__main__":
    app()
