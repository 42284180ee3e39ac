"""Prints the acceptance figures of the physics; exit code 1 if one is not met.

With `--against` it runs the slip suite instead: the same scenes in slipgym and in other engines.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from tqdm import tqdm

from slipgym.validation import EXPERIMENTS, Figure, suite

HEAD = f"{'figure':<54} {'required':>13} {'measured':>13}  ok"


def line(figure: Figure) -> str:
    """One row of the table."""
    required, measured = (f"{value:.3g} {figure.unit}" for value in (figure.bound, figure.measured))
    return f"{figure.name:<54} {'<= ' + required:>13} {measured:>13}  {'yes' if figure.ok else 'NO'}"


def accept(chosen: Sequence[str]) -> int:
    """Print the acceptance figures of some experiments; returns how many are not met."""
    failed = 0
    tqdm.write(HEAD)
    for experiment in tqdm([e for e in EXPERIMENTS if e.__name__ in chosen], disable=None, leave=False):
        for figure in experiment():
            tqdm.write(line(figure))
            failed += not figure.ok
    return failed


def compare(engines: Sequence[str], picture: Path | None) -> None:
    """Print the tables of the slip suite, or draw its figure; engines that are not installed are skipped."""
    chosen, results = [], []
    for engine in dict.fromkeys(("slipgym", *engines)):
        try:
            rows = suite.variants([engine])
            if picture is None:
                results += [suite.measure(row) for row in tqdm(rows, desc=engine, disable=None, leave=False)]
            else:
                suite.check(rows)
            chosen += rows
        except RuntimeError as error:
            tqdm.write(f"skipped: {error}", file=sys.stderr)
    if picture is None:
        print(suite.results_table(results), suite.friction_table(results), sep="\n\n")
    else:
        suite.draw(chosen, picture)


def main() -> int:
    """Measure and print."""
    names = [experiment.__name__ for experiment in EXPERIMENTS]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="+", choices=names, default=names, help="experiments to run")
    parser.add_argument(
        "--against", nargs="+", choices=suite.ENGINES, help="run the slip suite in slipgym and these engines"
    )
    parser.add_argument(
        "--figure", type=Path, help="with --against: draw the suite's figure to this file instead"
    )
    arguments = parser.parse_args()
    if arguments.figure and not arguments.against:
        parser.error("--figure needs --against")
    if arguments.against:
        compare(arguments.against, arguments.figure)
        return 0
    return 1 if accept(arguments.only) else 0


if __name__ == "__main__":
    sys.exit(main())
