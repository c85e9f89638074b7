"""The configuration that tables were made of: the copy that lies beside them."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from synth.frame.results_directory import CONFIGURATION
from synth.retarder.forms.table_file import summaries_beside
from tuning_tables.aim.aim_table import AimTable
from tuning_tables.export_prefix import AIM, ExportPrefix
from tuning_tables.table_kinds import AnyTable

NAME: Final = f"retarder_{CONFIGURATION}"


@dataclass(frozen=True)
class KeptConfiguration:
    """The copy at `path`, as it was written."""

    path: Path
    content: bytes


def configuration_beside(source: Path, tables: Sequence[AnyTable]) -> KeptConfiguration | None:
    """The user's file that the tables were made of; None where no command at `source` kept it.

    `source`: a table, a book, or the directory of a command; what it left lies there, or in a folder above a file. The
    summary must have the hash of the tables' configuration, and that of the copy.
    """
    sha256s = {table.generator.config_sha256 for table in tables}
    for folder, document in summaries_beside(source):
        try:
            is_theirs = document["generator"]["config_sha256"] in sha256s
            content = (folder / CONFIGURATION).read_bytes() if is_theirs else b""
            is_whole = document["files"][CONFIGURATION] == hashlib.sha256(content).hexdigest()
        except (OSError, ValueError, KeyError, TypeError):  # none of a tune, or no copy
            continue
        if is_theirs and is_whole:
            return KeptConfiguration(folder / CONFIGURATION, content)
    return None


def configuration_file(source: Path, tables: Sequence[AnyTable], prefix: ExportPrefix) -> Mapping[str, bytes]:
    """The same, for tables of one kind, as a file for whoever gets their code; none where there is no copy."""
    kept = configuration_beside(source, tables)
    named = prefix.of_kind(AIM) if isinstance(tables[0], AimTable) else prefix
    return {named.renamed(NAME): kept.content} if kept else {}
