import importlib
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import gymnasium as gym
import pytest

from slipgym.tasks import TASKS

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def own_task_folder(tmp_path_factory) -> Path:
    """A folder that holds the file of docs/adding_a_task.md."""
    page = (ROOT / "docs" / "adding_a_task.md").read_text(encoding="utf-8")
    folder = tmp_path_factory.mktemp("own")
    source = re.findall(r"```python\n(.*?)```", page, re.DOTALL)[0]
    (folder / "slide_to_line.py").write_text(source, encoding="utf-8")
    return folder


@pytest.fixture
def own_task(own_task_folder, monkeypatch) -> Iterator[ModuleType]:
    """That file, imported; the task is gone after the test."""
    monkeypatch.syspath_prepend(own_task_folder)
    yield importlib.import_module("slide_to_line")
    del sys.modules["slide_to_line"], TASKS["SlideToLine"], gym.registry["my/SlideToLine-v0"]
