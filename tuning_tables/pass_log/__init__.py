"""Measured passes of a retarder position: what a controller logs, as a value and as files."""

from tuning_tables.errors import InvalidLog
from tuning_tables.pass_log.log_files import LoadedLogs, read_logs, write_log
from tuning_tables.pass_log.log_mapping import LogMapping, read_mapping
from tuning_tables.pass_log.pass_log import PassLog

__all__ = ["InvalidLog", "LoadedLogs", "LogMapping", "PassLog", "read_logs", "read_mapping", "write_log"]


def __dir__() -> list[str]:
    return __all__
