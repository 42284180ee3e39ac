"""Prints results again: `python -m lab.results [NAME ...]`, all if none is named."""

import argparse
import sys

from lab.results import RESULTS, find, run


def main() -> None:
    """Run the commands of the named results; exit code 1 if one was not written."""
    parser = argparse.ArgumentParser(prog="python -m lab.results", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="of a file in docs/results")
    parser.add_argument("--list", action="store_true", help="print names and expected minutes, run nothing")
    arguments = parser.parse_args()
    try:
        chosen = find(arguments.names)
    except ValueError as error:
        parser.error(str(error))
    if arguments.list:
        width = max(len(result.name) for result in RESULTS)
        print("\n".join(f"{r.name:<{width}} {r.minutes:>5g} min  {r.question}" for r in chosen))
        return
    sys.exit(1 if run(chosen) else 0)


if __name__ == "__main__":
    main()
