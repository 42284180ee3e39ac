"""The command `slipgym live`."""

from policies.commands.live import app
from policies.console import spell_out

if __name__ == "__main__":
    spell_out()
    app()
