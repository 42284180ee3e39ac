"""Tensors as arrays of numpy and back, at every depth: what a checkpoint holds."""

from __future__ import annotations

from typing import Any

import torch


def arrays(value: Any) -> Any:
    """A value whose tensors are arrays, marked as such."""
    if isinstance(value, torch.Tensor):
        return {"tensor": value.detach().cpu().numpy().copy()}
    if isinstance(value, dict):
        return {key: arrays(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [arrays(item) for item in value] if isinstance(value, list) else tuple(map(arrays, value))
    return value


def tensors(value: Any) -> Any:
    """The reverse of `arrays`."""
    if isinstance(value, dict):
        if set(value) == {"tensor"}:
            return torch.from_numpy(value["tensor"].copy())
        return {key: tensors(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [tensors(item) for item in value] if isinstance(value, list) else tuple(map(tensors, value))
    return value
