"""Of which kind the table in a JSON file is, as the file says before it is read as a table."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

from tuning_tables.document import FORMAT
from tuning_tables.json_text import LARGEST_FILE_BYTES
from tuning_tables.regular_file import first_bytes
from tuning_tables.table_kinds import AnyTable, kind_of

OF_FORMAT: Final = re.compile(rb'"format"\s*:\s*"%s"' % FORMAT.encode())
OF_KIND: Final = re.compile(rb'"kind"\s*:\s*"(\w+)"')
"""No text in a JSON document can hold these: its quotes would be escaped."""


def is_table_of(table: type[AnyTable], file: Path) -> bool:
    """Whether a JSON file says that it is a table of this class; what cannot be read does not."""
    try:
        content = b"" if file.suffix in (".h5", ".hdf5") else first_bytes(file, LARGEST_FILE_BYTES)
    except OSError:  # whoever reads it for its tables tells why
        return False
    return bool(OF_FORMAT.search(content)) and OF_KIND.findall(content) == [kind_of(table).encode()]
