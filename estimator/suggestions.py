"""Messages for names and files that do not exist, with a guess at what was meant."""

import difflib
from collections.abc import Iterable
from pathlib import Path, PurePath

_LONGEST = 100
"""Characters of a name that are compared and shown."""


def guess(name: object, valid: Iterable[str]) -> str:
    """Ask whether the most similar valid name, whatever its case, was meant; an empty text if none is.

    A file may be asked for without its folder and ending, and an environment without its namespace.
    """
    valid = list(valid)
    lower = {PurePath(known).stem.lower(): known for known in valid} | {
        known.lower(): known for known in valid
    }
    close = difflib.get_close_matches(str(name)[:_LONGEST].lower(), lower, n=1)
    return f"did you mean {lower[close[0]]!r}? " if close else ""


def unknown(what: str, name: object, valid: Iterable[str], also: Iterable[str] = ()) -> str:
    """The message for a name that is not a valid one, with a guess at the one or `also` that was meant."""
    valid = list(valid)
    return f"{what} {f'{name!r}'[:_LONGEST]}; {guess(name, [*valid, *also])}valid: {', '.join(valid)}"


def yaml_beside(path: Path) -> list[str]:
    """Paths of the YAML files in the folder of a path."""
    try:
        return [str(each) for each in path.parent.iterdir() if each.suffix in (".yaml", ".yml")]
    except (OSError, ValueError):  # none, or a name that no folder has
        return []


def brief(value: object, longest: int = 60) -> str:
    """Write a value on one line of a message: unprintable characters escaped, cut where it is too long."""
    text = str(value)
    text = text if text.isprintable() else repr(text)
    return text if len(text) <= longest else f"{text[:longest]}…"


def asking(message: str, name: object, valid: Iterable[str]) -> str:
    """A message, and at its end the guess at the valid name that was meant, if there is one."""
    return f"{message}; {guess(name, valid)}".rstrip("; ")


def no_file(path: Path) -> str:
    """The message for a file that does not exist, with the most similar name in its folder."""
    try:
        there = [each.name for each in path.parent.iterdir()]
    except OSError:
        return f"{path}: no such file"
    return asking(f"{path}: no such file", path.name, there)
