"""YAML from a stranger: what would execute something is refused with words, and nothing runs."""

import pytest
import yaml

from estimator.records import load_columns, parse_settings
from policies.commands import front
from policies.evaluation import load_experiment
from policies.training import files as trainings
from policies.training import folder
from slipgym.config import load, load_randomization

TAGS = {
    "apply": "!!python/object/apply:os.mknod ['{mark}']",
    "new": "!!python/object/new:os.mknod ['{mark}']",
    "eval": "!!python/object/apply:eval [\"__import__('os').mknod('{mark}')\"]",
    "state": "!!python/object/new:tuple [!!python/object/new:map [!!python/name:os.mknod '', ['{mark}']]]",
}


@pytest.mark.parametrize("tag", TAGS)
def test_the_yaml_would_go_off(tmp_path, tag):
    yaml.unsafe_load(f"key: {TAGS[tag].format(mark=tmp_path / 'executed')}")
    assert (tmp_path / "executed").exists()


TRAINING = "task: LinearSlip\nbudget: 10\nenvironment: {{config: {payload}}}\n"
EXPERIMENT = (
    "name: it\ntask: Hold\ntrials: 1\npolicies: [{{name: hold}}]\nfriction: [{{source: none}}]\n"
    "options: {{duration: {payload}}}\n"
)
READERS = {
    "training": (TRAINING, trainings.load),
    "experiment": (EXPERIMENT, load_experiment),
    "configuration": ("object: {{mass: {payload}}}\n", load),
    "randomization": ("friction_scale: {payload}\n", load_randomization),
    "columns": ("f_n: {payload}\n", load_columns),
    "order of a run": ("seed: 0\ntraining: {payload}\n", lambda path: folder.order(path.parent)),
}


@pytest.mark.parametrize("kind", READERS)
@pytest.mark.parametrize("tag", TAGS)
def test_yaml_makes_no_objects(tmp_path, mark, kind, tag):
    text, read = READERS[kind]
    path = tmp_path / "run.yaml"
    payload = TAGS[tag].format(mark=mark)
    for content in (text.format(payload=payload), payload):
        path.write_text(content)
        with pytest.raises(ValueError, match=r"run\.yaml(.|\n)*could not determine a constructor"):
            read(path)


@pytest.mark.parametrize("tag", TAGS)
def test_nor_does_yaml_on_a_command_line(mark, capsys, tag):
    setting = f"key={TAGS[tag].format(mark=mark)}"
    for parse in (parse_settings, lambda texts: trainings.chosen("hold", {}, texts)):
        with pytest.raises(ValueError, match="--set"):
            parse([setting])
    with pytest.raises(SystemExit):
        front.main(["evaluate", "--policy", "hold", "--set", setting])
    assert "the value cannot be read" in capsys.readouterr().err


@pytest.mark.parametrize("order", ["{}", "seed: 1", "training: {}\nseed: x", "training: [1]\nseed: 1"])
def test_the_order_of_a_run_needs_both_parts(tmp_path, order):
    (tmp_path / "run.yaml").write_text(order)
    with pytest.raises(ValueError, match=r"run\.yaml: must hold a mapping 'training' and a whole number"):
        folder.order(tmp_path)
