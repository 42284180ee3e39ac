"""Every command that writes looks at its output before it works, and says what is wrong with it."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from lab.commands import reproduce
from policies.commands import (
    benchmark,
    demo,
    estimate,
    evaluate,
    export_policy,
    identify,
    imitate,
    import_policy,
    leaderboard,
    live,
    play,
    policy_leaderboard,
    record,
    study,
    train,
    warmup,
)
from policies.commands import map as map_

LOG = "examples/linear_slip_wood.csv.gz"
COMMANDS = {
    "demo": (demo, ["--output", "{}"], "policies.evaluation.run.run_trials"),
    "evaluate": (evaluate, ["hold", "--trials", "1", "--output", "{}"], "policies.evaluation.run.run_trials"),
    "estimate": (estimate, [LOG, "--output", "{}"], "estimator.records.load"),
    "imitate": (imitate, ["hold", "--output", "{}"], "policies.training.imitation.run.run"),
    "train": (train, ["hold", "--output", "{}"], "policies.training.run_set.begin"),
    "sweep": (train, ["hold", "--sweep", "1", "--output", "{}"], "policies.training.sweep.begin"),
    "record": (record, ["hold", "{}/r.csv"], "policies.evaluation.sensor_record.record_sensors"),
    "velocity": (
        record,
        ["hold", "fine.csv", "--velocity", "{}/v.csv"],
        "policies.evaluation.sensor_record.record_sensors",
    ),
    "export-policy": (
        export_policy,
        ["hold_scratch", "--onnx", "{}/p.onnx"],
        "policies.learned.onnx_graph.graph_of",
    ),
    "import-policy": (
        import_policy,
        [LOG, "{}/policy", "--environment", "slipgym/Hold-v0"],
        "policies.learned.sb3_zip._member",
    ),
    "play": (play, ["hold", "--video", "{}/v.mp4", "--engine", "planar"], "gymnasium.make"),
    "policy-leaderboard": (
        policy_leaderboard,
        ["hold", "--output", "{}"],
        "policies.policy_leaderboard.run.outcomes",
    ),
    "identify": (identify, [LOG, "--output", "{}"], "slipgym.identification.read_log"),
    "study": (study, ["--output", "{}"], "policies.study.run.episodes"),
    "leaderboard": (leaderboard, ["--output", "{}"], "policies.leaderboard.run.evaluate"),
    "benchmark": (benchmark, ["--json", "{}/b.json"], "slipgym.benchmarking.run.benchmark"),
    "map": (map_, [LOG, "--output", "{}/m.yaml"], "estimator.records.proposal.propose_fingers"),
    "map a picture": (map_, [LOG, "--plot", "{}/m.png"], "estimator.records.proposal.propose_fingers"),
    "live": (live, ["--log", "l.jsonl", "--mcap", "{}/l.mcap"], "policies.commands.live._serve"),
    "warmup": (warmup, ["--into", "{}"], "subprocess.run"),
    "reproduce": (
        reproduce,
        ["coupling", "--output", "{}"],
        "lab.reproduction.reproduce_coupling",
    ),
}


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("where", ["file", "file/deeper", "n" * 300])
def test_a_command_looks_at_its_output_first(tmp_path, monkeypatch, name, where):
    if name == "export-policy":
        pytest.importorskip("onnx")
    if name == "live":
        pytest.importorskip("mcap")
    if name in ("imitate", "train", "sweep"):
        pytest.importorskip("stable_baselines3")
    module, arguments, work = COMMANDS[name]
    (tmp_path / "file").write_text("")

    def begun(*_, **__):
        pytest.fail("it began to work")

    monkeypatch.setattr(work, begun)
    log = Path(LOG).resolve()
    monkeypatch.chdir(tmp_path)
    given = [str(log) if each == LOG else each.format(tmp_path / where) for each in arguments]
    done = CliRunner().invoke(module.app, given)
    assert done.exit_code == 2, (done.output, done.exception)
    assert "cannot write to" in " ".join(done.output.replace("│", " ").split())
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
