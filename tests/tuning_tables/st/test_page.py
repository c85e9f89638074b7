"""docs/reference/structured-text.md: its program goes over to other tables as Python does, and its figures are
right.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.controller_code.sample_book import estimator_of, with_slopes
from tests.controller_code.weighed_cuts import SAMPLES, TARGET_M_S, braked_by, weighed_book, weighed_cuts
from tests.st_files import aim_st_files, st_files
from tests.tuning_tables.aim.made_tables import hard_questions, sample_set
from tests.tuning_tables.st.conftest import texts_of
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.storage import Array, Kind, Record, Scalar, Value
from tuning_tables import ControllerTable
from tuning_tables.aim.golden_aims import golden_selections
from tuning_tables.exports import TABLE_FILE
from tuning_tables.golden_tracks import golden_tracks
from tuning_tables.self_test_size import FULL, SMALL, SelfTestSize
from tuning_tables.table_book import TableBook

PAGE = Path(__file__).parents[3] / "docs" / "reference" / "structured-text.md"
CUTS = 300
CATEGORIES = range(1, 6)
HEAD = """
FUNCTION_BLOCK PAGE_PROGRAM
VAR_INPUT Begins : BOOL; Told : INT; CutAxles : INT; Command_m_s : REAL;
    FirstAxle : REAL; Radar : REAL; MeanOver : REAL; END_VAR
VAR_OUTPUT Present : INT; Speeds : ARRAY[1..5] OF REAL; There : ARRAY[1..5] OF BOOL; END_VAR
VAR After : INT; Raised : INT; Select : RETARDER_SELECT; NewCut : RETARDER_BEGIN; Observe : RETARDER_OBSERVE;
    Alarms : RETARDER_ALARMS;
"""


def unrolled(loop: re.Match[str]) -> str:
    """A loop over the categories as one text after the other: the evaluator has no arrays of records."""
    texts = (re.sub(r"\bEach\b", str(each), loop[1]) for each in CATEGORIES)
    return re.sub(r"\b(Tables|Cuts)\[(\d)\]", r"\1_\2", "".join(texts))


def block_of_the_page() -> str:
    """The page's program but for the decision, as a block."""
    blocks = re.findall(r"```\n(.*?)```", PAGE.read_text("utf-8"), re.S)
    (text,) = (each for each in blocks if "There[Each]" in each)
    text = re.sub(r"FOR Each := 1 TO 5 DO\n(.*?)END_FOR;", unrolled, text, flags=re.S)
    once, at_every_sample, _ = re.split(r"\(\* at every [^*]*\*\)", text)
    own = "".join(f"    Tables_{each} : RETARDER_TABLE; Cuts_{each} : RETARDER_ESTIMATE;\n" for each in CATEGORIES)
    return f"{HEAD}{own}END_VAR\nIF Begins THEN\n{once}END_IF;\n{at_every_sample}END_FUNCTION_BLOCK\n"


@pytest.mark.long
def test_the_page_goes_over_to_the_tables_that_python_does() -> None:
    book, cuts = weighed_book(), list(weighed_cuts(CUTS))
    program = Program(st_files(book)[TABLE_FILE] + block_of_the_page().encode("ascii"))
    instance = program.new("PAGE_PROGRAM")
    told, samples = np.array([each for each, _ in cuts]), np.array([each for _, each in cuts])
    expected = [list(braked_by(book, *cut)) for cut in cuts]
    for now in range(SAMPLES):
        s_m, v_m_s, kpa = samples[:, now].T
        program.call(
            "PAGE_PROGRAM", instance, Begins=now == 0, Told=told, CutAxles=4, Command_m_s=np.float32(TARGET_M_S),
            FirstAxle=s_m, Radar=v_m_s, MeanOver=kpa,
        )  # fmt: skip
        numbers, speeds = np.array([each[now] for each in expected]).T
        present = instance["PRESENT"].value
        assert np.array_equal(present, numbers)
        assert np.array_equal(instance["SPEEDS"].load(present, None), speeds.astype(np.float32))
    assert 100 < np.count_nonzero(present != told) < 250


BYTES = {"REAL": 4, "INT": 2, "BOOL": 1}


