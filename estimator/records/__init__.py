"""Runs an estimator on a record: a table of forces and slip velocities from a simulator or a real gripper.

    from estimator import records

    record = records.load("log.csv", records.load_columns("mapping.yaml"))
    result = records.estimate(record)
    print(records.report(result))

`from_arrays` takes arrays and DataFrames. pandas, PyYAML and matplotlib are imported when a function needs
them: the extra `slipgym[cli]`; what reads other files than csv comes with `slipgym[records]`.
"""

from estimator.records.calibration import Calibration, Found
from estimator.records.columns import Column, Columns, load_columns
from estimator.records.reading import from_arrays, load
from estimator.records.record import Record
from estimator.records.results import parse_settings, run_name, write
from estimator.records.run import Result, estimate
from estimator.records.summary import report

__all__ = [
    "Calibration",
    "Column",
    "Columns",
    "Found",
    "Record",
    "Result",
    "estimate",
    "from_arrays",
    "load",
    "load_columns",
    "parse_settings",
    "report",
    "run_name",
    "write",
]
