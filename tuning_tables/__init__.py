"""Tuning tables: the artefact that a trackside controller loads, and the rule by which it decides.

A controller with a radar needs `read_json` and `decide_for`; one with point sensors needs `read_table`,
`begin_tracking` and `stage_at_pulse`. numpy is all they use. Books in HDF5 need h5py when called. Aim tables are in
`tuning_tables.aim`, measured passes in `tuning_tables.pass_log`.
"""

from tuning_tables.active_table import ActiveTable
from tuning_tables.csv_file import to_csv, write_csv
from tuning_tables.decisions import Approach, Decisions, Interlock, RegulatorClock
from tuning_tables.document import table_schema
from tuning_tables.errors import DamagedTable, InvalidTable, NewerVersion, OtherKind, TableError, UnknownFormat
from tuning_tables.estimator import Estimator, begin, unseen_samples
from tuning_tables.hdf5_file import read_any_book, read_book, write_book
from tuning_tables.json_file import from_json, read_json, read_table, to_json, write_json
from tuning_tables.passages.passage_book import PassageBook, PassageChoice
from tuning_tables.passages.passage_row import PassageRow
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.rule import begin_tracking, stage_at_pulse
from tuning_tables.passages.sensor_layout import DecidesOn, PlausibleMotion, SensorLayout
from tuning_tables.provenance import CutId, Generator, Predicted, RetarderId, Validated, ValidRange
from tuning_tables.rule import Alarm, alarms_for, decide_for, decide_many, speed_for
from tuning_tables.stage import Stage
from tuning_tables.table import ControllerTable
from tuning_tables.table_book import Choice, Status, TableBook

__all__ = [
    "ActiveTable",
    "Alarm",
    "Approach",
    "Choice",
    "ControllerTable",
    "CutId",
    "DamagedTable",
    "DecidesOn",
    "Decisions",
    "Estimator",
    "Generator",
    "Interlock",
    "InvalidTable",
    "NewerVersion",
    "OtherKind",
    "PassageBook",
    "PassageChoice",
    "PassageRow",
    "PassageTable",
    "PlausibleMotion",
    "Predicted",
    "RegulatorClock",
    "RetarderId",
    "SensorLayout",
    "Stage",
    "Status",
    "TableBook",
    "TableError",
    "UnknownFormat",
    "ValidRange",
    "Validated",
    "alarms_for",
    "begin",
    "begin_tracking",
    "decide_for",
    "decide_many",
    "from_json",
    "read_any_book",
    "read_book",
    "read_json",
    "read_table",
    "speed_for",
    "stage_at_pulse",
    "table_schema",
    "to_csv",
    "to_json",
    "unseen_samples",
    "write_book",
    "write_csv",
    "write_json",
]


def __dir__() -> list[str]:
    return __all__
