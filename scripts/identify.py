"""The command `slipgym identify`."""

from policies.commands.identify import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
