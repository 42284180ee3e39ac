"""Messages for names and files that do not exist guess what was meant."""

import pytest

import estimator
import policies
import slipgym
from estimator.plain_files import content
from estimator.suggestions import guess, unknown
from policies.evaluation import load_experiment
from policies.study import load_study
from policies.training import files
from policies.training.imitation.command import configured
from policies.training.imitation.config import read
from slipgym.config import load_randomization
from slipgym.config.level import load_level
from slipgym.tasks import find


def test_the_most_similar_name_is_asked_for_whatever_its_case():
    assert guess("Adaptve", ["adaptive", "disc"]) == "did you mean 'adaptive'? "
    assert guess("xyz", ["adaptive", "disc"]) == ""
    assert unknown("unknown key", "fz", ["Fz"]) == "unknown key 'fz'; did you mean 'Fz'? valid: Fz"


@pytest.mark.parametrize("name", ["Hold-v0", "hold-v0", "slipgym/Hold-v1", "Hold_v0"])
def test_an_id_may_lack_its_namespace(name):
    assert guess(name, ["slipgym/LinearSlip-v0", "slipgym/Hold-v0"]) == "did you mean 'slipgym/Hold-v0'? "


def test_a_file_may_lack_its_ending():
    assert guess("a", ["b.yaml", "a.yaml", "hold"]) == "did you mean 'a.yaml'? "


@pytest.mark.parametrize(
    ("call", "meant"),
    [
        (lambda: estimator.make("adaptiv"), "adaptive"),
        (lambda: estimator.make("disc", r_mx=0.02), "r_max"),
        (lambda: policies.load("hodl"), "hold"),
        (lambda: policies.make("hold", expolration=None), "exploration"),
        (lambda: policies.make("Hold"), "hold"),
        (lambda: policies.find("Hold"), "hold"),
        (lambda: estimator.make("Adaptive"), "adaptive"),
        (lambda: find("Hold-v0"), "slipgym/Hold-v0"),
        (lambda: find("slipgym/Hold-v1"), "slipgym/Hold-v0"),
        (lambda: find("planarslip"), "planar_slip"),
        (lambda: load_level("Hard", "hold"), "hard"),
        (lambda: load_randomization("Train"), "train"),
        (lambda: files.load("Hold_Scratch"), "hold_scratch"),
        (lambda: load_experiment("Demo"), "demo"),
        (lambda: load_study("Quick"), "quick"),
    ],
)
def test_a_misspelt_name(call, meant):
    with pytest.raises((ValueError, FileNotFoundError), match=f"did you mean '{meant}'\\?"):
        call()


@pytest.mark.parametrize(
    "load",
    [
        files.load,
        load_experiment,
        load_study,
        read,
        load_randomization,
        lambda name: load_level(name, "hold"),
        lambda name: configured(name, "hold", {}, []),
    ],
)
@pytest.mark.parametrize("name", ["hold_heavy", "Hold_heavy", "hold_hevy"])
def test_a_file_in_the_working_folder_is_asked_for(load, name, tmp_path, monkeypatch):
    (tmp_path / "hold_heavy.yaml").write_text("{}", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match=r"did you mean 'hold_heavy\.yaml'\?"):
        load(name)
    with pytest.raises(ValueError, match="unknown"):
        load("hold\0x/y")


def test_who_makes_environments_is_said():
    for name, maker in (
        ("make_vec_env", "policies.make_vec_env"),
        ("make_vec", "gymnasium.make_vec"),
        ("make", "gymnasium.make"),
    ):
        with pytest.raises(AttributeError, match=f"has no attribute '{name}'; did you mean '{maker}'"):
            getattr(slipgym, name)
    with pytest.raises(AttributeError, match="did you mean 'register_task'"):
        slipgym.register_tsk  # noqa: B018


def test_a_misspelt_file(tmp_path):
    (tmp_path / "columns.yaml").write_text("t: time\n", encoding="utf-8")
    with pytest.raises(FileNotFoundError, match=r"such file; did you mean 'columns\.yaml'\?$"):
        content(tmp_path / "colums.yaml")
    with pytest.raises(FileNotFoundError, match=r"columns\.yaml: no such file$"):
        content(tmp_path / "elsewhere" / "columns.yaml")
