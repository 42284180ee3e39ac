"""The command `slipgym export-policy`."""

from policies.commands.export_policy import app

if __name__ == "__main__":
    app()
