"""Measures what the environments cost, each figure beside its reference of the same run."""

import argparse
from pathlib import Path

from slipgym.benchmarking.run import benchmark
from slipgym.tasks import find


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--env", default="linear_slip", help="task, also LinearSlip or an id (default: %(default)s)"
    )
    parser.add_argument("--pairs", type=int, default=300, help="pairs of timed blocks (default: %(default)s)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there, too")
    parser.add_argument("--learning", action="store_true", help="learning instead; needs the extra train")
    parser.add_argument(
        "--workloads",
        action="store_true",
        help="every task instead: held firmly, about the slip limit, its controller, its learned policy",
    )
    parser.add_argument(
        "--optimisations",
        action="store_true",
        help="what slipgym._numba's optimisations are worth instead",
    )
    arguments = parser.parse_args()
    env_id = find(arguments.env).id
    if arguments.optimisations:
        from slipgym.benchmarking.optimisations import optimisations
        from slipgym.benchmarking.report import line, machine, publish

        print(line(machine()))
        publish(optimisations(env_id, max(3, arguments.pairs // 20)), arguments.json)
    elif arguments.workloads:
        from policies.evaluation.workloads import benchmark as workloads

        workloads(env_id, arguments.pairs, arguments.json)
    elif arguments.learning:
        from policies.training.benchmark import benchmark as learning

        learning(env_id, arguments.pairs, arguments.json)
    else:
        benchmark(env_id, arguments.pairs, arguments.json)


if __name__ == "__main__":
    main()
