"""The control computer: published figures beside ours, failures, benefit, and which of today's controllers carries
how many positions, from counted instructions of our exported code.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from scripts.studies.control_computer.benefit import BenefitOfControl, benefit_groups, benefit_of
from scripts.studies.control_computer.failures import Failures, failure_trials
from scripts.studies.control_computer.hump_runs import measured
from scripts.studies.control_computer.published import Published, published
from scripts.studies.study import ABSENT, Findings, MarkdownTable, Method, Tell, option, table
from synth.computer.sizing.carried_positions import PositionTimes, carried, most_positions
from synth.computer.sizing.trackside_controllers import TracksideController, usual_controllers

POSITIONS = (1, 3, 10, 38, 100, 1000)
"""3 on a route, 38 on the large hump with its park positions."""


@dataclass(frozen=True)
class CarriedRow:
    """So many positions on one controller: the longest times to an answer and to a table; None: not all is done."""

    controller: str
    positions: int
    answer_s: float | None
    answer_margin_s: float | None
    table_s: float | None
    used_share: float
    in_time: bool


@dataclass(frozen=True)
class Limit:
    """What a controller is, where its figures come from, and the most positions that are always in time."""

    controller: str
    sample_us: float
    cut_us: float
    most: int
    counted: str
    source: str


@dataclass(frozen=True)
class Controllers:
    """All of them; deadlines in s."""

    answer_deadline_s: float
    table_deadline_s: float
    rows: tuple[CarriedRow, ...]
    limits: tuple[Limit, ...]

    def tables(self) -> dict[str, MarkdownTable]:
        """`controllers`, `controller-limits`."""
        return {
            "controllers": table(
                f"positions on a controller: answers within {1e3 * self.answer_deadline_s:g} ms, tables within "
                f"{1e3 * self.table_deadline_s:g} ms",
                ("controller", "positions", "longest answer, ms", "margin, ms", "longest table, ms", "used, %",
                 "in time"),
                ((r.controller, str(r.positions), ms(r.answer_s), ms(r.answer_margin_s), ms(r.table_s),
                  f"{100 * r.used_share:.3g}", "yes" if r.in_time else "**no**") for r in self.rows),
            ),
            "controller-limits": table(
                "most positions that are always in time",
                ("controller", "a sample, µs", "a cut, µs", "most positions", "counts", "speed"),
                ((m.controller, f"{m.sample_us:.3g}", f"{m.cut_us:.3g}", str(m.most), m.counted, m.source)
                 for m in self.limits),
            ),
        }  # fmt: skip

    def faults(self) -> tuple[str, ...]:
        """The most positions must be in time in the rows, and more must not."""
        most = {limit.controller: limit.most for limit in self.limits}
        return tuple(
            f"{row.controller} with {row.positions} positions: the row and the most positions, {most[row.controller]}, "
            "contradict each other"
            for row in self.rows
            if row.in_time != (row.positions <= most[row.controller])
        )


def ms(value_s: float | None) -> str:
    """In milliseconds."""
    return ABSENT if value_s is None else f"{1e3 * value_s:.3g}"


def controllers() -> Controllers:
    """All of them."""
    times, usual = PositionTimes(), usual_controllers()
    rows = tuple(carried_row(each, times, count) for each in usual for count in POSITIONS)
    limits = tuple(
        Limit(each.name, 1e6 * each.sample_s, 1e6 * each.cut_s, most_positions(each, times), each.costs.source,
              each.source)
        for each in usual
    )  # fmt: skip
    return Controllers(times.answer_s, times.table_s, rows, limits)


def carried_row(controller: TracksideController, times: PositionTimes, positions: int) -> CarriedRow:
    """One of them."""
    found = carried(controller, times, positions)
    return CarriedRow(
        controller.name, positions, finite(found.answer_s), finite(found.answer_margin_s), finite(found.table_s),
        found.used_share, found.in_time,
    )  # fmt: skip


def finite(value: float) -> float | None:
    """None for what never ends."""
    return value if math.isfinite(value) else None


@dataclass(frozen=True)
class ControlComputer(Findings):
    """All parts."""

    published: Published
    failures: Failures
    benefit: BenefitOfControl
    controllers: Controllers

    def tables(self) -> Mapping[str, MarkdownTable]:
        """Those of all parts; see the titles."""
        parts = (self.published, self.failures, self.benefit, self.controllers)
        return {name: each for part in parts for name, each in part.tables().items()}

    def faults(self) -> tuple[str, ...]:
        """Every claim of the parts that does not hold."""
        return (
            *self.published.speeds.faults(),
            *self.failures.faults(),
            *self.benefit.faults(),
            *self.controllers.faults(),
        )


@dataclass(frozen=True)
class Options:
    """How much is simulated."""

    failure_trains: int = option(300, "trains with every failure", (2, 10**6))
    trains: int = option(300, "trains of every control of the hump", (2, 10**6))
    table_trains: int = option(200, "trains where positions run tables; 0: no tables are tuned", (0, 10**6))
    cuts: int = option(40, "cuts of a train", (2, 999))
    design_cuts: int = option(2000, "cuts that exit speeds of the last position are chosen on", (200, 200_000))
    replicates: int = option(2000, "bootstrap samples of the trains", (100, 10**6))
    workers: int = option(2, "processes; they change no result", (1, 1000))
    seed: int = option(18, "of all draws", (0, 10**9))


def run(options: Options, tell: Tell) -> ControlComputer:
    """All parts."""
    of_source = published(tell)
    failed = failure_trials(options.cuts)
    table_trains = min(options.table_trains, options.trains)
    variants = benefit_groups(options.seed, options.cuts, options.design_cuts, table_trains > 0, tell)
    tell("trials made")
    sizes = {name: table_trains if name == "tables" else options.trains for name in variants}
    humped = measured(
        [(failed.group, options.failure_trains), *((group, sizes[name]) for name, group in variants.items())],
        options.workers,
        tell,
    )
    return ControlComputer(
        published=of_source,
        failures=failed.found(humped),
        benefit=benefit_of(humped, tuple(variants), options.replicates, options.seed),
        controllers=controllers(),
    )


METHOD = Method(
    Options,
    Options(
        failure_trains=2, trains=2, table_trains=0, cuts=6, design_cuts=200,
        replicates=100, workers=1,
    ),
    ControlComputer,
    run,
)  # fmt: skip
