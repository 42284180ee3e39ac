"""Runs the commands of the results one after another."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Sequence

from lab.results import files
from lab.results.declarations import Result


def run(results: Sequence[Result]) -> list[str]:
    """Run the commands of some results and write their files; prints progress to standard error.

    A result whose command fails, or that needs a file which is not there, keeps its file.

    Args:
        results: Their declarations.

    Returns:
        The names of the results that were not written.
    """
    at, failed = files.commit(), []
    for k, result in enumerate(results, 1):
        _say(f"[{k} of {len(results)}] {result.name}: about {result.minutes:g} min")
        start = time.monotonic()
        try:
            files.write(result, printed(result), at)
        except (OSError, ValueError, subprocess.CalledProcessError) as error:
            _say(f"  not written: {error}")
            failed.append(result.name)
        else:
            _say(f"  {files.path(result).relative_to(files.ROOT)}, {(time.monotonic() - start) / 60:.1f} min")
    return failed


def printed(result: Result) -> list[str]:
    """The standard output of each command of a result; their progress goes to standard error.

    Raises:
        FileNotFoundError: What the result needs is not there.
        subprocess.CalledProcessError: A command fails.
    """
    if result.needs and not (files.ROOT / result.needs).exists():
        raise FileNotFoundError(f"{result.needs} is missing; docs/{result.page} says where it comes from")
    outputs = []
    for arguments in result.arguments:
        _say(f"  slipgym {' '.join(arguments)}")
        command = [sys.executable, "-m", "slipgym", *arguments]
        done = subprocess.run(command, cwd=files.ROOT, check=True, stdout=subprocess.PIPE, text=True)
        outputs.append(done.stdout)
    return outputs


def _say(line: str) -> None:
    """Print a line of progress."""
    print(line, file=sys.stderr, flush=True)
