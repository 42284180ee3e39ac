"""The command `slipgym`: its help, its sub-commands, names that are misspelt."""

import subprocess
import sys
from pathlib import Path

import gymnasium as gym
import pytest
from typer.testing import CliRunner

import lab.commands
import slipgym
from policies.commands import front
from policies.commands.several import expanded

ROOT = Path(__file__).resolve().parents[2]


def slip(*arguments):
    return CliRunner().invoke(front.app, [*map(str, arguments)], prog_name="slipgym", catch_exceptions=False)


def test_help_names_every_command():
    done = slip("--help")
    assert done.exit_code == 0
    lines = {line.split()[0] for line in done.output.splitlines() if line.startswith("  ") and line.strip()}
    assert lines >= set(front.COMMANDS) | set(lab.commands.COMMANDS)
    assert "..." not in done.output.partition("Commands")[2]  # no line is cut


@pytest.mark.parametrize("name", [*front.COMMANDS, *lab.commands.COMMANDS])
def test_every_command_explains_itself(name):
    done = slip(name, "--help")
    assert done.exit_code == 0
    assert f"Usage: slipgym {name}" in done.output


def test_every_command_explains_itself_without_other_extras():
    """With what the extra "cli" installs."""
    code = """if True:
        import sys
        for name in ("tqdm", "scipy", "joblib", "pyarrow", "imageio_ffmpeg", "moviepy", "torch", "pybullet"):
            sys.modules[name] = None
        from policies.commands import front
        for name in front.COMMANDS:
            try:
                front.main([name, "--help"])
            except SystemExit as done:
                assert not done.code, name
        """
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]


def test_every_command_is_a_script_of_the_same_name():
    commands = {path.stem.replace("_", "-") for path in (ROOT / "scripts").glob("*.py")}
    assert {*front.COMMANDS} - commands == {"demo", "warmup"}


def test_misspelt_names_get_suggestions():
    done = slip("evaluat")
    assert done.exit_code == 2
    assert "Did you mean 'evaluate'" in done.output
    done = slip("validate", "--only", "brekaway")
    assert done.exit_code == 2
    assert "unknown name 'brekaway'" in done.output


def test_without_a_clone_the_commands_of_the_laboratory_say_that_they_need_one(monkeypatch):
    assert set(lab.commands.COMMANDS) == front.OF_THE_LABORATORY
    monkeypatch.setattr(front, "ALL", front.COMMANDS)
    for words in (
        ["hidden-grippers", "--seed", 1],
        ["sensor-bounds"],
        ["seeds"],
        ["sensor-costs"],
        ["validate", "real"],
    ):
        done = slip(*words)
        assert done.exit_code == 2
        assert "is a command of the laboratory, which only a clone" in " ".join(done.output.split())
    assert "laboratory" not in slip("evaluat").output
    assert slip("validate", "--help").exit_code == 0


@pytest.mark.quick_cases("words0-scipy-eval", "words2-torch-train")
@pytest.mark.parametrize(
    ("words", "package", "extra"),
    [
        (["evaluate", "hold", "--output", "{}"], "scipy", "eval"),
        (["record", "hold", "{}/r.csv"], "tqdm", "eval"),
        (["imitate", "hold", "--output", "{}"], "torch", "train"),
        (["train", "hold_scratch", "--output", "{}"], "torch", "train"),
    ],
)
def test_a_package_that_is_missing_is_one_sentence(tmp_path, words, package, extra):
    code = (
        "import sys\n"
        "class Missing:\n"
        "    def find_spec(self, name, *_):\n"
        f"        if name.partition('.')[0] == {package!r}:\n"
        "            raise ModuleNotFoundError(f'No module named {name!r}', name=name)\n"
        "sys.meta_path.insert(0, Missing())\n"
        "from policies.commands import front\n"
        f"front.main({[word.format(tmp_path) for word in words]!r})\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    said = " ".join(done.stderr.replace("│", " ").split())
    assert done.returncode == 2, done.stderr
    assert f"{package} is not installed: pip install 'slipgym[{extra}]'" in said
    assert "Traceback" not in said


@pytest.mark.parametrize(
    ("module", "extra"),
    [
        *[("pandas", "cli"), ("scipy.stats", "eval"), ("h5py", "records"), ("onnx", "onnx")],
        *[("pygame", "window"), ("torch", "train"), ("nothing", "eval")],
    ],
)
def test_the_extra_of_a_missing_package_is_the_smallest(module, extra):
    assert front._extra_of(module) == extra


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["play", "hold", "--seed", "-1"], "greater than or equal to 0"),
        (["record", "hold", "r.csv", "--seed", "-1"], "greater than or equal to 0"),
        (["record", "hold", "r.csv", "--velocity", "r.csv"], "need a file each"),
        (["evaluate", "hold", "--jobs", "0"], "at least 1, or -1"),
        (["study", "quick", "--jobs", "0"], "at least 1, or -1"),
        (["train", "hold", "--jobs", "0"], "at least 1, or -1"),
        (["train", "hold", "--seeds", "0", "0"], "each seed only once"),
        (["map", "log.csv", "--plot", "columns"], "must end with .png"),
        (["policy-leaderboard", "hold", "--imitation", "nowhere"], "no such folder"),
    ],
)
def test_a_value_out_of_range_is_refused_before_any_work(tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    done = slip(*words)
    assert done.exit_code == 2
    assert said in " ".join(done.output.replace("│", " ").split())
    assert not [*tmp_path.iterdir()]


def test_one_policy_is_evaluated_where_experiments_are():
    settings = "engine=planar", "friction_source=true"
    done = slip("evaluate", "--policy", "hold", "--trials", 2, "--set", *settings)
    assert done.exit_code == 0
    assert "hold: solved 2 of 2" in done.output
    done = slip("evaluate", "hold", "--policy", "hold")
    assert done.exit_code == 2
    assert "give experiments or --policy" in done.output


def test_warmup_compiles_what_is_asked_for(monkeypatch):
    made, make = [], gym.make

    def noted(name, **options):
        made.append((name, options))
        return make(name, **options)

    monkeypatch.setattr(gym, "make", noted)
    done = slip("warmup", "--task", "hold", "--engine", "planar")
    assert done.exit_code == 0
    assert [(name, options["engine"]) for name, options in made] == [("slipgym/Hold-v0", "planar")]
    done = slip("warmup", "--task", "hopd")
    assert done.exit_code == 2
    assert "did you mean" in " ".join(done.output.split())


def test_the_package_is_the_command():
    done = subprocess.run(
        [sys.executable, "-m", "slipgym", "--version"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == f"slipgym {slipgym.__version__}"


def test_options_take_several_values():
    several = ("--seeds", "--set")
    line = ["linear_slip", "--seeds", "0", "1", "2", "--budget", "5", "--set", "a=1", "b=2", "--sweep", "3"]
    assert expanded(line, several) == [
        *["linear_slip", "--seeds", "0", "--seeds", "1", "--seeds", "2", "--budget", "5"],
        *["--set", "a=1", "--set", "b=2", "--sweep", "3"],
    ]
    repeated = ["--seeds", "0", "--seeds", "1"]
    assert expanded(repeated, several) == repeated


def test_export_without_onnx_names_the_extra(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "policies.learned.onnx_graph", None)
    done = slip("export-policy", "hold_scratch", "--onnx", tmp_path / "policy.onnx")
    assert done.exit_code == 2
    assert "slipgym[onnx]" in done.output
