"""The command `slipgym play`."""

from policies.commands.play import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
