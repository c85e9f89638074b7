"""`retarder-synth inspect`: what tables are for, what they promise, where their lines run; read without the
solver. Controller code that lies about is recognised where `verify` finds it, not read.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Final

import numpy as np

from synth.checker.code_export import AIMS, LINES, PASSAGES, CodeFile, code_at
from synth.cli.inspect_drawn import AskedDrawing, draw
from synth.cli.inspect_table import aim_document, aim_page, passage_document, passage_page, table_words, told_document
from synth.frame.command import Limit, Verdict
from synth.frame.exhibits import Column, Table
from synth.frame.printed_numbers import counted, decimals
from synth.frame.terminal.manner import Manner
from synth.frame.terminal.printed_page import IN_JSON, NO_BREAK, Printed, PrintedTable
from synth.frame.terminal.telling import OK
from synth.frame.version import Concerned, concerned
from synth.retarder.forms.tables_at import TableFile, TablesAt, exporters_at, summary_beside, tables_at
from tuning_tables import DamagedTable
from tuning_tables.decisions import Approach, Decisions
from tuning_tables.estimator import Estimator
from tuning_tables.table import ControllerTable

CONTENTS: Final = {LINES: "tables", AIMS: "aim tables", PASSAGES: "tables for point sensors"}


def code_document(code: CodeFile) -> dict[str, Any]:
    """An export for programs."""
    return {"path": str(code.path), "language": code.language, "exported_by": code.exported_by}


def code_sentence(code: CodeFile) -> str:
    """An export in words."""
    told = f"{CONTENTS[code.kind]} in {code.language}, exported by {code.exported_by or 'an unknown program'}"
    return f"{code.path}: {told}; verify compares them with those they were made of"


SHOWN_POINTS = 5


def inspect_command(source: Path, asked: AskedDrawing | None, manner: Manner) -> int:
    """Tell the contents of the tables in `source`, and what controller code is there, and draw what is `asked`.

    `TableError` for damage.
    """
    if asked is not None:
        from synth.cli.printed_report import require_place

        require_place("inspect", asked.output)
    code = code_at(source)
    tables = tables_at(source, else_there=bool(code))
    summary = checked_summary(source) if source.is_dir() else None
    manner.step("read; all sums are right")
    found = Inspected(tables, code, summary)
    drawn = None if asked is None else draw(source, tables, asked, tuple(found.page()), manner)
    extra = drawn.document() if drawn else {}
    manner.give(lambda: found.document() | extra, lambda: [*found.page(), *(drawn.page() if drawn else ())])
    return OK


@dataclass(frozen=True)
class Inspected:
    """All that is told of a source: tables, controller code, and its summary."""

    tables: TablesAt
    code: Sequence[CodeFile]
    summary: dict[str, Any] | None

    @cached_property
    def exporters(self) -> tuple[str, ...]:
        """The programs that wrote the files of the tables."""
        return exporters_at(self.tables.path)

    @property
    def defects(self) -> tuple[Concerned, ...]:
        """Known ones of the versions that made the tables, or exported them or the code."""
        return concerned(lambda: (*self._told(), *(each.document for each in self.code)))

    def _told(self) -> Iterator[dict[str, Any]]:
        """The tables, each as every program exported it that wrote one of the files."""
        for table in (*self.tables.of_stages, *(file.table for file in self.tables.aims)):
            for exporter in self.exporters or ("",):
                yield {**told_document(table), "exported_by": exporter}

    def document(self) -> dict[str, Any]:
        """It for programs."""
        tables = self.tables
        files = [*map(file_document, tables.files), *map(aim_document, tables.aims)]
        found: dict[str, Any] = {"path": str(tables.path), "exported_by": [*self.exporters], "files": files}
        found |= {"passage_tables": [*map(passage_document, tables.passages)]} if tables.passages else {}
        found |= {"code": [*map(code_document, self.code)]} if self.code else {}
        found |= {"known_defects": [each.document for each in self.defects]}
        return found | ({"summary": self.summary} if self.summary else {})

    def page(self) -> Iterator[Printed]:
        """It in words."""
        tables, mixed = self.tables, is_mixed(self.tables.lines)
        for file in tables.files:
            yield f"{file.path}: {contents(file)}"
            for table in file.tables:
                yield from table_page(table, mixed)
        if tables.passages:
            yield f"{tables.path}: {counted(len(tables.passages), 'table')} for point sensors; their sums are right"
        for each in tables.passages:
            yield from passage_page(each)
        for aim in tables.aims:
            yield from aim_page(aim)
        yield from (f"{tables.path}: its tables were exported by {name}" for name in self.exporters)
        yield from map(code_sentence, self.code)
        if self.summary is not None:
            yield f"{tables.path / 'summary.json'}: {self.summary['sentence']}"
        yield from (each.sentence for each in self.defects)


def contents(file: TableFile) -> str:
    """What is in a file, and that its sum is right."""
    if file.kind == "book":
        estimating = sum(table.estimator is not None for table in file.tables)
        kinds = (
            f", {estimating} with an estimator and {len(file.tables) - estimating} without"
            if is_mixed(file.tables)
            else ""
        )
        return f"a book of {len(file.tables)} tables{kinds}; its seal and SHA-256 are right"
    return "a controller table; its CRC-32 is right"


def is_mixed(tables: Sequence[ControllerTable]) -> bool:
    """Whether some of `tables` have an estimator and some have none."""
    return len({table.estimator is None for table in tables}) > 1


def file_document(file: TableFile) -> dict[str, Any]:
    """A file for programs."""
    tables = [
        {**told_document(table), "category_number": table.cut.number, "lines_at": lines_at(table)}
        for table in file.tables
    ]
    return {"path": str(file.path), "kind": file.kind, "checksum": "right", "tables": tables}


def table_page(table: ControllerTable, says_none: bool) -> list[Printed]:
    """A table in words, a line a fact, and its lines; `says_none`: one fact about a missing estimator too."""
    words: list[Printed] = [
        *table_words(table),
        f"    lines      degree {table.degree}, path {table.valid.s_m[0]:g} to {table.valid.s_m[1]:g} m, "
        f"speed {table.valid.v_m_s[0]:g} to {table.valid.v_m_s[1]:g} m/s",
    ]
    words.insert(-1, f"    clock      {table.clock}")
    if table.estimator is not None:
        words.insert(-1, f"    estimator  {estimator_words(table.estimator)}")
    elif says_none:
        words.insert(-1, "    estimator  none: the lines are for the measured speed")
    if table.decisions is Decisions.AT_ANY_TIME:
        words.insert(-1, f"    decides    {decision_words(table)}")
    if table.approach is not None:
        words.insert(-1, f"    approach   {approach_words(table.approach)}")
    return [*words, lines_table(table)]


def lines_table(table: ControllerTable) -> PrintedTable:
    """The lines at some places, in m/s, and what a gauge adds."""
    places = list(enumerate(shown_path(table)))
    columns = [Column("name", "line, m/s", words=True)]
    columns += [Column(f"at {place}", f"at {path_m:.2f}{NO_BREAK}m", form=decimals(3)) for place, path_m in places]
    columns += [Column("slope_m_s_per_kpa", "+ m/s per 100 kPa", form=lambda slope: f"{1e2 * slope:+.4f}")]
    rows = [
        {
            **line,
            "name": f"stage {line['k']} ({line['pressure_kpa']:g} kPa) {line['line']}",
            **{f"at {place}": speed for place, speed in enumerate(line["v_m_s"])},
        }
        for line in lines_at(table)
    ]
    return PrintedTable(Table("lines", "", columns, rows), IN_JSON)


def decision_words(table: ControllerTable) -> str:
    """When a table for commands at any time is asked, and what it must be told."""
    gauge = (
        "with the pressure of a gauge: each line rises with what it is above that of the stage"
        if table.has_gauge
        else "without a pressure gauge"
    )
    return f"at every sample, also while the pressure is on its way; {gauge}"


def approach_words(approach: Approach) -> str:
    """From where on the regulator acts, what it may command there, and its interlock."""
    return (
        f"the regulator acts from {approach.length_m:g} m before the entrance on, where it commands no stage above "
        f"{approach.entrance_stage}; it takes over a cut only when the cut ahead has left the position"
    )


def estimator_words(estimator: Estimator) -> str:
    """What the estimator of a table takes for granted."""
    return (
        f"the lines are for the estimated speed; sensor {estimator.speed_noise_m_s:.3f} m/s, friction of cuts +-"
        f"{estimator.friction_cv:.0%}, along the path +-{estimator.path_std:.0%} over "
        f"{estimator.correlation_length_m:g} m, beams touch at {estimator.touch_pressure_kpa:g} kPa, "
        f"{len(estimator.s_m)} path breaks"
    )


def shown_path(table: ControllerTable) -> list[float]:
    """A few places along the path, metres."""
    return [float(s) for s in np.linspace(*table.valid.s_m, SHOWN_POINTS)]


def lines_at(table: ControllerTable) -> list[dict[str, Any]]:
    """Every line of the stages in use at the shown places, as evaluated in double precision."""
    found: list[dict[str, Any]] = []
    path_m = shown_path(table)
    for stage in table.stages:
        for name, line, slope in zip(("down below", "up above"), stage.lines, stage.slopes, strict=True):
            if line is not None:
                speeds = [float(np.polynomial.polynomial.polyval(s, line)) for s in path_m]
                sloped = {} if slope is None else {"slope_m_s_per_kpa": slope}
                head = {"k": stage.k, "pressure_kpa": stage.pressure_kpa, "line": name}
                found.append({**head, "s_m": path_m, "v_m_s": speeds, **sloped})
        if stage.upper is None:
            break  # the stages above are never asked for
    return found


def checked_summary(directory: Path) -> dict[str, Any] | None:
    """Whether all files that summary.json lists are there unchanged; None without one, `DamagedTable` otherwise."""
    document = summary_beside(directory)
    if document is None or not (directory / "summary.json").is_file():
        return None
    files = document.get("files")
    listed = files if isinstance(files, dict) else {}
    for name, sha256 in sorted(listed.items()):
        file = directory / str(name)
        if not file.is_file():
            raise DamagedTable(f"{directory / 'summary.json'}: it lists {name}, which is not there; tune again")
        if hashlib.sha256(file.read_bytes()).hexdigest() != sha256:
            raise DamagedTable(f"{file}: its SHA-256 is not the one in summary.json; tune again")
    said, accepted = verdict_in(document), "accepted" if document.get("accepted") else "not accepted"
    judged = f"{accepted}: {said}" if said else "nothing is judged in it"
    sentence = f"all {len(listed)} files that it lists are there unchanged; {judged}"
    return {"files": len(listed), "accepted": document.get("accepted"), "sentence": sentence}


def verdict_in(document: Mapping[str, object]) -> str:
    """What a summary says of the limits, as its command said it; '' for a document without any."""
    limits = document.get("limits")
    told = [each for each in limits if isinstance(each, dict)] if isinstance(limits, list) else []
    return Verdict(tuple(Limit(str(each.get("sentence")), each.get("kept") is True) for each in told)).sentence
