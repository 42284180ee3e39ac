"""Reads a file of any known type as tables of named columns, one for each topic or length."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from estimator.records.columns import Wanted, is_wanted
from estimator.records.extras import extra
from estimator.records.separated import read_cells, read_csv
from estimator.records.table import Table
from estimator.suggestions import brief

BYTES = 4 * 10**9
"""Most bytes that are read of a file, uncompressed."""
LARGEST = 4096
"""Most columns of an array or message; one with more is a picture, and is left out."""


def read_sources(path: Path, wanted: Wanted) -> list[Table]:
    """Reads the wanted columns of a file of one of `TYPES`, in any case, or of the folder of a ROS 2 bag.

    Raises:
        FileNotFoundError: There is no such file.
        ModuleNotFoundError: The library for its type is not installed.
        ValueError: It is of another type, or cannot be read as what its name says.
    """
    folder = os.path.isdir(path) and (path / "metadata.yaml").is_file()
    kind = ".db3" if folder else next((end for end in TYPES if path.name.lower().endswith(end)), None)
    if kind is None:
        raise ValueError(
            f"{path.name}: unknown file type; records are {', '.join(TYPES)} and folders of ROS 2 bags; "
            "a table in another text file, once it is unpacked, may be renamed to .csv"
        )
    if not folder:
        extra("estimator.plain_files").check_regular(path)
    reader, libraries = _READERS[kind]
    for library in ("pandas", *libraries):
        extra(library)
    try:
        if not (found := reader(path, wanted)):
            raise ValueError("it has no columns of numbers; MATLAB arrays and structs are read, not tables")
        return found
    except ModuleNotFoundError:
        raise
    except Exception as error:  # a damaged file makes its readers raise anything
        text = brief(error, 300) or type(error).__name__
        raise ValueError(f"{path.name}: cannot be read: {text}") from error


def of_frame(frame: Any) -> Table:
    """The columns of a pandas.DataFrame, and its index where that may be the time."""
    if not isinstance(frame.index, extra("pandas").RangeIndex) or frame.index.name is not None:
        frame = frame.reset_index(allow_duplicates=True)
    names = [str(name).strip() for name in frame.columns]
    return Table(frame.set_axis(names, axis=1), names)


def read_columns(path: Path) -> tuple[dict[str, Any], dict[str, list[str]]]:
    """All columns of a file, by name, and the texts that state their units.

    Columns of different topics or arrays may have different lengths.
    """
    found: dict[str, Any] = {}
    stated: dict[str, list[str]] = {}
    for table in read_sources(path, None):
        for name in table.frame.columns:
            found.setdefault(name, table.frame[name])
            stated.setdefault(name, table.stated(name))
    return found, stated


def _of_arrays(
    arrays: Iterable[tuple[str, Any]], wanted: Wanted, units: Mapping[str, str] | None = None
) -> list[Table]:
    """Groups the columns of named arrays by their length, and loads those that are wanted."""
    names: dict[int, list[str]] = {}
    loaded: dict[int, dict[str, Any]] = {}
    for name, length, load in (column for each in arrays for column in _columns_of(*each)):
        names.setdefault(length, []).append(name)
        found = loaded.setdefault(length, {})
        if is_wanted(name, wanted):
            _refuse_large(8 * length * (1 + sum(map(len, loaded.values()))))
            found[name] = load()
    pandas = extra("pandas")
    return [
        Table(pandas.DataFrame(found, index=pandas.RangeIndex(n), copy=False), names[n], units or {})
        for n, found in loaded.items()
    ]


def _columns_of(name: str, array: Any) -> Iterable[tuple[str, int, Callable[[], Any]]]:
    """The columns of an array (numpy, HDF5): one for each field, and for each place beside the longest axis.

    A column of several is `name[k]`, counted from 0, a field is `name.field`.
    """
    shape, dtype = tuple(array.shape), array.dtype
    if dtype.names:
        _refuse_large(array.nbytes)
        whole = array[...]
        for each in dtype.names:
            yield from _columns_of(f"{name}.{each}", whole[each])
        return
    along = int(np.argmax(shape)) if len(shape) == 2 else 0
    rest = shape[:along] + shape[along + 1 :]
    if not shape or int(np.prod(rest)) > LARGEST:
        return
    for place in np.ndindex(rest):
        at = (*place[:along], slice(None), *place[along:])
        index = f"[{','.join(map(str, place))}]" if int(np.prod(rest)) > 1 else ""
        yield name + index, shape[along], lambda at=at: _plain(array[at])


def _plain(column: Any) -> Any:
    """A column of this machine's byte order, with its texts as texts."""
    if column.dtype.kind in "SO":
        texts = [x.decode("utf-8", "replace") if isinstance(x, bytes) else x for x in column.tolist()]
        return np.array(texts, object)
    return np.ascontiguousarray(column, column.dtype.newbyteorder("="))


def _csv(path: Path, wanted: Wanted) -> list[Table]:
    return [read_csv(path, wanted, only=wanted is not None)]


