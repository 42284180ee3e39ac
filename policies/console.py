"""Lets consoles that are not UTF-8 show what the commands print."""

import io
import sys


def spell_out() -> None:
    """Makes output spell a character that its encoding lacks, by its number, instead of raising.

    Consoles of Windows are often cp1252, and so are files that output is redirected to.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
