"""The command `slipgym study`."""

from policies.commands.study import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
