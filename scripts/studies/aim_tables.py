"""The aim tables of the default configuration: gaps and over-speeds by category, knowledge and free distance."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from scripts.studies.study import Findings, MarkdownTable, Method, Tell, around, option, table
from synth.aim.aim_book import MadeAim, aim_book, judge_aims
from synth.aim.configuration.aim_file import parse_aim_file
from synth.aim.resolved_aim import resolve_aim
from synth.frame.faults import InputError
from synth.frame.printed_numbers import percent
from synth.frame.settings.settings_file import BUILT_IN
from synth.frame.version import creation_time
from synth.simulation.replicates import Interval

KNOWN = {"category": "category", "measured": "and resistance"}


@dataclass(frozen=True)
class Options:
    """Which cuts and distances, and on how many cuts speeds are chosen; half as many others judge them."""

    cars: tuple[int, ...] = option((1, 5), "numbers of cars", (1, 60))
    distances_m: tuple[float, ...] = option((100.0, 200.0, 400.0), "free distances, m", (1.0, 600.0))
    passes: int = option(20_000, "cuts that speeds are chosen on", (1000, 10**6))


@dataclass(frozen=True)
class Row:
    """A table and a number of cars; lists by free distance. Gap: mean of a cut; over-speed and `without`: shares."""

    category: str
    knowledge: str
    cars: int
    gap_m: tuple[float, ...]
    gap_ci95_m: tuple[Interval, ...]
    overspeed: tuple[float, ...]
    overspeed_ci95: tuple[Interval, ...]
    without: tuple[float, ...]


@dataclass(frozen=True)
class AimTables(Findings):
    """All rows."""

    config_sha256: str
    seed: int
    distances_m: tuple[float, ...]
    accepted: bool
    verdict: str
    rows: tuple[Row, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`gaps`: mean gaps with intervals, then over-speeds and cuts without speed at the longest distance."""
        last = len(self.distances_m) - 1
        cells = [
            (
                row.category,
                KNOWN[row.knowledge],
                str(row.cars),
                *(around(gap, ends, 1) for gap, ends in zip(row.gap_m, row.gap_ci95_m, strict=True)),
                f"{percent(row.overspeed[last])} [{', '.join(percent(end) for end in row.overspeed_ci95[last])}]",
                percent(row.without[last]),
            )
            for row in self.rows
        ]
        distances = (f"gap at {distance:g} m, m" for distance in self.distances_m)
        at_last = f"at {self.distances_m[last]:g} m, %"
        heads = ("category", "known", "cars", *distances, f"over-speed {at_last}", f"without a speed {at_last}")
        return {"gaps": table("Mean gap of a cut that is aimed by table", heads, cells)}

    def faults(self) -> tuple[str, ...]:
        """The verdict, if the tables miss what is required."""
        return () if self.accepted else (self.verdict,)


def run(options: Options, tell: Tell) -> AimTables:
    """One aim, by the steps of the command."""
    text = (
        f"[cuts]\ncars = {sorted(options.cars)}\n[aim]\nfree_distances_m = {sorted(options.distances_m)}\n"
        f"[simulation]\npasses = {options.passes}\n"
    )
    try:
        config = resolve_aim(parse_aim_file(text, BUILT_IN))
    except InputError as fault:
        raise InputError(*(f"study aim-tables: {sentence}" for sentence in fault.sentences)) from None
    book = aim_book(config, creation_time(), tell)
    verdict = judge_aims(book.tables, config.acceptance.p_excess)
    return AimTables(
        config_sha256=config.sha256,
        seed=config.simulation.seed,
        distances_m=config.aim.free_distances_m,
        accepted=verdict.accepted,
        verdict=verdict.sentence,
        rows=tuple(row_of(made, place) for made in book.tables for place in range(len(config.cars))),
    )


def row_of(made: MadeAim, place: int) -> Row:
    """The figures of the number of cars at `place`."""
    found = made.speeds.of_all
    gaps = zip(found.gap_low95_m[place].tolist(), found.gap_high95_m[place].tolist(), strict=True)
    over = zip(found.overspeed_low95[place].tolist(), found.overspeed_high95[place].tolist(), strict=True)
    return Row(
        category=made.category.name,
        knowledge=made.knowledge,
        cars=made.speeds.order.cars[place],
        gap_m=tuple(found.gap_m[place].tolist()),
        gap_ci95_m=tuple(gaps),
        overspeed=tuple(found.overspeed[place].tolist()),
        overspeed_ci95=tuple(over),
        without=tuple(found.without[place].tolist()),
    )


METHOD = Method(Options, Options(cars=(1,), distances_m=(50.0, 100.0), passes=1000), AimTables, run)
