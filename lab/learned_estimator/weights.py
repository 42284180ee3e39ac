"""The file of a network's weights: an npz of plain numbers, read without pickle and checked as a whole."""

import io
import os
import zipfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from estimator.plain_files import check_regular
from lab.learned_estimator.cell import HIDDEN, OUTPUTS, TARGETS
from lab.learned_estimator.features import COLUMNS, REACH

OWN = Path(__file__).with_name("gru.npz")
"""The weights that come with the clone; docs/learned_estimator.md says how they were made."""
LIMIT = 2**20
"""Largest file, packed and unpacked [bytes]."""
LARGEST_SUM = 1e30
"""Bound of every sum in the network, far within float32."""
SHOWN = 300
"""Most characters of a path in an error: its end, which names the file."""
SHAPES: Mapping[str, tuple[int, ...]] = {
    "centre": (COLUMNS,),
    "scale": (COLUMNS,),
    "input_weight": (COLUMNS, 3 * HIDDEN),
    "input_bias": (3 * HIDDEN,),
    "hidden_weight": (HIDDEN, 3 * HIDDEN),
    "hidden_bias": (3 * HIDDEN,),
    "head_of_hidden": (HIDDEN, OUTPUTS),
    "head_of_columns": (COLUMNS, OUTPUTS),
    "head_bias": (OUTPUTS,),
    "start": (TARGETS,),
}
"""Tensor -> its shape; all are float32. The columns are normalised to (x - centre) scale."""
NOTE = "about"
"""Entry with a text: origin and licence."""

Tensors = dict[str, NDArray[np.float32]]


def load(path: str | os.PathLike[str] = "") -> Tensors:
    """Reads the weights of a network.

    Args:
        path: An npz file; empty for the weights that come with the clone.

    Raises:
        FileNotFoundError: There is no such file.
        ValueError: It is no file of such weights, or not whole; the message names the file and the fault.
    """
    return dict(_loaded(OWN)) if not path else _read(Path(path))


@cache
def _loaded(path: Path) -> Tensors:
    return _read(path)


def _read(path: Path) -> Tensors:
    try:
        check_regular(path)
    except FileNotFoundError:
        text = os.fspath(path)
        shown = text if len(text) <= SHOWN else f"...{text[-SHOWN:]}"
        raise FileNotFoundError(f"weights = {shown!r}: there is no such file") from None
    with path.open("rb") as stream:
        data = stream.read(LIMIT + 1)
    if len(data) > LIMIT:
        raise ValueError(f"{path}: is larger than the {LIMIT} bytes of any such network")
    try:
        return _checked(data)
    except (ValueError, OSError, EOFError, KeyError, zipfile.BadZipFile, NotImplementedError) as error:
        raise ValueError(f'{path}: is no file of weights of "gru", or damaged: {error}') from error


def _checked(data: bytes) -> Tensors:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        if sum(entry.file_size for entry in archive.infolist()) > LIMIT:
            raise ValueError(f"it unpacks to more than {LIMIT} bytes")
    with np.load(io.BytesIO(data), allow_pickle=False) as stored:
        held = set(stored.files) - {NOTE}
        if held != set(SHAPES):
            odd = ", ".join(sorted(held ^ set(SHAPES)))
            raise ValueError(f"expected the tensors {', '.join(SHAPES)}; missing or too many: {odd}")
        tensors = {name: stored[name] for name in SHAPES}
    for name, shape in SHAPES.items():
        tensor = tensors[name]
        if tensor.dtype != np.float32 or tensor.shape != shape:
            raise ValueError(f"{name} is {tensor.dtype} {tensor.shape}, expected float32 {shape}")
        if not np.isfinite(tensor).all():
            raise ValueError(f"{name} holds numbers that are not finite")
    _check_reach(tensors)
    return tensors


def _check_reach(tensors: Tensors) -> None:
    """Bounds what the network computes, over all columns and hidden states, by the sizes of its weights.

    Raises:
        ValueError: A sum could overflow, after which the estimates would be NaN for ever.
    """
    sizes = {name: np.abs(tensor.astype(np.float64)) for name, tensor in tensors.items()}
    columns = (REACH + sizes["centre"]) * sizes["scale"]
    reaches = {
        "start": sizes["start"],
        "scale": columns,
        "input_weight": sizes["input_bias"] + columns @ sizes["input_weight"],
        "hidden_weight": sizes["hidden_bias"] + sizes["hidden_weight"].sum(axis=0),  # hidden is within 1
        "head_of_hidden": sizes["head_bias"] + sizes["head_of_hidden"].sum(axis=0),
        "head_of_columns": columns @ sizes["head_of_columns"],
    }
    for name, reach in reaches.items():
        if not reach.max() < LARGEST_SUM:
            raise ValueError(
                f"{name} and its biases allow sums of {reach.max():.3g}, beyond {LARGEST_SUM:g}: the network "
                "could give values that are not finite"
            )


def save(path: str | os.PathLike[str], tensors: Mapping[str, NDArray[np.float32]], note: str) -> None:
    """Writes the weights of a network: the same bytes for the same tensors and note.

    Args:
        path: File to write.
        tensors: Those of `SHAPES`.
        note: Origin and licence.

    Raises:
        ValueError: They are not those of `SHAPES`, or hold numbers that are not finite.
    """
    stream = io.BytesIO()
    arrays = {name: np.ascontiguousarray(tensors[name], np.float32) for name in SHAPES}
    np.savez(stream, **{NOTE: np.array(note)}, **arrays)  # type: ignore[arg-type]
    _checked(stream.getvalue())
    Path(path).write_bytes(stream.getvalue())


def note(path: str | os.PathLike[str] = "") -> str:
    """Origin and licence of weights.

    Args:
        path: As for `load`, whose errors it raises.
    """
    load(path)
    with np.load(path or OWN, allow_pickle=False) as stored:
        return str(stored[NOTE]) if NOTE in stored.files else ""
