"""The command `slipgym import-policy`."""

from policies.commands.import_policy import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
