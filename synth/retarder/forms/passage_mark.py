"""Whether a JSON file says that its table decides at sensor passages."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

from tuning_tables.json_text import LARGEST_FILE_BYTES
from tuning_tables.regular_file import first_bytes

MARK: Final = re.compile(rb'"decisions"\s*:\s*"at_sensor_passages"')
"""No text in a JSON document can hold this: its quotes would be escaped."""


def is_passage_table(file: Path) -> bool:
    """Whether a JSON file says that its table decides at sensor passages; what cannot be read does not."""
    try:
        return file.suffix not in (".h5", ".hdf5") and MARK.search(first_bytes(file, LARGEST_FILE_BYTES)) is not None
    except OSError:  # whoever reads it for its tables tells why
        return False
