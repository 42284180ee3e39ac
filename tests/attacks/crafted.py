"""Attacks with files: YAML, policies, records and checkpoints that are changed at random."""

from __future__ import annotations

import hashlib
import io
import json
import tempfile
import zipfile
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import policies
from estimator.records import load as load_record
from policies.learned import files as policy_files
from policies.training import checkpoints
from slipgym.config import files, load, load_randomization
from tests.attacks.arguments import environment
from tests.attacks.cases import ACCEPTED, REFUSED, STOPPED, Attack, attempt, mutated, value

_PIECES = (
    "&a ",
    "*a",
    "<<: ",
    "!!float ",
    "!!timestamp ",
    "[",
    "]",
    "{",
    "}",
    ": ",
    "? ",
    "- ",
    "\n  ",
    "9" * 50,
    "|",
    "'",
)
"""What YAML is made of."""


def _in_a_folder(name: str, content: bytes, read: Any) -> str:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_bytes(content)
        return attempt(lambda: read(path))


def yaml(rng: np.random.Generator) -> str:
    """A configuration or randomization of slipgym, changed."""
    names, read = [("default", load), ("randomization/lab", load_randomization)][rng.integers(2)]
    text = (files.folder() / f"{names}.yaml").read_bytes()
    for _ in range(rng.integers(1, 5)):
        at = int(rng.integers(len(text)))
        text = text[:at] + _PIECES[rng.integers(len(_PIECES))].encode() + text[at:]
    return _in_a_folder("mine.yaml", mutated(rng, text) if rng.random() < 0.5 else text, read)


def policy(rng: np.random.Generator) -> str:
    """A pretrained policy, changed; half of them with checksums that fit."""
    source = policy_files.Path(policies.learned.__file__).parent / "pretrained_policies" / "hold_scratch"
    content = {path.name: path.read_bytes() for path in source.iterdir() if path.is_file()}
    name = sorted(content)[rng.integers(len(content))]
    content[name] = mutated(rng, content[name])
    if rng.random() < 0.5:
        try:
            description = json.loads(content[policy_files.DESCRIPTION])
            description["files"] = {
                each: hashlib.sha256(content[each]).hexdigest() for each in description["files"]
            }
            content[policy_files.DESCRIPTION] = json.dumps(description).encode()
        except (ValueError, KeyError, TypeError):
            pass
    with tempfile.TemporaryDirectory() as folder:
        for each, data in content.items():
            (Path(folder) / each).write_bytes(data)

        def act() -> None:
            made: Any = policies.load(folder)
            made.predict(np.zeros(made.width, np.float32))

        return attempt(act)


@cache
def _record() -> bytes:
    rows = ["t,f_x,f_y,f_n,tau,v_x,v_y,omega"]
    rows += [f"{k / 120:.6f},0.5,0.1,5.0,0.001,0.0{k % 3},0.0,0.0" for k in range(60)]
    return "\n".join(rows).encode()


def record(rng: np.random.Generator) -> str:
    """A sensor record, changed."""
    return _in_a_folder("record.csv", mutated(rng, _record()), load_record)


@cache
def _members() -> dict[str, bytes]:
    """Parts of a checkpoint that holds the state of an environment with PyBullet."""
    env = environment("slipgym/LinearSlip-v0", "bullet")
    env.reset(seed=0)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.checkpoint"
        checkpoints.write(path, {"state": env.get_state()})
        with zipfile.ZipFile(path) as archive:
            return {name: archive.read(name) for name in archive.namelist() if name != "sums.json"}


def checkpoint(rng: np.random.Generator) -> str:
    """A checkpoint with one part changed and checksums that fit; what it holds is restored and stepped."""
    members = dict(_members())
    name = sorted(members)[rng.integers(len(members))]
    if name == "tree.json" and rng.random() < 0.7:
        members[name] = _other_tree(rng, members[name])
    elif name != "tree.json" and rng.random() < 0.7:
        members[name] = _other_numbers(rng, members[name])
    else:
        members[name] = mutated(rng, members[name])
    sums = {each: hashlib.sha256(data).hexdigest() for each, data in members.items()}
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for each, data in {**members, "sums.json": json.dumps(sums).encode()}.items():
            archive.writestr(each, data)

    def resume(path: Path) -> None:
        env = environment("slipgym/LinearSlip-v0", "bullet")
        tree = checkpoints.read(path)
        if not isinstance(tree, dict) or "state" not in tree:
            raise ValueError("it holds no state")
        try:
            env.set_state(tree["state"])
            env.step(np.zeros(env.action_space.shape, np.float32))
        finally:
            env.reset(seed=0)

    return _in_a_folder("a.checkpoint", content.getvalue(), resume)


def _other_tree(rng: np.random.Generator, content: bytes) -> bytes:
    """One value of a tree replaced."""
    tree = json.loads(content)
    node, path = tree, []
    while isinstance(node, dict | list) and len(node):
        keys = list(node) if isinstance(node, dict) else list(range(len(node)))
        path.append((node, keys[rng.integers(len(keys))]))
        node = node[path[-1][1]]
        if rng.random() < 0.15:
            break
    owner, key = path[-1]
    owner[key] = value(rng)
    return json.dumps(tree, default=str).encode()


def _other_numbers(rng: np.random.Generator, content: bytes) -> bytes:
    """Bytes of the numbers of an array replaced by those of extreme numbers."""
    array = np.load(io.BytesIO(content))
    data = bytearray(array.tobytes())
    if len(data) >= 8:
        at = 8 * int(rng.integers(len(data) // 8))
        extreme = [2**62, -(2**62), -1, 0, 255, 10**6][rng.integers(6)]
        data[at : at + 8] = np.int64(extreme).tobytes()
    out = io.BytesIO()
    np.save(out, np.frombuffer(bytes(data), array.dtype).reshape(array.shape))
    return out.getvalue()


ATTACKS = (
    Attack("YAML files", yaml, 40, (ACCEPTED, REFUSED)),
    Attack("policy folders", policy, 40, (ACCEPTED, REFUSED)),
    Attack("records", record, 20, (ACCEPTED, REFUSED)),
    Attack("checkpoints", checkpoint, 30, (ACCEPTED, REFUSED, STOPPED)),
)
