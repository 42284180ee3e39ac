"""The results: what is kept of an output, how a file is written, and what happens when a command fails."""

import importlib.util
import subprocess

import pytest

from lab.results import files, find, run
from lab.results.declarations import RESULTS, Result, read

TABLE = "| a | long name |\n| ---: | --- |\n| 1 | x |\n| 22.5 | yy |\n"
PADDED = "|    a | long name |\n| ---: | --------- |\n|    1 | x         |\n| 22.5 | yy        |"
ROOT = files.ROOT
RESULT = Result("speed", "Speed of a thing", ("first", "second --fast"), "page.md", 1)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty clone in which every command prints its own words."""
    monkeypatch.setattr(files, "ROOT", tmp_path)
    monkeypatch.setattr(files, "FOLDER", tmp_path / "docs" / "results")
    monkeypatch.setattr(files, "INDEX", tmp_path / "docs" / "results" / "README.md")
    for words in (["init", "-q"], ["commit", "-q", "--allow-empty", "-m", "a"]):
        name = ["-c", "user.name=a", "-c", "user.email=a@example.org"]
        subprocess.run(["git", *name, *words], cwd=tmp_path, check=True)
    (tmp_path / "slipgym.py").write_text("import sys\nprint(*sys.argv[1:])\nsys.exit('fail' in sys.argv)\n")
    return tmp_path


def test_tables_are_padded_and_paths_are_left_out():
    printed = f"# Title\n\nWords.\n\n{TABLE}\nLook at:\n  /home/me/runs/x.png\n"
    assert files.body(RESULT, printed) == f"Words.\n\n{PADDED}"


def test_the_first_line_and_the_sections_that_are_kept():
    printed = f"one\nSolved [%]\n## A\n\n1\n## B\n\n2\n\n## C\n{TABLE}"
    assert files.body(RESULT._replace(begins="Solved"), printed).startswith("Solved [%]")
    assert files.body(RESULT._replace(keep=("C", "A")), printed) == f"## C\n\n{PADDED}\n\n## A\n\n1"
    with pytest.raises(ValueError, match="speed: the output has no section D"):
        files.body(RESULT._replace(keep=("A", "D")), printed)
    with pytest.raises(ValueError, match="speed: nothing was printed"):
        files.body(RESULT._replace(begins="Never"), printed)


def test_commands_are_run_and_written_with_the_commit(folder, capfd):
    assert run([RESULT]) == []
    text = (folder / "docs/results/speed.txt").read_text()
    assert text.startswith("Speed of a thing\n\ncommand: slipgym first\ncommand: slipgym second --fast\n")
    assert f"commit {files.commit()}\n" in text
    assert text.endswith("\n\n## first\n\nfirst\n\n## second --fast\n\nsecond --fast\n")
    assert "[1 of 1] speed: about 1 min" in capfd.readouterr().err
    assert (folder / "docs/results/README.md").read_text() == files.index()


def test_a_result_that_is_not_printed_yet_has_a_head_and_is_replaced(folder):
    text = files.awaited(RESULT)
    assert text.endswith("command: slipgym second --fast\nprinted: not yet\npage:    docs/page.md\n\n")
    hook = importlib.util.spec_from_file_location("hook", ROOT / "docs" / "site" / "results.py")
    page = importlib.util.module_from_spec(hook)
    hook.loader.exec_module(page)
    assert page.shown(text) == "*Printed: not yet*"
    (folder / "docs/results").mkdir(parents=True)
    (folder / "docs/results/speed.txt").write_text(text)
    assert run([RESULT]) == []
    assert "not yet" not in (folder / "docs/results/speed.txt").read_text()


def test_the_pictures_of_a_run_are_taken(folder, monkeypatch):
    monkeypatch.setattr(files, "IMAGES", folder)
    (folder / "runs").mkdir()
    (folder / "runs" / "table.png").write_bytes(b"picture")
    drawing = RESULT._replace(pictures={"table.png": "speed_table.png"})
    files.write(drawing, ["1 m/s\n\nLook at:\n  runs/table.png\n"], "0123abcd")
    assert (folder / "speed_table.png").read_bytes() == b"picture"
    with pytest.raises(ValueError, match="speed: the run has no picture table"):
        files.write(drawing, ["1 m/s\n"], "0123abcd")


def test_a_tree_with_changes_is_marked_but_not_for_pages_and_pictures(folder):
    for name, marked in (("docs/images/table.png", False), ("file", True)):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("a")
        subprocess.run(["git", "add", name], cwd=folder, check=True)
        assert files.commit().endswith(" + changes") == marked


def test_a_failure_keeps_the_file_and_goes_on(folder, capfd):
    run([RESULT])
    before = (folder / "docs/results/speed.txt").read_text()
    failing = [
        RESULT._replace(commands=("fail",)),
        RESULT._replace(needs="data"),
        RESULT._replace(name="other"),
    ]
    assert run(failing) == ["speed", "speed"]
    assert (folder / "docs/results/speed.txt").read_text() == before
    assert (folder / "docs/results/other.txt").is_file()
    assert "data is missing; docs/page.md says where it comes from" in capfd.readouterr().err


def test_results_are_found_by_name():
    assert find([]) == RESULTS
    assert [result.name for result in find(["jumps", "pushes"])] == ["jumps", "pushes"]
    with pytest.raises(ValueError, match="unknown result 'jump'; did you mean 'jumps'"):
        find(["jump"])


@pytest.mark.parametrize(
    ("entry", "message"), [("{command: a, page: b, minutes: 1}", "question"), ("{color: red}", "color")]
)
def test_a_wrong_declaration_is_an_error(tmp_path, entry, message):
    path = tmp_path / "results.yaml"
    path.write_text(f"speed: {entry}\n")
    with pytest.raises(ValueError, match=rf"results\.yaml: speed: .*{message}"):
        read(path)
