"""Every keyword argument is declared once, and signatures, docstrings and pages show it."""

import inspect
import re
from pathlib import Path

import pytest

import slipgym.envs
from slipgym.envs import SlipEnv, vector_env
from slipgym.envs.actions import ACTION_MODES
from slipgym.envs.arguments import CommonArguments, ScalarArguments, VectorArguments, complete, fields
from slipgym.envs.vector_env import SlipVectorEnv

DOCS = Path(__file__).parents[2] / "docs"
KINDS = [(SlipEnv, ScalarArguments), (SlipVectorEnv, VectorArguments)]


@pytest.mark.parametrize(("cls", "kind"), KINDS)
def test_every_argument_is_in_signature_and_docstring(cls, kind):
    parameters, text = inspect.signature(cls).parameters, inspect.getdoc(cls) or ""
    for name, field in fields(kind).items():
        assert parameters[name].default == field.default
        assert re.search(rf"^ +{name}: {re.escape(field.text[0].upper())}", text, re.MULTILINE), name
        for choice in field.choices:
            assert f'"{choice}"' in text
    assert "{arguments}" not in text


def test_every_argument_is_on_the_common_page():
    page = (DOCS / "environments" / "common.md").read_text(encoding="utf-8")
    for field in fields(ScalarArguments).values():
        assert f"| `{field.name}` |" in page


def test_every_argument_of_the_vector_environment_alone_is_on_its_page():
    page = (DOCS / "batch.md").read_text(encoding="utf-8")
    for name in fields(VectorArguments).keys() - fields(CommonArguments).keys():
        assert f"| `{name}` |" in page, name


def test_action_modes_are_those_of_the_argument():
    assert fields(CommonArguments)["action_mode"].choices == tuple(ACTION_MODES)


def test_defaults_are_allowed_and_complete():
    for _, kind in KINDS:
        assert complete(kind, {}) == {name: field.default for name, field in fields(kind).items()}


def test_classes_are_shown():
    for name in ("LinearSlipEnv", "HoldEnv", "SlipEnv", "SlipVectorEnv"):
        assert name in dir(slipgym.envs)
        assert name in slipgym.envs.__all__
        assert inspect.isclass(getattr(slipgym.envs, name))
    assert "HingeVectorEnv" in dir(vector_env)