def _excel(path: Path, wanted: Wanted) -> list[Table]:
    """Each sheet as a csv file; of several, one without a text, and so without names, is left out."""
    with zipfile.ZipFile(path) as file:
        _refuse_large(*(each.file_size for each in file.infolist()))
    book = extra("openpyxl").load_workbook(path, read_only=True, data_only=True)
    try:
        sheets = {sheet.title: [list(row) for row in sheet.iter_rows(values_only=True)] for sheet in book}
    finally:
        book.close()
    sheets = {title: rows for title, rows in sheets.items() if any(any(row) for row in rows)}
    if not sheets:
        raise ValueError("no sheet has cells")
    several = len(sheets) > 1
    named = {
        title: rows for title, rows in sheets.items() if any(isinstance(x, str) for row in rows for x in row)
    }
    found = []
    for title, rows in (named or sheets).items():
        before = f"{title.strip()}/" * several
        own = None if wanted is None else dict.fromkeys(name.removeprefix(before) for name in wanted)
        try:
            table = read_cells(rows, own)
        except ValueError as error:
            raise ValueError(f"sheet {brief(repr(title))}: {error}") from error
        units = {before + name: unit for name, unit in table.units.items()}
        names = [before + name for name in table.names]
        found.append(Table(table.frame.add_prefix(before), names, units, table.comma))
    return found


def _parquet(path: Path, wanted: Wanted) -> list[Table]:
    parquet = extra("pyarrow.parquet")
    names = parquet.read_schema(path).names
    columns = None if wanted is None else [name for name in names if is_wanted(name.strip(), wanted)]
    stored = parquet.read_table(
        path, columns=columns, use_pandas_metadata=True, page_checksum_verification=True, partitioning=None
    )
    # column by column, to save memory
    table = of_frame(stored.to_pandas(split_blocks=True, self_destruct=True))
    del stored
    extra("pyarrow").default_memory_pool().release_unused()
    there = dict.fromkeys([*table.names, *map(str.strip, names)])
    return [Table(table.frame, [name for name in there if not name.startswith("__index_level_")])]


def _npz(path: Path, wanted: Wanted) -> list[Table]:
    def plain(stored: Any) -> Iterable[tuple[str, Any]]:
        for name in stored.files:
            try:
                array = stored[name]
            except ValueError as error:
                if "pickle" not in str(error):
                    raise
                continue  # an array of objects would have to be executed
            yield name, array

    with path.open("rb") as file:
        stored = np.load(file, allow_pickle=False)
        _refuse_large(*(each.file_size for each in stored.zip.infolist()))
        return _of_arrays(plain(stored), wanted)


def _refuse_large(*sizes: int) -> None:
    """Refuses a file that says that it has terabytes, of zeros for example."""
    if sum(sizes) > BYTES:
        raise ValueError(f"what is read has {sum(sizes):.2g} bytes, more than {BYTES:.0e}")


def _hdf5(path: Path, wanted: Wanted, matlab: bool = False) -> list[Table]:
    h5py, datasets, units = extra("h5py"), [], {}
    with h5py.File(path, "r") as file:

        def visit(name: str, item: Any) -> None:
            if isinstance(item, h5py.Dataset) and not item.external and not item.is_virtual:
                if item.dtype.kind not in "OV" or item.dtype.names or h5py.check_string_dtype(item.dtype):
                    datasets.append((name, item))
                said = item.attrs.get("unit", item.attrs.get("units"))
                if isinstance(said, str):
                    units[name] = said

        file.visititems(visit)
        if matlab:
            datasets = [(name.replace("/", "."), item) for name, item in datasets if name[0] != "#"]
        return _of_arrays(datasets, wanted, units)


def _mat(path: Path, wanted: Wanted) -> list[Table]:
    """A file of MATLAB; since version 7.3 it is HDF5."""
    with path.open("rb") as file:
        if file.read(10) == b"MATLAB 7.3":
            return _hdf5(path, wanted, matlab=True)
    values = extra("scipy.io").loadmat(path, squeeze_me=False, struct_as_record=True)
    plain = (name for name in values if name[:2] != "__")
    return _of_arrays((each for name in plain for each in _of_matlab(name, values[name])), wanted)


def _of_matlab(name: str, value: Any, depth: int = 0) -> Iterable[tuple[str, Any]]:
    """The arrays of a variable: of a struct those of its fields."""
    if not isinstance(value, np.ndarray) or depth > 16 or type(value).__name__ == "MatlabOpaque":
        return
    if value.dtype.names:
        if value.size == 1:
            for field_ in value.dtype.names:
                yield from _of_matlab(f"{name}.{field_}", value.flat[0][field_], depth + 1)
    elif value.dtype.kind in "biuf":
        yield name, value


def _bag(path: Path, wanted: Wanted) -> list[Table]:
    return extra("estimator.records.bags").read_bag(path, wanted)


_READERS: dict[str, tuple[Callable[..., list[Table]], tuple[str, ...]]] = {
    ".csv": (_csv, ()),
    ".csv.gz": (_csv, ()),
    ".parquet": (_parquet, ("pyarrow",)),
    ".npz": (_npz, ()),
    ".h5": (_hdf5, ("h5py",)),
    ".hdf5": (_hdf5, ("h5py",)),
    ".mat": (_mat, ()),
    ".xlsx": (_excel, ("openpyxl",)),
    ".mcap": (_bag, ("mcap.reader",)),
    ".bag": (_bag, ("rosbags",)),
    ".db3": (_bag, ("rosbags",)),
}
"""End of a name -> its reader and the libraries that it needs."""
TYPES = tuple(_READERS)
