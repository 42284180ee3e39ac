"""The command `slipgym pushes`."""

from policies.commands.pushes import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
