"""summary.json of a command: every figure for programs, and the hashes of the files that belong to it."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from enum import Enum
from importlib.metadata import version
from typing import Any, Final

from synth.frame.command import Head
from synth.frame.exhibits import Exhibit, Sentence, Table, exhibits_of
from synth.frame.interval import Interval
from synth.frame.told import Told
from tuning_tables.canonical import LARGEST_EXACT_INTEGER, canonical_json

FORMAT: Final = "retarder-synth-summary"
VERSION: Final = 1


def summary_of(told: Told, hashes: Mapping[str, str]) -> bytes:
    """The document as canonical JSON; `hashes`: SHA-256 by name, all files but summary.json itself.

    `figures`: those of the sentences by name; `tables`: rows by the keys of the columns. A time that never comes, and a
    figure that is not there, is null.
    """
    exhibits = tuple(exhibits_of(told.chapters))
    document = {
        **summary_head(told.command, told.head, told.created),
        "accepted": told.verdict.accepted,
        "limits": [asdict(limit) for limit in told.verdict.limits],
        "figures": figures_of(exhibits),
        "tables": tables_of(exhibits),
        "files": dict(hashes),
    }
    return canonical_json(plain(document)) + b"\n"


def summary_head(command: str, head: Head, created: str) -> dict[str, Any]:
    """What every such document begins with."""
    return {
        "format": FORMAT,
        "version": VERSION,
        "command": command,
        "created": created,
        "generator": {"name": "retarder-synth", "version": version("retarder-synth"), "config_sha256": head.sha256},
        "title": head.title,
        "config": json.loads(head.canonical_json),
        "warnings": head.warnings,
        "parameters_assumed": [value.key for value in head.parameters if value.assumed],
    }


def figures_of(exhibits: Iterable[Exhibit]) -> dict[str, Any]:
    """The figures of all sentences by name."""
    return {name: figure for each in exhibits if isinstance(each, Sentence) for name, figure in each.figures.items()}


def tables_of(exhibits: Iterable[Exhibit]) -> dict[str, list[dict[str, Any]]]:
    """The rows of all tables by name."""
    return {each.name: rows_of(each) for each in exhibits if isinstance(each, Table)}


def rows_of(table: Table) -> list[dict[str, Any]]:
    """The rows, each with the keys of all columns."""
    return [{column.key: row.get(column.key) for column in table.columns} for row in table.rows]


def plain(value: Any) -> Any:
    """`value` as JSON holds it: intervals as objects, tuples as lists, numbers of numpy as those of Python, NaN and
    infinities as null. Whole numbers that a double cannot hold become strings."""
    match value:
        case Interval():
            return plain(asdict(value))
        case Mapping():
            return {key: plain(each) for key, each in value.items()}
        case list() | tuple():
            return [plain(each) for each in value]
        case Enum():
            return value.value
        case bool() | str() | None:
            return value
        case int():
            return str(value) if abs(value) > LARGEST_EXACT_INTEGER else value
    number = value.item() if hasattr(value, "item") else value
    return None if isinstance(number, float) and not math.isfinite(number) else number
