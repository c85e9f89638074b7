"""Whatever the reader of tables refuses of any declared member, the checker finds too, by its own reading."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Final

import pytest

from tests.checker.any_time_tables import approached, estimated, sloped, sound_table, with_stage_out_of_use
from tests.checker.planted_fault import look
from tests.tuning_tables.every_kind import (
    SAMPLES,
    Document,
    JsonPath,
    altered,
    document_of,
    dotted,
    leaves_of,
    places,
    sealed,
    too_far,
    value_at,
)
from tuning_tables import TableError, from_json
from tuning_tables.table_kinds import AnyTable

SOUND: Final[Mapping[str, Callable[[], AnyTable]]] = {
    "lines": lambda: sound_table("plain"),
    "whole": lambda: approached(estimated(with_stage_out_of_use(sloped(sound_table("plain"))))),
    **{name: make for name, make in SAMPLES.items() if "points" in name or "aim" in name},
}
"""Tables in whose numbers the checker finds no fault."""

WRONG: Final[tuple[object, ...]] = (None, True, "4", [], {}, -1, 0.5)


def wrong_documents(table: AnyTable) -> Iterator[tuple[str, Document]]:
    """Documents with a member of another type, beyond its limits, backwards, left out, or too many; what is wrong."""
    document = document_of(table)
    paths = [path for path in places(document) if path != ("crc32",)]
    cases: list[tuple[JsonPath, object]] = [(path, value) for path in paths for value in WRONG]
    for path, leaf in leaves_of(type(table)):
        parent = value_at(document, path[:-1]) if all_there(document, path) else None
        cases += [(path, value) for value in too_far(leaf)] if parent is not None else []
    for path in ((), *paths):
        content = value_at(document, path)
        if isinstance(content, dict):
            for key in sorted(content.keys() - {"crc32"}):
                less = {name: each for name, each in content.items() if name != key}
                yield f"{dotted(path)} lacks {key}", altered(document, path, less) if path else less
            more = {**content, "surplus": 1}
            yield f"{dotted(path)} has a surplus", altered(document, path, more) if path else more
        elif isinstance(content, list):
            cases.append((path, content[::-1]))
    yield from ((f"{dotted(path)} is {value!r}", altered(document, path, value)) for path, value in cases)


def all_there(document: Document, path: JsonPath) -> bool:
    """Whether the table has the sections on the way."""
    return all(value_at(document, path[:end]) is not None for end in range(1, len(path)))


@pytest.mark.parametrize("name", SOUND)
def test_what_the_reader_refuses_of_any_member_the_checker_finds(name: str, tmp_path: Path) -> None:
    table, file = SOUND[name](), tmp_path / "table.json"
    file.write_bytes(sealed(document_of(table)))
    sound = {finding.sentence for finding in look(file).findings}
    refused, through = 0, []
    for wrong, document in wrong_documents(table):
        content = sealed(document)
        try:
            from_json(content, type(table))
        except TableError:
            refused += 1
            file.write_bytes(content)
            if not {finding.sentence for finding in look(file).findings} - sound:
                through.append(wrong)
    assert through == []
    assert refused > 300
