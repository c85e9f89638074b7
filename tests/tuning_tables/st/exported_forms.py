"""Every form in which Structured Text is exported, as small as it shows what may go wrong, with its self-test."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Final

import numpy as np

from tests.controller_code.passage_tables import every_axle_book, passage_book, passage_table
from tests.controller_code.sample_book import approaching_book, estimating_book, park_book, sample_book, surface_book
from tests.st_files import aim_st_files, correction_st_files, passage_st_files, st_files
from tests.tuning_tables.aim.made_tables import category_table, measured_table, reported_of
from tests.tuning_tables.st.conftest import shaped_book
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.syntax import Compiler
from tuning_tables import Decisions, read_json
from tuning_tables.aim import AimAxes, AimTable, AimTables
from tuning_tables.aim.exports import aim_export
from tuning_tables.correction import Correction
from tuning_tables.export_names import ExportPrefix
from tuning_tables.exports import correction_st_unit_files, line_export
from tuning_tables.language.st_layout import unit_files
from tuning_tables.passages.exports import passage_export
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.self_test_size import FULL, SMALL
from tuning_tables.table_book import TableBook

Files = Mapping[str, bytes]
MOST_CALLS: Final = 100
OUTPUTS: Final = ("FAILED", "FIRSTFAILED")


@dataclass(frozen=True)
class Form:
    """One form of the export: `files` makes its texts, in the order in which they need each other."""

    name: str
    files: Callable[[], Files]
    self_test: str = "RETARDER_SELF_TEST"

    def text(self) -> bytes:
        """All units of the form, one after the other."""
        return b"\n".join(self.files().values())


@dataclass(frozen=True)
class Outcome:
    """What a self-test told, and how often which operation was executed on the way."""

    outputs: tuple[int, ...]
    done: Counter[str]


def self_tested(form: Form, text: bytes, compiler: Compiler) -> Outcome:
    """The outcome of all calls of the self-test in `text`, run as `compiler` does."""
    program = Program(text, compiler)
    instance = program.new(form.self_test)
    if "DONE" not in instance:
        program.call(form.self_test, instance)
    else:
        for _ in range(MOST_CALLS):
            program.call(form.self_test, instance, Restart=False)
            if instance["DONE"].value:
                break
        assert instance["DONE"].value
    return Outcome(tuple(int(instance[name].value) for name in OUTPUTS), program.done)


def _named(book: TableBook, *ids: str) -> TableBook:
    """The tables of a book with these names."""
    return TableBook(tuple(table for table in book.tables if table.id in ids))


def default_book() -> TableBook:
    """Two classes of the book that `tune` makes without a configuration."""
    files = sorted((Path(__file__).parent / "default_book").glob("*.json"))
    return TableBook(tuple(read_json(file) for file in files))


def _line_forms() -> tuple[Form, ...]:
    pair, shapes = ("light-2.0", "light-3.3"), ("shadow-1.5", "turning", "constant", "many-stages")
    return (
        Form("default book", lambda: st_files(default_book(), self_test=SMALL)),
        Form(
            "degree 1 with prefix",
            lambda: st_files(_two_targets(), ExportPrefix("PARK"), self_test=SMALL),
            "PARK_SELF_TEST",
        ),
        Form("one table of degree 0", lambda: st_files(shaped_book(2, 0), self_test=FULL)),
        Form("one table of degree 1", lambda: st_files(shaped_book(2, 1), self_test=FULL)),
        Form("estimators", lambda: st_files(_named(estimating_book(), "many-stages", "odd"), self_test=SMALL)),
        Form("slopes and estimators", lambda: st_files(_named(surface_book(), "shadow-1.5"), self_test=SMALL)),
        Form("approach", lambda: st_files(_named(approaching_book(False), *shapes), self_test=SMALL)),
        Form("at any time without gauge", lambda: st_files(_timed_book(), self_test=FULL)),
        Form("slopes", lambda: st_files(_at_odd_pressures(_slopes(*pair)), self_test=FULL)),
        Form("slopes small", lambda: st_files(_slopes("shadow-1.5", "odd"), self_test=SMALL)),
        Form("split files", lambda: unit_files(line_export(_slopes("constant", "shadow-1.5"), self_test=SMALL))),
    )


def _two_targets() -> TableBook:
    """Three stages and straight lines, of a class without estimator, which stands beside another class with one."""
    return TableBook(park_book().tables[:3])


def _slopes(*ids: str) -> TableBook:
    """Tables with approaches and slopes, by their names."""
    return _named(surface_book(approaching_book(False)), *ids)


def _at_odd_pressures(book: TableBook) -> TableBook:
    """The same at pressures that no short binary fraction is."""
    return TableBook(
        tuple(
            replace(table, stages=tuple(replace(each, pressure_kpa=133.3 * each.k) for each in table.stages))
            for table in book.tables
        )
    )


def _timed_book() -> TableBook:
    return TableBook((replace(sample_book().tables[0], decisions=Decisions.AT_ANY_TIME),))


def _passage_forms() -> tuple[Form, ...]:
    name = "RETARDER_PASSAGES_SELF_TEST"
    return (
        Form("point sensors", lambda: passage_st_files(_some(passage_book(), 0, 5), self_test=SMALL), name),
        Form("one sensor, two stages", lambda: passage_st_files(_one_passage(), self_test=SMALL), name),
        Form("every axle", lambda: passage_st_files(_some(every_axle_book(), 0), self_test=SMALL), name),
        Form("split passages", lambda: unit_files(passage_export(_some(passage_book(), 3), self_test=SMALL)), name),
    )


def _some(book: PassageBook, *places: int) -> PassageBook:
    return PassageBook(tuple(book.tables[place] for place in places))


def _one_passage() -> PassageBook:
    return PassageBook((passage_table(stages=2, places_m=(-4.0,), axles=(0.0, 1.85)),))


def _aim_forms() -> tuple[Form, ...]:
    name = "AIM_SELF_TEST"
    return (
        Form("aim table by category", lambda: aim_st_files(AimTables((category_table(),)), self_test=SMALL), name),
        Form("aim table measured", lambda: aim_st_files(_measured_aims(), self_test=SMALL), name),
        Form("aim table of one node", lambda: aim_st_files(AimTables((_one_node(False),)), self_test=SMALL), name),
        Form(
            "measured, of one node",
            lambda: unit_files(aim_export(AimTables((_one_node(True),)), self_test=SMALL)),
            name,
        ),
    )


def _measured_aims() -> AimTables:
    return AimTables((measured_table(), category_table(1.5, 4, "СТ")))


def _one_node(measured: bool) -> AimTable:
    """An aim table with a single node on each axis."""
    axes = AimAxes(np.array([2]), np.array([10.0]), np.array([0.3]) if measured else None)
    speeds = np.full(axes.shape, 1.1)
    made = measured_table() if measured else category_table()
    return replace(made, axes=axes, exit_speed_m_s=speeds, reported=reported_of(speeds))


def _correction_forms() -> tuple[Form, ...]:
    made = {limit: Correction(limit, 0.06) for limit in (0.05, 0.11, 0.12, 0.13, 0.15)}
    name = "RETARDER_CORRECTION_SELF_TEST"
    return (
        *(Form(f"correction, limit {limit}", partial(correction_st_files, each), name) for limit, each in made.items()),
        Form("split correction", lambda: correction_st_unit_files(made[0.12]), name),
    )


LINE_FORMS: Final = _line_forms()
FORMS: Final = (*LINE_FORMS, *_passage_forms(), *_aim_forms(), *_correction_forms())
