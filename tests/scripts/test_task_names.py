"""Every command line takes every spelling of a task's name, and its help shows the canonical one."""

import pytest

from policies.evaluation import load_experiment

SPELLINGS = ["hold", "Hold", "slipgym/Hold-v0", "slipgym.tasks.hold:TASK"]
spelled = pytest.mark.parametrize("name", SPELLINGS)
SHORT = ["--option", "duration=0.2"]


@pytest.fixture
def called(invoke):
    """What a script prints."""

    def call(name, *arguments):
        done = invoke(name, *arguments)
        assert done.exit_code == 0, done.output
        return done.output

    return call


@spelled
def test_train(name):
    from policies.training.files import chosen

    expected = chosen("hold", {}, [])
    assert chosen(name, {}, []) == chosen(None, {"task": name}, []) == expected
    assert chosen("hold", {}, [f"task={name}"]) == expected


@spelled
def test_evaluate_and_compare_engines(name):
    assert load_experiment(name) == load_experiment("hold")


@spelled
def test_study(name):
    from policies.study import load_study, narrowed

    assert narrowed(load_study("quick"), tasks=[name]).tasks[0] in ("Hold", name)


@spelled
def test_play_and_record(name, tmp_path, called):
    assert "held" not in called("play", name, "--video", tmp_path / "a.gif", *SHORT)
    assert (tmp_path / "a.gif").exists()
    assert "a.csv" in called("record", name, tmp_path / "a.csv", *SHORT)
    called("record", name, "hold", tmp_path / "b.csv", *SHORT)
    called("record", name, tmp_path / "c.csv", "--policy", "hold", *SHORT)
    contents = {(tmp_path / f"{file}.csv").read_bytes() for file in "abc"}
    assert len(contents) == 1


@spelled
def test_evaluate_one_policy(name, called):
    printed = called(
        "evaluate", "--policy", "constant_force", "--task", name, "--trials", "1", "--set", "engine=planar"
    )
    assert "of 1, dropped 0" in printed


def test_settings_of_the_environment_add_up(invoke):
    """Two --set are both heard."""
    done = invoke("evaluate", "--policy", "hold", "--set", "engine=wrong", "--set", "material=wood")
    assert done.exit_code == 2
    assert "wrong" in done.output


@pytest.mark.parametrize("name", ["train", "evaluate", "play", "record", "study", "compare_engines"])
def test_help_shows_the_canonical_name(name, called):
    text = " ".join(called(name, "--help").split())
    assert "linear_slip" in text
    assert "LinearSlip" in text
