"""What a sweep shows: its books side by side, a row for each table, what lines between two lose, what has failed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict
from functools import partial
from statistics import median
from typing import TYPE_CHECKING, Final

from synth.frame.command import Limit
from synth.frame.exhibits import Chapter, Chart, Column, Exhibit, Row, Sentence, Table
from synth.frame.printed_numbers import counted, decimals
from synth.retarder.exit_figures import CASE, DETAILS, EFFORT, LEGEND, TOLD
from synth.retarder.shown.cases import IDENTITY, PROMISE
from synth.retarder.sweep.book_figures import BookFigures

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_ROWS: Final = 300
"""Of a table on a page; a longer one is in its sheet alone."""

CONDITION: Final = Column("condition", "condition", words=True, once=True)
LABEL: Final = Column("label", "case", words=True, once=True)
BOOKS: Final = (
    CONDITION,
    Column("book", "book", words=True, spare=4),
    Column("classes", "classes"),
    Column("tables", "tables"),
    Column("failed", "classes failed", spare=5),
    Column("refused_targets", "targets without a table", spare=6),
    Column("median_rms_m_s", "median rms", "m/s", decimals(4)),
    Column("highest_rms_m_s", "highest rms", "m/s", decimals(4)),
    Column("missing_a_limit", "tables that miss a limit", spare=1),
    Column("highest_interpolation_loss_m_s", "highest loss between two tables", "m/s", decimals(4), spare=2),
    Column("shadowed_tables", "tables shadowed", spare=3),
    Column("no_controller_code", "why it makes no controller code", words=True, detail=True),
)
CASES: Final = (
    CONDITION, *CASE, *TOLD, *EFFORT, *DETAILS, *IDENTITY, *PROMISE,
    Column("missed_limits", "limits missed", words=True, detail=True),
    Column("undecided_limits", "limits not decidable", words=True, detail=True),
)  # fmt: skip
GAPS: Final = (
    CONDITION,
    LABEL,
    Column("low_m_s", "from target", "m/s"),
    Column("high_m_s", "to target", "m/s"),
    Column("middle_m_s", "middle", "m/s"),
    Column("own_rms_m_s", "rms of a table for the middle", "m/s", decimals(4)),
    Column("between_rms_m_s", "rms of the lines between", "m/s", decimals(4)),
    Column("loss_m_s", "loss", "m/s", decimals(5)),
    Column("refined", "split, the table kept"),
)
FAILED: Final = (
    CONDITION,
    LABEL,
    Column("target_m_s", "target", "m/s"),
    Column("reason", "reason", words=True),
)

HOW_TO_READ: Final = (
    "The limits are those of [acceptance]. Shadowed: not reached by a choice by category and axles alone, which takes "
    "the heaviest class. Loss: the rms of the lines that a controller takes half-way between two targets, less that of "
    "a table tuned for the middle, both exactly predicted; the highest of the gaps that were left."
)


def limits_of(books: Sequence[BookFigures]) -> Iterable[Limit]:
    """That every target of every class has a table, where that is not so."""
    failures = [failure for book in books for failure in book.failures]
    if failures:
        first, others = failures[0], len(failures) - 1
        more = f"; nor for {others} more, all of which 'retarder-synth sweep failed' tells" if others else ""
        yield Limit(f"there is no table for {first.name}: {first.reason}{more}", False)


def chapters(books: Sequence[BookFigures]) -> Iterator[Chapter]:
    """The figures of these books."""
    yield Chapter("Books", tuple(overview(books)))
    cases = [case for book in books for case in book.cases]
    passes = books[0].condition.config.validation.passes
    yield Chapter(
        "Tables",
        (Sentence(f"{passes} stratified passes a table. {LEGEND}"), table("cases", "Every table", CASES, cases)),
    )
    gaps = [gap for book in books for gap in book.gaps]
    if gaps:
        yield Chapter("Between two tables", (table("interpolation", "Gaps that were measured", GAPS, gaps),))


def table(name: str, title: str, columns: Sequence[Column], rows: Sequence[Row]) -> Table:
    """A table with a row for each table, gap or failure; those whose limits are missed are marked."""
    return Table(name, title, columns, rows, bad=lambda row: bool(row.get("missed_limits")), long=len(rows) > MOST_ROWS)


def overview(books: Sequence[BookFigures]) -> Iterator[Exhibit]:
    """A row for each book; what has failed; what may be thought of it."""
    config = books[0].condition.config
    yield Table("conditions", config.title, BOOKS, [book_row(book) for book in books], brief=True)
    number, missing = sum(len(book.cases) for book in books), sum(book.missing_a_limit for book in books)
    yield Sentence(
        f"A sweep judges no table, for it does not know which cases are feasible; {missing} of "
        f"{counted(number, 'table')} miss a limit of [acceptance].",
        {"criterion": config.criterion.sentence, "tables": number, "missing_a_limit": missing},
        brief=True,
    )
    for book in books:
        if book.no_code:
            yield Sentence(f"{book.condition.said('')}the book makes no controller code: {book.no_code}.", brief=True)
    yield Sentence(HOW_TO_READ)
    failures = [failure for book in books for failure in book.failures]
    if failures:
        rows = [{**asdict(each), "condition": each.condition or None} for each in failures]
        yield table("failed", "Classes and targets without a table", FAILED, rows)


def book_row(book: BookFigures) -> Row:
    """The figures of one condition."""
    rms = [case["rms_m_s"] for case in book.cases]
    condition = book.condition
    return {
        "condition": condition.name or None,
        "book": condition.file("book.h5") if rms else None,
        "classes": len(condition.config.cuts),
        "tables": len(rms),
        "failed": book.failed_classes,
        "refused_targets": book.refused_targets,
        "median_rms_m_s": median(each.value for each in rms) if rms else None,
        "highest_rms_m_s": max(rms, key=lambda each: each.value, default=None),
        "missing_a_limit": book.missing_a_limit,
        "highest_interpolation_loss_m_s": book.highest_loss_m_s,
        "shadowed_tables": book.shadowed,
        "no_controller_code": book.no_code or None,
    }


def pictures(books: Sequence[BookFigures]) -> Iterator[Chart]:
    """The heat map of each book that has a table."""
    for book in books:
        if book.cases:
            yield Chart(
                "-".join(filter(None, ("rms-by-mass-and-target", book.condition.name))),
                book.condition.said("exit-speed error of every table"),
                f"{book.condition.said('')}simulated rms over commanded exit speed and cut class.",
                partial(drawn, book),
            )


def drawn(book: BookFigures) -> Figure:
    """The heat map; matplotlib is loaded here."""
    from synth.retarder.sweep.heat_map import heat_map

    return heat_map(book)
