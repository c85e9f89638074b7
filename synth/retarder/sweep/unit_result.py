"""The result of a unit, and its file: canonical JSON under a seal, so that a damaged one is never taken for whole."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import cache
from typing import Any

from pydantic import TypeAdapter, ValidationError

from synth.retarder.comparison.measured import Judgement
from synth.retarder.failed_case import FailedCase
from synth.retarder.sweep.plan import Gap
from synth.simulation.exit_statistics import BrakePower, ExitStatistics
from tuning_tables import ControllerTable, DamagedTable, TableError
from tuning_tables.document import from_document, to_document
from tuning_tables.errors import excerpt
from tuning_tables.json_text import canonical_json
from tuning_tables.whole_file import seal_of, unsealed

FORMAT, VERSION = "retarder-sweep-unit", 5


@dataclass(frozen=True)
class Row:
    """One table with the figures of its closed loop, and what they say of the limits of [acceptance]."""

    table: ControllerTable
    statistics: ExitStatistics
    brake_power: BrakePower
    judgement: Judgement


@dataclass(frozen=True)
class UnitResult:
    """Rows by target in the order of the configuration, or rising where targets were refined; gaps measured.

    Every target has a row or is refused.
    """

    key: str
    condition: str
    label: str
    rows: tuple[Row, ...]
    gaps: tuple[Gap, ...]
    refused: tuple[FailedCase, ...] = ()


def to_bytes(result: UnitResult) -> bytes:
    """The content of the unit's file; equal results give equal bytes. `ValueError` where a figure is not finite."""
    document = {
        "format": FORMAT,
        "version": VERSION,
        "key": result.key,
        "condition": result.condition,
        "label": result.label,
        "rows": [
            {
                "table": to_document(row.table),
                "statistics": asdict(row.statistics),
                "brake_power": asdict(row.brake_power),
                **asdict(row.judgement),
            }
            for row in result.rows
        ],
        "gaps": [asdict(gap) for gap in result.gaps],
        "refused": [asdict(each) for each in result.refused],
    }
    body = canonical_json(document)
    return body + seal_of(body)


@dataclass(frozen=True)
class StoredRow:
    """A row as it stands in the file: the table as its document, the judgement beside it."""

    table: dict[str, Any]
    statistics: ExitStatistics
    brake_power: BrakePower
    missed: tuple[str, ...]
    undecided: tuple[str, ...]

    def row(self, source: str) -> Row:
        """The row; `TableError` where the document is no table."""
        table = from_document(self.table, source, (ControllerTable,))
        return Row(table, self.statistics, self.brake_power, Judgement(self.missed, self.undecided))


@dataclass(frozen=True)
class StoredUnit:
    """All that stands in the file, by the names that it has there."""

    format: str
    version: int
    key: str
    condition: str
    label: str
    rows: tuple[StoredRow, ...]
    gaps: tuple[Gap, ...]
    refused: tuple[FailedCase, ...]


@cache
def stored_form() -> TypeAdapter[StoredUnit]:
    """What reads and checks the file; it is made once, as that lasts longer than to read a file."""
    return TypeAdapter(StoredUnit)


def from_bytes(content: bytes, source: str) -> UnitResult:
    """The result in a unit's file; `DamagedTable` for anything that is not, byte for byte, what `to_bytes` wrote."""
    body = bytes(unsealed(content, source))
    try:
        stored = stored_form().validate_json(body, strict=True)
        rows = tuple(row.row(source) for row in stored.rows)
        result = UnitResult(stored.key, stored.condition, stored.label, rows, stored.gaps, stored.refused)
        if to_bytes(result) == content:
            return result
        reason = "it is of another version, has other members, or is written otherwise"
    except ValidationError as fault:
        first = fault.errors(include_url=False)[0]
        reason = f"{'.'.join(map(str, first['loc']))}: {first['msg']}"
    except TableError:
        raise
    except ValueError as fault:
        reason = str(fault)
    raise DamagedTable(f"{source}: sealed, but no result of a sweep ({excerpt(reason, 200)}).")
