"""The command `slipgym pushes`."""

from policies.commands.pushes import app

if __name__ == "__main__":
    app()
