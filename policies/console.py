"""Runs a command from a console, also from one that is not UTF-8."""

import io
import sys
from importlib import import_module


def spell_out() -> None:
    """Makes output spell a character that its encoding lacks, by its number, instead of raising.

    Consoles of Windows are often cp1252, and so are files that output is redirected to.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def run(name: str) -> None:
    """Run the command of a file of `policies.commands` with the command line's arguments."""
    spell_out()
    import_module(f"policies.commands.{name}").app()
