"""What Python raises for an archive of arrays, as numpy writes it, that is damaged."""

from __future__ import annotations

import zipfile
import zlib
from typing import Final

NO_ARCHIVE: Final = (ValueError, OSError, EOFError, zipfile.BadZipFile, zlib.error, NotImplementedError, RuntimeError)
"""Encrypted, or packed in a way that `zipfile` does not know, too."""
