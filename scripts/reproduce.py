"""The command `slipgym reproduce`."""

from policies.commands.reproduce import app

if __name__ == "__main__":
    app()
