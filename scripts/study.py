"""The command `slipgym study`."""

from policies.commands.study import app

if __name__ == "__main__":
    app()
