"""The documentation page of an environment: its docstring, with a picture."""

from __future__ import annotations

import importlib
import inspect

from slipgym.envs.slip_env import SlipEnv
from slipgym.registration import ENVIRONMENTS

_NOTE = "<!-- Made by scripts/make_docs.py; what is written by hand stands in slipgym/tasks/. -->"


def page(name: str, environment: type[SlipEnv]) -> str:
    """Markdown page of an environment.

    Args:
        name: Its id.
        environment: Its class.
    """
    use = f'```python\nimport gymnasium as gym\n\nenv = gym.make("slipgym:{name}")\n```'
    picture = (
        f"![{environment.task.name}: view and plots of an episode](../images/{environment.task.key}.png)"
    )
    return f"# {name}\n\n{_NOTE}\n\n{use}\n\n{picture}\n\n{inspect.getdoc(environment)}\n"


def pages() -> dict[str, str]:
    """File name -> page, of every registered environment."""
    written = {}
    for name, entry_point in ENVIRONMENTS.items():
        module, _, cls = entry_point.partition(":")
        environment = getattr(importlib.import_module(module), cls)
        written[f"{environment.task.key}.md"] = page(name, environment)
    return written
