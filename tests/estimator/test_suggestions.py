"""Messages for names and files that do not exist guess what was meant."""

import pytest

import estimator
import policies
from estimator.plain_files import content
from estimator.suggestions import guess, unknown


def test_the_most_similar_name_is_asked_for_whatever_its_case():
    assert guess("Adaptve", ["adaptive", "disc"]) == "did you mean 'adaptive'? "
    assert guess("xyz", ["adaptive", "disc"]) == ""
    assert unknown("unknown key", "fz", ["Fz"]) == "unknown key 'fz'; did you mean 'Fz'? valid: Fz"


@pytest.mark.parametrize(
    ("call", "meant"),
    [
        (lambda: estimator.make("adaptiv"), "adaptive"),
        (lambda: estimator.make("disc", r_mx=0.02), "r_max"),
        (lambda: policies.load("hodl"), "hold"),
        (lambda: policies.make("hold", expolration=None), "exploration"),
    ],
)
def test_a_misspelt_name(call, meant):
    with pytest.raises((ValueError, FileNotFoundError), match=f"did you mean '{meant}'\\?"):
        call()


def test_a_misspelt_file(tmp_path):
    (tmp_path / "columns.yaml").write_text("t: time\n", encoding="utf-8")
    with pytest.raises(FileNotFoundError, match=r"such file; did you mean 'columns\.yaml'\?$"):
        content(tmp_path / "colums.yaml")
    with pytest.raises(FileNotFoundError, match=r"columns\.yaml: no such file$"):
        content(tmp_path / "elsewhere" / "columns.yaml")
