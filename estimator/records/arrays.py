"""Reads files of named arrays: npz, HDF5 and MATLAB; executes nothing that is in them."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from estimator.records.extras import extra
from estimator.suggestions import brief

BYTES = 2 * 10**9
"""Most bytes of all arrays of a file, uncompressed: a small file may hold terabytes of zeros."""
_NUMBERS = "iufb"
"""Kinds of dtypes that hold numbers."""
_MOST_COLUMNS = 64
"""Most columns of a two-dimensional array; an array with more is a picture or a map of pressure."""


def read_arrays(path: Path) -> dict[str, np.ndarray]:
    """Reads the columns of a file: one-dimensional arrays, and the columns of two-dimensional ones.

    Column k of an array `force` is called `force[k]`, a field of a structure or a group `log.force` or
    `log/force`. The longer axis is the time.

    Raises:
        Exception: Whatever the reader of a damaged file raises.
        ModuleNotFoundError: A package is not installed.
    """
    found: dict[str, np.ndarray] = {}
    for name, array in _READERS[path.suffix.lower()](path).items():
        for each, values in _columns(name, array):
            found[each] = values
    return found


def frame_of(found: Mapping[str, np.ndarray], time: str) -> Any:
    """The columns that have as many values as the time, as a pandas.DataFrame.

    Args:
        found: From `read_arrays`.
        time: Name of the column of times; without it, the frame has all names and no rows.
    """
    frame = extra("pandas").DataFrame
    if time not in found:
        return frame(columns=list(found))
    n = len(found[time])
    return frame({name: values for name, values in found.items() if len(values) == n})


def _columns(name: str, array: Any) -> list[tuple[str, np.ndarray]]:
    array = np.asarray(array)
    if array.dtype.names:  # a table in one array
        return [column for field in array.dtype.names for column in _columns(f"{name}.{field}", array[field])]
    if array.dtype.kind not in _NUMBERS + "Mm":
        return []
    array = np.squeeze(array)
    if array.ndim == 1:
        return [(name, array)]
    if array.ndim != 2 or min(array.shape) > _MOST_COLUMNS:
        return []
    rows = array if array.shape[0] >= array.shape[1] else array.T
    return [(f"{name}[{k}]", rows[:, k]) for k in range(rows.shape[1])]


def _npz(path: Path) -> dict[str, np.ndarray]:
    with zipfile.ZipFile(path) as file:
        _refuse_large(sum(each.file_size for each in file.infolist()))
    found = {}
    with np.load(path, allow_pickle=False) as file:
        for name in file.files:
            try:
                found[name] = file[name]
            except ValueError as error:
                if "pickle" not in str(error):
                    raise  # an array of objects is left out: it would have to be executed
    return found


def _hdf5(path: Path) -> dict[str, np.ndarray]:
    h5py, found, size = extra("h5py", "records"), {}, 0

    def visit(name: str, node: Any) -> None:  # never called for links to other files
        nonlocal size
        if not isinstance(node, h5py.Dataset) or node.ndim not in (1, 2):
            return
        if node.external or node.is_virtual:
            raise ValueError(f"{brief(name)} lies in another file")
        if node.dtype.kind in _NUMBERS + "V" and not node.dtype.hasobject:
            size += node.nbytes
            _refuse_large(size)
            found[name] = node[...]

    with h5py.File(path, "r") as file:
        file.visititems(visit)
    return found


def _matlab(path: Path) -> dict[str, np.ndarray]:
    with path.open("rb") as file:
        newer = file.read(128)[124:126] in (b"\x00\x02", b"\x02\x00")
    if newer:  # version 7.3 is HDF5
        return {name.replace("/", "."): array for name, array in _hdf5(path).items()}
    io, found = extra("scipy.io", "records"), {}
    size = {"double": 8, "single": 4}
    _refuse_large(sum(int(np.prod(shape)) * size.get(kind, 8) for _, shape, kind in io.whosmat(path)))

    def walk(name: str, value: Any) -> None:
        if isinstance(value, dict):
            for key, each in value.items():
                if not key.startswith("__"):
                    walk(f"{name}.{key}" if name else key, each)
        elif isinstance(value, np.ndarray):
            found[name] = value

    walk("", io.loadmat(path, simplify_cells=True))
    return found


def _refuse_large(size: int) -> None:
    if size > BYTES:
        raise ValueError(
            f"its arrays have {size:.2g} bytes, more than {BYTES:.0e}: write what is needed alone"
        )


_READERS: Mapping[str, Callable[[Path], dict[str, np.ndarray]]] = {
    ".npz": _npz,
    ".h5": _hdf5,
    ".hdf5": _hdf5,
    ".mat": _matlab,
}
TYPES = tuple(_READERS)
