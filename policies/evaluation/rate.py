"""Compares policies at the same rate of action only.

A change of the rate alone changes results: in some tasks a controller collects more at 60 than at 120 actions
a second. So all policies of a comparison act every `frame_skip` control steps.
"""

from __future__ import annotations

from collections.abc import Iterable

import policies
from policies.learned import read_description
from policies.learned.pretrained import locate


def frame_skip_of(name: str) -> int | None:
    """Control steps per action that a policy was trained with; None for a controller, which takes any.

    Raises:
        FileNotFoundError: There is no policy at the path.
        ValueError: What lies there is no policy.
    """
    if policies.is_controller(name):
        return None
    return int(read_description(locate(name)).environment.arguments.get("frame_skip", 1))  # type: ignore[arg-type]


def common_frame_skip(names: Iterable[str], asked: int | None = None) -> int:
    """Control steps per action at which policies can be compared.

    Args:
        names: Of the policies, as `policies.load` takes them.
        asked: What the comparison asks for; None: what the learned policies need, 1 without any.

    Raises:
        ValueError: Two policies need different ones, or one needs another than asked for.
    """
    needed = {name: skip for name in names if (skip := frame_skip_of(name)) is not None}
    found = {*needed.values(), *([] if asked is None else [asked])}
    if len(found) > 1:
        each = ", ".join(f"{name} {skip}" for name, skip in needed.items())
        raise ValueError(
            f"policies are compared at the same rate of action only; frame_skip of the training: {each}"
            + ("" if asked is None else f"; asked for: {asked}")
        )
    return found.pop() if found else 1
