"""The command `slipgym import-policy`."""

from policies.commands.import_policy import app

if __name__ == "__main__":
    app()
