"""Prints the acceptance figures of the physics; exit code 1 if one is not met."""

import argparse
import sys

from tqdm import tqdm

from slipgym.validation import EXPERIMENTS, Figure

HEAD = f"{'figure':<54} {'required':>13} {'measured':>13}  ok"


def line(figure: Figure) -> str:
    """One row of the table."""
    required, measured = (f"{value:.3g} {figure.unit}" for value in (figure.bound, figure.measured))
    return f"{figure.name:<54} {'<= ' + required:>13} {measured:>13}  {'yes' if figure.ok else 'NO'}"


def main() -> int:
    """Measure and print."""
    names = [experiment.__name__ for experiment in EXPERIMENTS]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="+", choices=names, default=names, help="experiments to run")
    chosen = parser.parse_args().only
    failed = 0
    tqdm.write(HEAD)
    for experiment in tqdm([e for e in EXPERIMENTS if e.__name__ in chosen], disable=None, leave=False):
        for figure in experiment():
            tqdm.write(line(figure))
            failed += not figure.ok
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