def stated(label: str) -> list[int]:
    """The numbers in the row of the page that begins with `label`."""
    (row,) = re.findall(rf"^\| {re.escape(label)}[^|]*\|(.*)\|$", PAGE.read_text("utf-8"), re.MULTILINE)
    return [int(number.replace(" ", "")) for number in re.findall(r"\d[\d ]*", row)]


def executed(program: Program, name: str, **arguments: Value) -> tuple[int, int]:
    """Operations of one call in all, and those on REAL among them."""
    instance = program.new(name)
    program.done.clear()
    program.call(name, instance, **arguments)
    return counted(program.done)


def counted(done: Counter[str]) -> tuple[int, int]:
    """Operations in all, and those on REAL."""
    return sum(done.values()), sum(count for kind, count in done.items() if kind.startswith("REAL"))


def size(kind: Kind) -> int:
    """Bytes of a variable without gaps."""
    if isinstance(kind, Scalar):
        return BYTES[kind.kind]
    if isinstance(kind, Array):
        return (kind.high - kind.low + 1) * BYTES[kind.element.kind]
    assert isinstance(kind, Record)
    return sum(size(member[0]) for member in kind.members.values())


def sloped_book(tables: tuple[ControllerTable, ...]) -> TableBook:
    """The tables with slopes."""
    return TableBook(tuple(with_slopes(table, -0.003, -0.003) for table in tables))


def estimating(book: TableBook) -> TableBook:
    """The tables with an estimator of 16 breaks for each class."""
    made = estimator_of(16, 37.45)
    shares = (0.15 if table.cut.mass_t < 30.0 else 0.16 for table in book.tables)
    pairs = zip(book.tables, shares, strict=True)
    return TableBook(tuple(replace(table, estimator=replace(made, friction_cv=cv)) for table, cv in pairs))


def program_of(book: TableBook) -> Program:
    """The text of a book."""
    return Program(texts_of(book, SMALL)[TABLE_FILE])


def dearest_decision(program: Program, tables: int, kpa: float = 0.0) -> tuple[int, int]:
    """Operations of the dearest decision, and those on REAL among them."""
    worst = (0, 0)
    for number in range(tables):
        table = program.new("RETARDER_TABLE")
        executed(program, "RETARDER_LOAD", TableNo=number, Table=table)
        for stage in range(5):
            for s in (-1.0, 10.0, 40.0):
                for v in np.array([0.0, 2.0, 3.0, 4.0, 5.0, 9.0], np.float32):
                    asked = {"Stage": stage, "Path_m": s, "Speed_m_s": v, "Pressure_kpa": np.float32(kpa)}
                    worst = max(worst, executed(program, "RETARDER_DECIDE", **asked, Table=table))
    return worst


def dearest_estimate(book: TableBook) -> tuple[int, int]:
    """Operations of the dearest sample."""
    program, worst = program_of(book), (0, 0)
    table, estimate, observer = (program.new(f"RETARDER_{name}") for name in ("TABLE", "ESTIMATE", "OBSERVE"))
    executed(program, "RETARDER_LOAD", TableNo=0, Table=table)
    for track in golden_tracks(book)[:7]:
        program.call("RETARDER_BEGIN", program.new("RETARDER_BEGIN"), Estimate=estimate)
        for s, v, kpa, *_ in zip(*track.samples, strict=True):
            program.done.clear()
            given = {"Path_m": s, "Speed_m_s": v, "Overpressure_kpa": kpa}
            program.call("RETARDER_OBSERVE", observer, **given, Table=table, Estimate=estimate)
            worst = max(worst, counted(program.done))
    return worst


def dearest_test(book: TableBook, self_test: SelfTestSize) -> tuple[int, int]:
    """Operations of the dearest call of the self-test."""
    program = Program(b"".join(texts_of(book, self_test).values()))
    instance, worst = program.new("RETARDER_SELF_TEST"), (0, 0)
    while not instance["DONE"].value:
        program.done.clear()
        program.call("RETARDER_SELF_TEST", instance, Restart=False)
        worst = max(worst, counted(program.done))
    return worst


def choice(book: TableBook, speed: float) -> tuple[int, int]:
    """Operations of a choice."""
    program = program_of(book)
    asked = {"Category": 1, "Axles": 4, "Commanded_m_s": speed}
    return executed(program, "RETARDER_SELECT", **asked, Table=program.new("RETARDER_TABLE"))


