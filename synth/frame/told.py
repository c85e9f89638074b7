"""A finished run as a value, its summary.json (every figure for programs, and the hashes of the files that belong
to it), and its print: what is brief of its exhibits, the verdict, and where the files are.
"""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from enum import Enum
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

from synth.frame.command import Head, Verdict
from synth.frame.exhibits import Chapter, Chart, Exhibit, File, Sentence, Table, exhibits_of
from synth.frame.exhibits import Exhibit as Shown
from synth.frame.interval import Interval
from synth.frame.terminal.printed_page import Printed, PrintedTable, PrintedVerdict
from tuning_tables.json_text import LARGEST_EXACT_INTEGER, canonical_json


@dataclass(frozen=True)
class Told:
    """`command`: its name; `created`: UTC instant; `limits_of_use`: what the figures do not say.

    `ValueError` where two figures, tables, charts or files have one name: one of them would be lost.
    """

    command: str
    head: Head
    created: str
    verdict: Verdict
    chapters: tuple[Chapter, ...]
    limits_of_use: Sequence[str]

    def __post_init__(self) -> None:
        names = [name for each in exhibits_of(self.chapters) for name in names_of(each)]
        twice = sorted(name for name, count in Counter(names).items() if count > 1)
        if twice:
            raise ValueError(f"'{self.command}' shows twice: {', '.join(' '.join(name) for name in twice)}")


def names_of(exhibit: Exhibit) -> Iterator[tuple[str, str]]:
    """(kind, name) of all that `exhibit` is kept under."""
    match exhibit:
        case Sentence():
            yield from (("figure", name) for name in exhibit.figures)
        case Table():
            yield "table", exhibit.name
        case Chart():
            yield "chart", exhibit.name
        case File():
            yield "file", exhibit.name


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


def page_of_run(told: Told, directory: Path, files: Sequence[str]) -> Iterator[Printed]:
    """What is printed of it; `files`: names of what was written."""
    yield from printed(told)
    yield f"{directory}: {', '.join(folders_and_files(files))}"


def printed(told: Told) -> Iterator[Printed]:
    """The brief exhibits in their order, then the verdict."""
    yield from brief_exhibits(exhibits_of(told.chapters), "summary.json")
    if told.verdict.limits:
        yield PrintedVerdict(told.verdict.kept, told.verdict.sentence)


def brief_exhibits(exhibits: Iterable[Shown], elsewhere: str) -> Iterator[Printed]:
    """Those that a terminal shows; `elsewhere` names the place of what it has no room for."""
    for each in exhibits:
        if isinstance(each, Sentence) and each.brief:
            yield each.text
        if isinstance(each, Table) and each.brief:
            yield PrintedTable(each, elsewhere)


def folders_and_files(names: Sequence[str]) -> list[str]:
    """The folders, then the files beside them."""
    folders = sorted({f"{name.partition('/')[0]}/" for name in names if "/" in name})
    return [*folders, *sorted(name for name in names if "/" not in name)]
