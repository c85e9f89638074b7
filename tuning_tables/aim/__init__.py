"""Aim tables: what commands a park position, and the rule by which it is asked.

A controller needs `read_aim_json` and `aim_exit_speed`; numpy is all they use.
"""

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.aim_tables import AimTables
from tuning_tables.aim.axes import AimAxes
from tuning_tables.aim.csv_file import to_aim_csv, write_aim_csv
from tuning_tables.aim.exit_speed import aim_exit_speed
from tuning_tables.aim.json_file import from_aim_json, read_aim_json, to_aim_json, write_aim_json
from tuning_tables.aim.purpose import (
    AimCategory,
    CategoryAlone,
    Knowledge,
    MeasuredResistance,
    ParkPosition,
    Required,
)
from tuning_tables.aim.reported import Reported
from tuning_tables.aim.schema import aim_schema

__all__ = [
    "AimAxes",
    "AimCategory",
    "AimTable",
    "AimTables",
    "CategoryAlone",
    "Knowledge",
    "MeasuredResistance",
    "ParkPosition",
    "Reported",
    "Required",
    "aim_exit_speed",
    "aim_schema",
    "from_aim_json",
    "read_aim_json",
    "to_aim_csv",
    "to_aim_json",
    "write_aim_csv",
    "write_aim_json",
]
