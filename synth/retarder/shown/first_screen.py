"""What a yard engineer asks first of a book of tables: what it keeps, how near cuts leave, what to do next."""

from __future__ import annotations

from collections.abc import Iterator
from statistics import median
from typing import Final

from synth.frame.exhibits import Sentence, Tile, Tiles
from synth.frame.printed_numbers import counted, decimals
from synth.retarder.acceptance import advice_of
from synth.retarder.found_book import FoundBook
from synth.retarder.tuned_case import Case

MILLIMETRES: Final = decimals(3)
"""A speed to a millimetre a second: what a reader at a glance can use."""


def tiles(found: FoundBook[Case]) -> Tiles:
    """The main figures."""
    near = (near_tile(found), worst_tile(found)) if found.feasible else ()
    return Tiles((kept_tile(found), *near, *weak_tiles(found)))


def kept_tile(found: FoundBook[Case]) -> Tile:
    """How many tables keep all limits."""
    asked = len(found.book.cases) + len(found.book.failed)
    kept = sum(verdict.word == "accepted" for verdict in found.verdicts)
    open_ones = any(verdict.word == "not decidable" for verdict in found.verdicts)
    missed = bool(found.book.failed) or any(verdict.word == "missed" for verdict in found.verdicts)
    told = "tables (cut class and exit speed) keep all limits"
    return Tile(f"{kept} of {asked}", told, False if missed else None if open_ones or not kept else True)


def near_tile(found: FoundBook[Case]) -> Tile:
    """How near to the commanded speed cuts leave."""
    near = [case.statistics.p95_m_s for case in found.feasible]
    words = (
        f"of the commanded speed leave 95 of 100 cuts: median of {counted(len(near), 'table')}, from "
        f"±{MILLIMETRES(min(near))} to ±{MILLIMETRES(max(near))}"
    )
    return Tile(f"±{MILLIMETRES(median(near))} m/s", words)


def worst_tile(found: FoundBook[Case]) -> Tile:
    """The largest rms error beside its limit."""
    limit = found.book.config.acceptance.rms_m_s
    worst = max(found.feasible, key=lambda case: case.statistics.rms_m_s)
    low, high = worst.statistics.rms_ci95_m_s
    kept = True if high <= limit else False if low > limit else None
    words = f"is the largest rms error ({worst.label} to {worst.target_speed_m_s:g} m/s); allowed is {limit:g} m/s"
    return Tile(f"{MILLIMETRES(worst.statistics.rms_m_s)} m/s", words, kept)


def weak_tiles(found: FoundBook[Case]) -> Iterator[Tile]:
    """For how many cases no controller would do, where there are some."""
    weak = [case for case, verdict in found.judged if not verdict.feasible]
    if weak:
        names = ", ".join(f"{case.label} to {case.target_speed_m_s:g} m/s" for case in weak)
        yield Tile(str(len(weak)), f"for {names} no controller keeps the limit: the position itself cannot")


def to_do(found: FoundBook[Case]) -> Iterator[Sentence]:
    """Steps, the most urgent first; the terminal has what follows from the verdict."""
    if advice := advice_of(found.verdicts):
        yield Sentence(advice, brief=True, to_do=True)
    for step in next_steps(found):
        yield Sentence(step, to_do=True)


def next_steps(found: FoundBook[Case]) -> Iterator[str]:
    """What is to be done with every book."""
    parameters = found.book.config.parameters
    assumed = sum(each.assumed for each in parameters)
    if assumed:
        yield (
            f"Measure your retarder: {assumed} of {counted(len(parameters), 'parameter')} are assumed, and every "
            "figure here depends on them. 'retarder-synth sensitivity' tells which to measure first, 'retarder-synth "
            "identify' reads them from logs."
        )
    yield "Check the tables with the independent program: retarder-synth verify DIR."
    yield "Load tables/*.json or the code in c/ into the control computer, and try it on the track."
