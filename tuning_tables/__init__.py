"""Tuning tables: the artefact that a trackside controller loads, and the rule by which it decides.

A controller with a radar needs `read_json` and `decide_for`; one with point sensors needs `read_table`,
`believed_passage` and `wanted_stage`. numpy is all they use. Books in HDF5 need h5py when called.
"""

from tuning_tables.active_table import ActiveTable
from tuning_tables.approach import Approach
from tuning_tables.csv_file import to_csv, write_csv
from tuning_tables.decisions import Decisions
from tuning_tables.errors import DamagedTable, InvalidTable, NewerVersion, OtherKind, TableError, UnknownFormat
from tuning_tables.estimator import Estimator, begin, unseen_samples
from tuning_tables.figures import Predicted, Validated, ValidRange
from tuning_tables.hdf5_file import read_any_book, read_book, write_book
from tuning_tables.json_file import from_json, read_json, read_table, to_json, write_json
from tuning_tables.passages.passage_book import PassageBook, PassageChoice
from tuning_tables.passages.passage_row import PassageRow
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.plausible_motion import PlausibleMotion
from tuning_tables.passages.sensor_layout import DecidesOn, SensorLayout
from tuning_tables.provenance import CutId, Generator, RetarderId
from tuning_tables.rule import alarms_for, decide_for, decide_many, speed_for
from tuning_tables.schema import table_schema
from tuning_tables.stage import Stage
from tuning_tables.table import ControllerTable
from tuning_tables.table_book import Choice, Status, TableBook

__all__ = [
    "ActiveTable",
    "Approach",
    "Choice",
    "ControllerTable",
    "CutId",
    "DamagedTable",
    "DecidesOn",
    "Decisions",
    "Estimator",
    "Generator",
    "InvalidTable",
    "NewerVersion",
    "OtherKind",
    "PassageBook",
    "PassageChoice",
    "PassageRow",
    "PassageTable",
    "PlausibleMotion",
    "Predicted",
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
    "decide_for",
    "decide_many",
    "from_json",
    "read_any_book",
    "read_book",
    "read_json",
    "read_table",
    "speed_for",
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
