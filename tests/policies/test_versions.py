import importlib.metadata
import json

import pytest

from policies.versions import PACKAGES, versions, write_versions


def test_packages_of_every_stage_are_listed(tmp_path):
    write_versions(tmp_path)
    found = json.loads((tmp_path / "versions.json").read_text())
    assert found == versions()
    assert {"python", "platform", *PACKAGES} == set(found)
    assert found["numpy"] == importlib.metadata.version("numpy")


def test_what_is_not_installed_has_no_version(monkeypatch):
    def missing(package):
        raise importlib.metadata.PackageNotFoundError(package)

    monkeypatch.setattr(importlib.metadata, "version", missing)
    assert set(map(versions().get, PACKAGES)) == {None}


def test_a_training_run_lists_what_learns(tmp_path):
    pytest.importorskip("stable_baselines3")
    from policies.training import files, folder

    folder.begin(tmp_path / "run", files.load("linear_slip_plain"), 0)
    found = json.loads((tmp_path / "run" / "versions.json").read_text())
    for package in ("torch", "stable-baselines3", "sb3-contrib"):
        assert found[package] == importlib.metadata.version(package)
