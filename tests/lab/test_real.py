"""Real data: laws with known answers through the analyses, safe reading of records, the extracts."""

import io
import pickle
import zipfile

import numpy as np
import pandas as pd
import pytest

from lab.real import silicone, tugs
from policies.commands.front import main


def archive(**members):
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as file:
        for name, content in members.items():
            file.writestr(f"seq_0/{name.replace('__', '/').replace('_pkl', '.pkl')}", content)
    return data.getvalue()


class Bomb:
    def __reduce__(self):
        return pytest.fail, ("a stranger's pickle ran",)


def test_a_record_is_read_and_its_pickle_never_runs():
    field = np.random.default_rng(0).normal(size=tugs.SHAPE).astype("<f4")
    data = archive(data_pkl=pickle.dumps(Bomb()), data__0=field.tobytes())
    np.testing.assert_array_equal(tugs.record(data), field)


@pytest.mark.parametrize(
    "data",
    [b"", b"garbage", archive(data_pkl=b"."), archive(data__0=bytes(36001)), archive(data__0=bytes(400))],
)
def test_garbage_is_no_record(data):
    with pytest.raises(ValueError, match="not a record"):
        tugs.record(data)


def test_a_ramp_has_its_speed_and_its_excursion():
    """Both filters keep a cubic as it is; the ramp is far from the ends of the record."""
    field = np.zeros(tugs.SHAPE)
    field[100:200, 1, 3] = 2.0 * np.arange(100)
    field[200:, 1, 3] = 200.0
    speed_0, speed_1, excursion_0, excursion_1 = tugs.scores(field)
    assert speed_0 == excursion_0 == 0.0
    assert speed_1 == pytest.approx(2.0, rel=0.15)
    assert excursion_1 == pytest.approx(200.0, rel=0.01)


def test_the_area_counts_pairs():
    score, tugged = np.array([3.0, 1.0, 2.0, 2.0]), np.array([True, True, False, False])
    assert tugs.area(score, tugged) == 0.5
    assert tugs.area(np.array([3.0, 2.0, 2.0, 0.0]), tugged) == 0.875
    assert np.isnan(tugs.area(score, np.ones(4, bool)))


def test_an_exponent_is_found_and_one_load_has_none():
    load = np.geomspace(0.01, 7.0, 12)
    table = pd.DataFrame({"rig": "exact", "load": load, "mu": 1.3 * load**-0.31})
    row = silicone.exponents(table, 20, 0).iloc[0]
    assert row["a"] == row["lower half"] == row["upper half"] == "0.31 [0.31, 0.31]"
    assert row["largest [%]"] < 1e-9
    assert np.isnan(silicone.exponent(np.ones(5), np.ones(5)))


def test_the_extracts_give_the_figures_of_the_pages():
    friction = silicone.exponents(pd.read_csv(silicone.EXTRACT, comment="#"), 50, 0).set_index("rig")["a"]
    assert friction["Nanotribometer DragonSkin10"].startswith("0.25 [")
    assert friction["Nanotribometer Smooth-on Sil 950"].startswith("−0.23 [")
    grasps = pd.read_csv(tugs.EXTRACT, comment="#")
    assert (len(grasps), grasps["tugged"].sum()) == (137, 103)
    found = tugs.areas(grasps, 50, 0)["area"].str[:4].astype(float)
    assert (found[:2] < 0.6).all()
    assert (found[2:] > 0.95).all()


def test_two_words_name_the_command(capsys):
    with pytest.raises(SystemExit) as left:
        main(["validate", "real", "--help"])
    assert left.value.code == 0
    assert "slipgym validate-real" in capsys.readouterr().out


def test_a_folder_without_the_sets_is_a_usage_error(tmp_path, capsys):
    for more in ([], ["--extract"]):
        with pytest.raises(SystemExit) as left:
            main(["validate-real", "--data", str(tmp_path), *more])
        assert left.value.code == 2
        assert "slipgym data silicone" in " ".join(capsys.readouterr().err.split())
