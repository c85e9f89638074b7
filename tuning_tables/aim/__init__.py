"""Aim tables: what commands a park position, and the rule by which it is asked.

A controller needs `read_aim_json` and `aim_exit_speed`; numpy is all they use.
"""

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.axes import AimAxes
from tuning_tables.aim.exit_speed import aim_exit_speed, aim_exit_speeds
from tuning_tables.aim.purpose import (
    AimCategory,
    CategoryAlone,
    Knowledge,
    MeasuredResistance,
    ParkPosition,
    Required,
)
from tuning_tables.aim.reported import Reported

__all__ = [
    "AimAxes",
    "AimCategory",
    "AimTable",
    "CategoryAlone",
    "Knowledge",
    "MeasuredResistance",
    "ParkPosition",
    "Reported",
    "Required",
    "aim_exit_speed",
    "aim_exit_speeds",
]
