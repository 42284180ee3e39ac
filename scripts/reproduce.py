"""The command `slipgym reproduce`."""

from policies.commands.reproduce import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
