"""Compares policies by what they know about friction."""

from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from policies.commands.several import Jobs, environment_arguments, taking_several, usage_errors

EPILOG = """
Examples:\n
\b
  slipgym evaluate --demo
  slipgym evaluate linear_slip hold --jobs 2
  slipgym evaluate hold --trials 20 --level hard --friction-source estimated --friction-source true
  slipgym evaluate --policy hold --trials 20 --set friction_source=true engine=planar
  slipgym evaluate my_experiment.yaml --seed 1 --output /tmp/runs
\n
An experiment is a YAML file; configs/experiments/ holds those that come with slipgym (linear_slip,
rotational_slip, hinge, planar_slip, hold,
fragile_hold, carry, pivot_to, explore, demo), and docs/evaluation.md says what their keys mean and what
a run writes.
"""
_OUTPUT = Path("runs")
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG, cls=taking_several("--set"))
def main(
    experiments: Annotated[
        list[str] | None,
        typer.Argument(
            help="Names of experiments (a task's: linear_slip, also LinearSlip), or paths of YAML files."
        ),
    ] = None,
    demo: Annotated[bool, typer.Option("--demo", help="Run the experiment 'demo': about a minute.")] = False,
    trials: Annotated[int | None, typer.Option(min=1, help="Trials per cell, not the experiment's.")] = None,
    jobs: Jobs = -1,
    ray: Annotated[str, typer.Option(help="Run on Ray: local, or a cluster's address.")] = "",
    friction_source: Annotated[
        list[str] | None, typer.Option(help="Keep only this source or label of the experiment; repeatable.")
    ] = None,
    output: Annotated[Path, typer.Option(help="Folder for the run's own folder.")] = _OUTPUT,
    seed: Annotated[int | None, typer.Option(min=0, help="Seed instead of the experiment's.")] = None,
    level: Annotated[
        str | None, typer.Option(help="Level of difficulty instead of the experiment's.")
    ] = None,
    policy: Annotated[
        str | None,
        typer.Option(
            help="Instead: one policy in its environment, a name, module:class or folder of a learned one."
        ),
    ] = None,
    task: Annotated[str | None, typer.Option(help="With --policy: for a controller of every task.")] = None,
    set_: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="With --policy: arguments of its environment."),
    ] = None,
) -> None:
    """Run experiments: policies x friction information x materials.

    Each writes one folder with the table of trials, a summary with confidence intervals and figures, and
    prints where to look. A run that is broken off keeps the trials of its complete cells.
    """
    if policy is not None:
        if demo or experiments:
            raise typer.BadParameter("give experiments or --policy")
        for name, value in (("level", level), *(("friction_source", one) for one in friction_source or [])):
            if value is not None:
                raise typer.BadParameter(f"with --policy: --set {name}={value}")
        for name, given in {"output": output != _OUTPUT, "jobs": jobs != -1, "ray": ray}.items():
            if given:
                raise typer.BadParameter(f"--{name} is for experiments; --policy runs here, without a folder")
        typer.echo(_outcome(policy, trials or 100, seed, task, set_ or []))
        return
    if set_ or task:
        raise typer.BadParameter("--set and --task are for --policy; an experiment names its own")
    from policies import evaluation, parallel

    if demo == bool(experiments):
        known = ", ".join(evaluation.experiment_names())
        raise typer.BadParameter(f"give experiments ({known}, or YAML files) or --demo")
    with usage_errors(ValueError, FileNotFoundError, ModuleNotFoundError):
        parallel.check(ray)
        chosen = [
            evaluation.narrowed(evaluation.load_experiment(name), trials, seed, friction_source or (), level)
            for name in experiments or ["demo"]
        ]
        for experiment in chosen:
            evaluation.check(experiment)
    for experiment in chosen:
        try:
            folder = evaluation.evaluate(experiment, output, jobs, ray=ray)
        except ConnectionError as error:
            raise typer.BadParameter(str(error), param_hint="--ray") from error
        except OSError as error:
            words = "; ".join([str(error), *getattr(error, "__notes__", ())])
            raise typer.BadParameter(words, param_hint="--output") from error
        except KeyboardInterrupt as error:
            typer.echo("\n".join(["", *getattr(error, "__notes__", ())]), err=True)
            raise
        typer.echo("\n" + evaluation.report(folder))


def _outcome(policy: str, episodes: int, first: int | None, task: str | None, texts: list[str]) -> str:
    from tqdm import tqdm

    from policies.evaluation import one_policy

    start = one_policy.FRESH if first is None else first
    with ExitStack() as stack:
        with usage_errors(FileNotFoundError, TypeError, ValueError):
            changes = environment_arguments(texts)
            acting = stack.enter_context(one_policy.opened(policy, task, changes))
        found = one_policy.played(*acting, episodes, start)
        return one_policy.outcome(policy, list(tqdm(found, total=episodes, disable=None, leave=False)))
