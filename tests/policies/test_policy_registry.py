import pytest

import policies


def test_names():
    assert {"constant_force", "hold", "linear_slip"} <= set(policies.names())


def test_unknown_name_lists_the_valid_ones():
    with pytest.raises(ValueError, match=r"'linear'.*constant_force.*linear_slip"):
        policies.make("linear")


def test_unknown_parameter_lists_the_valid_ones():
    with pytest.raises(ValueError, match=r"'newton'.*force, config"):
        policies.make("constant_force", newton=3.0)


@pytest.mark.parametrize("force", [0.0, 26.0, float("nan")])
def test_forces_out_of_range_are_refused(force):
    with pytest.raises(ValueError, match=r"0\.6 to 25 N"):
        policies.make("constant_force", force=force)


def test_loading_nothing_and_the_wrong_thing(tmp_path):
    with pytest.raises(FileNotFoundError, match="linear_slip"):
        policies.load(tmp_path / "nowhere")
    (tmp_path / "junk.zip").write_bytes(b"junk")
    with pytest.raises(ValueError, match=r"junk\.zip"):
        policies.load(tmp_path / "junk.zip")
