"""Stores episodes of a policy as a Minari dataset."""

from typing import Annotated

import typer

from policies.commands.several import taking_several

EPILOG = """
Examples:\n
\b
  slipgym demonstrate hold slipgym/hold/controller-v0
  slipgym demonstrate carry_scratch slipgym/carry/learned-v0 --episodes 200
  slipgym demonstrate hold slipgym/hold/hard-v0 --set friction_source=true level=hard
\n
The environment is that of the policy, with the changes of --set. Minari keeps its datasets in
~/.minari/datasets or in MINARI_DATASETS_PATH. It needs the extra minari; docs/libraries/minari.md clones a
policy from such a dataset.
"""
app = typer.Typer(add_completion=False, rich_markup_mode=None, pretty_exceptions_enable=False)


@app.command(epilog=EPILOG, cls=taking_several("--set"))
def main(
    policy: Annotated[str, typer.Argument(help="A name, module:class or folder of a learned one.")],
    dataset: Annotated[str, typer.Argument(help="Name of the dataset: namespace/name-v0.")],
    episodes: Annotated[int, typer.Option(min=1, help="How many.")] = 100,
    seed: Annotated[int, typer.Option(min=0, help="Of the first episode.")] = 0,
    task: Annotated[
        str | None, typer.Option(help="For a controller of every task.", show_default=False)
    ] = None,
    set_: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=VALUE", help="Arguments of the environment; several."),
    ] = None,
) -> None:
    """Play episodes of a policy and store observations, actions and rewards."""
    from policies.commands.several import environment_arguments
    from policies.evaluation.one_policy import demonstrate

    try:
        changes = {"engine": "planar", **environment_arguments(set_ or [])}
        stored = demonstrate(policy, dataset, episodes, seed, task, changes)
    except ModuleNotFoundError as error:
        raise typer.BadParameter(f"{error.name} is not installed: pip install 'slipgym[minari]'") from error
    except (FileNotFoundError, FileExistsError, TypeError, ValueError) as error:
        raise typer.BadParameter(str(error)) from error
    typer.echo(f"{dataset}: {stored.episodes} episodes, {stored.steps} steps, {stored.solved} solved")
