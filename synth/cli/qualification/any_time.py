"""A book that decides at any time, made of a tuned one: no small tune reaches all that a rule and an export may do."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from synth.cli.qualification.c_code import COMPILERS, SOUND, self_test
from synth.cli.qualification.check import Check, checked, not_checked, program
from synth.cli.qualification.second_program import findings
from synth.cli.qualification.tuned import Tuned
from tuning_tables import Approach, ControllerTable, Decisions, Stage, from_json, to_json
from tuning_tables.stage import round_coefficients

ANY_TIME: Final = "any-time"
SLOPE_M_S_PER_KPA: Final = -0.001
APART_M_S: Final = 0.5
ENTRANCE_STAGES: Final = (1, 1, 0)
"""Of one table after the other, each for the next faster target: lines between the last two have no meaning."""

HOW: Final = "tables made of a tuned one: lines over the pressure, several targets, two families; not simulated"
OPTIMISED: Final = "-O2"


def any_time_checks(book: Tuned) -> Iterator[Check]:
    """Whether the checker confirms the export of such a book, and its self-test is sound."""
    what, limit = "Second program, decisions at any time", "nothing found"
    if not book.tables:
        yield not_checked(what, HOW, "the tune failed", limit)
        return
    folder = book.folder.with_name(ANY_TIME)
    (folder / "tables").mkdir(parents=True)
    for table in any_time_tables(from_json(next(iter(book.tables.values())))):
        (folder / "tables" / f"{table.id}.json").write_bytes(to_json(table))
    exported = program(f"export {ANY_TIME} --format c -o {ANY_TIME}/c", folder.parent)
    if exported.code != 0:
        yield checked(what, HOW, exported.sentence, limit, holds=False)
        return
    ran = program(f"verify {ANY_TIME} --json", folder.parent)
    found = findings(ran.document) if ran.document else ran.sentence
    yield checked(what, HOW, found, limit, ran.code == 0)
    compiler = next((name for name in COMPILERS if shutil.which(name)), None)
    if compiler is not None:
        code = {file.name: file.read_bytes() for file in (folder / "c").iterdir()}
        said = self_test(compiler, OPTIMISED, code, folder / "code")
        how = f"the self-test of the same; {compiler} {OPTIMISED}"
        yield checked("C code, decisions at any time", how, said, f"'{SOUND}'", said == SOUND)


def any_time_tables(table: ControllerTable) -> Iterator[ControllerTable]:
    """Tables for faster and faster targets, the lines of `table` moved up by as much."""
    for number, entrance_stage in enumerate(ENTRANCE_STAGES):
        up_m_s = number * APART_M_S
        yield replace(
            table,
            id=f"{table.id}-{ANY_TIME}-{number}",
            target_speed_m_s=table.target_speed_m_s + up_m_s,
            decisions=Decisions.AT_ANY_TIME,
            approach=Approach(-table.valid.s_m[0], entrance_stage),
            stages=tuple(sloping(stage, up_m_s) for stage in table.stages),
        )


def sloping(stage: Stage, up_m_s: float) -> Stage:
    """The stage with its lines moved up, and sloping over the pressure."""
    lower, upper = (
        None if line is None else round_coefficients([line[0] + up_m_s, *line[1:]])
        for line in (stage.lower, stage.upper)
    )
    (slope,) = round_coefficients([SLOPE_M_S_PER_KPA])
    low, high = (None if line is None else slope for line in (lower, upper))
    return Stage(stage.k, stage.pressure_kpa, lower, upper, low, high)
