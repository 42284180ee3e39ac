"""The command `slipgym data`."""

from policies.commands.data import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
