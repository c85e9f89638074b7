"""The result of a unit, and its file: canonical JSON under a seal, so that a damaged one is never taken for whole."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import Any, cast

from synth.retarder.failed_case import FailedCase
from synth.retarder.judgement import Judgement
from synth.retarder.sweep.refinement import Gap
from synth.simulation.exit_statistics import BrakePower, ExitStatistics
from tuning_tables import ControllerTable, DamagedTable, TableError
from tuning_tables.canonical import canonical_json
from tuning_tables.document import from_document, to_document
from tuning_tables.seal import seal_of, unsealed

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


def from_bytes(content: bytes, source: str) -> UnitResult:
    """The result in a unit's file; `DamagedTable` for anything that is not, byte for byte, what `to_bytes` wrote."""
    body = bytes(unsealed(content, source))
    try:
        match cast(dict[str, Any], json.loads(body)):
            case {"format": str(kind), "version": int(number), **found} if (kind, number) == (FORMAT, VERSION):
                return UnitResult(
                    key=found["key"],
                    condition=found["condition"],
                    label=found["label"],
                    rows=tuple(row_from(row, source) for row in found["rows"]),
                    gaps=tuple(Gap(**gap) for gap in found["gaps"]),
                    refused=tuple(FailedCase(**each) for each in found["refused"]),
                )
    except TableError:
        raise
    except (KeyError, TypeError, ValueError) as fault:
        raise DamagedTable(f"{source}: sealed, but no result of a sweep ({fault}).") from None
    raise DamagedTable(f"{source}: sealed, but of another format or version.")


def row_from(row: dict[str, Any], source: str) -> Row:
    """One row of the file."""
    judgement = Judgement(tuple(row["missed"]), tuple(row["undecided"]))
    statistics, power = ExitStatistics(**with_tuples(row["statistics"])), BrakePower(**with_tuples(row["brake_power"]))
    return Row(from_document(row["table"], source, (ControllerTable,)), statistics, power, judgement)


def with_tuples(figures: dict[str, Any]) -> dict[str, Any]:
    """Figures with the ends of intervals as tuples."""
    return {name: tuple(value) if isinstance(value, list) else value for name, value in figures.items()}
