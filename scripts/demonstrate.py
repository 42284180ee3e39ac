"""The command `slipgym demonstrate`."""

from policies.commands.demonstrate import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
