"""Aim tables: what commands a park position, and the rule by which it is asked.

A controller needs `read_json(path, AimTable)` and `aim_exit_speed`; numpy is all they use.
"""

from tuning_tables.aim.aim_tables import AimTable, AimTables, aim_exit_speed
from tuning_tables.aim.axes import AimAxes
from tuning_tables.aim.nodes import Reported
from tuning_tables.aim.purpose import AimCategory, MeasuredResistance, ParkPosition, Required

__all__ = [
    "AimAxes",
    "AimCategory",
    "AimTable",
    "AimTables",
    "MeasuredResistance",
    "ParkPosition",
    "Reported",
    "Required",
    "aim_exit_speed",
]


def __dir__() -> list[str]:
    return __all__
