"""The command `slipgym export-policy`."""

from policies.commands.export_policy import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
