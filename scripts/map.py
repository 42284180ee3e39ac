"""The command `slipgym map`."""

from policies.commands.map import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
