"""The command `slipgym imitate`."""

from policies.commands.imitate import app

if __name__ == "__main__":
    app()