def loading(book: TableBook) -> tuple[int, int]:
    """Operations of loading table 0."""
    program = program_of(book)
    return executed(program, "RETARDER_LOAD", TableNo=0, Table=program.new("RETARDER_TABLE"))


def aims() -> Mapping[str, tuple[int, ...]]:
    """Operations of the dearest choice, load and question of 19 aim tables of up to 7 × 7 × 8 nodes."""
    made = sample_set()
    program = Program(aim_st_files(made)["aim_table.st"])
    chosen = [
        executed(program, "AIM_SELECT", Category=category, Measured=np.bool_(measured))
        for category, measured, _ in golden_selections(made)
    ]
    held = [program.new("AIM_TABLE") for _ in made.tables]
    loaded = [executed(program, "AIM_LOAD", TableNo=number, Table=table) for number, table in enumerate(held)]
    asked = hard_questions(made, 3000, 20261123)
    asked["cars"] = np.clip(asked["cars"], -32768, 32767)  # an INT has 16 bits
    found = [
        executed(
            program, "AIM_EXIT_SPEED", Table=held[table], Cars=int(cars), FreeDistance_m=distance,
            Resistance_n_per_kn=resistance,
        )
        for table, cars, distance, resistance in asked
    ]  # fmt: skip
    return {
        "`AIM_SELECT`, 19 tables": max(chosen),
        "`AIM_LOAD`, 7 × 7 × 8 nodes": max(loaded),
        "`AIM_EXIT_SPEED`, 7 × 7 × 8 nodes": max(found),
    }


def other_class(table: ControllerTable) -> ControllerTable:
    """The table as one of another category."""
    return replace(table, id=f"other {table.id}", cut=replace(table.cut, category="X", category_number=16))


def measured(book: TableBook) -> Mapping[str, tuple[int, ...]]:
    """All figures of the page by their labels."""
    plain, sloped, estimated = (program_of(each) for each in (book, sloped_book(book.tables), estimating(book)))
    tables = len(book.tables)
    others = [other_class(table) for table in book.tables]
    between, more = choice(book, 2.5), choice(TableBook((*book.tables, *others)), 2.5)
    small, full = (
        Program(b"".join(texts_of(book, each).values())).types["RETARDER_SELF_TEST"] for each in (SMALL, FULL)
    )
    return {
        "one `RETARDER_TABLE` of a plain book": (size(plain.types["RETARDER_TABLE"]),),
        "one `RETARDER_TABLE` of a book with estimators": (size(estimated.types["RETARDER_TABLE"]),),
        "one `RETARDER_TABLE` of a book with slopes": (size(sloped.types["RETARDER_TABLE"]),),
        "one `RETARDER_ESTIMATE`": (size(plain.types["RETARDER_ESTIMATE"]),),
        "constants of 6 tables, `RETARDER_LOAD`": (size(plain.types["RETARDER_LOAD"]),),
        "self-test of 6 tables, with all that it calls": (size(full),),
        "the same, small": (size(small),),
        "`RETARDER_DECIDE`, at rest": dearest_decision(plain, tables),
        "`RETARDER_DECIDE`, at any time with slopes": max(
            dearest_decision(sloped, tables, kpa) for kpa in (-9.0, 900.0)
        ),
        "`RETARDER_LOAD`, plain book": loading(book),
        "`RETARDER_LOAD`, book with estimators": loading(estimating(book)),
        "`RETARDER_OBSERVE`, 16 breaks": dearest_estimate(estimating(book)),
        "`RETARDER_SELECT`, between two tables": between,
        "`RETARDER_SELECT`, tuned": choice(book, 3.0),
        "`RETARDER_SELECT`, each further table": (
            (more[0] - between[0]) // len(others),
            (more[1] - between[1]) // len(others),
        ),
        **aims(),
        "`RETARDER_SELF_TEST`, full": dearest_test(book, FULL),
        "`RETARDER_SELF_TEST`, small": dearest_test(book, SMALL),
    }


@pytest.mark.long
def test_the_figures_of_the_page(default_book: TableBook) -> None:
    found = measured(default_book)
    assert {label: tuple(stated(label)) for label in found} == found
