"""Identifies a gripper from a log: parameters of the simulator with intervals, and a report.

    from slipgym import identification

    result = identification.identify(identification.read_log("log.csv"))
    print(identification.table(result))

The object is fixed on a bench, the gripper holds it and moves along it: the motion that drives the contact is
then that of the wrist, which robots know well, and no model of the object is needed.
"""

from slipgym.identification.fit import Result, identify
from slipgym.identification.log import Log, read_log
from slipgym.identification.report import overrides, table, verdict, write

__all__ = ["Log", "Result", "identify", "overrides", "read_log", "table", "verdict", "write"]
