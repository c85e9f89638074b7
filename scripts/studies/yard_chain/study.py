"""The chain from the park position to the standing cars: which accuracy and which knowledge leave which gaps.

Positions: ideal, with normal errors, and in the closed loop under the tuned energy rule and under our tables. Exit
speeds are chosen for a share of over-speeds on some cuts and judged on others; all variants have the same cuts.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from scripts.studies.aiming.hump import large_hump
from scripts.studies.aiming.trial import Draws, outcomes
from scripts.studies.options import option
from scripts.studies.study import Method, Tell
from scripts.studies.yard_chain.chain import (
    BUNCH_SPEED_M_S,
    CATEGORY,
    ESTIMATED,
    MEASURED,
    RADAR,
    BookSize,
    Kind,
    brake_saturated,
    chain_samples,
    knowledge_of,
    positions_of,
)
from scripts.studies.yard_chain.details import approach_row, fault_rows, record_rows, stretch_rows
from scripts.studies.yard_chain.findings import Chain, YardChain
from scripts.studies.yard_chain.practices import HEAVY, LIGHT, Samples, practices, saved
from synth.aim.knowledge import Knowledge
from synth.aim.position_models import PositionModel


@dataclass(frozen=True)
class Options:
    """What is studied."""

    p_overspeed: float = option(0.1, "share of over-speeds that commands keep", (0.01, 0.5))
    careful_share: float = option(0.05, "share of the last practice", (0.001, 0.5))
    metres: tuple[float, ...] = option((100.0, 200.0, 300.0), "free distances behind the position", (20.0, 500.0))
    cars: tuple[int, ...] = option((1, 3), "cars of a cut; 1 must be among them", (1, 20))
    records: int = option(300, "recorded cuts of the three control points", (10, 100_000))
    records_compared: tuple[int, ...] = option((30, 100, 300, 1000, 3000), "recorded cuts compared", (10, 10**5))
    lengths_m: tuple[float, ...] = option((25.0, 50.0, 110.0), "lengths of the stretch compared", (5.0, 130.0))
    stds_m_s: tuple[float, ...] = option((0.01, 0.03, 0.1), "errors of the speeds compared", (1e-3, 1.0))
    classes: int = option(2, "classes of cuts by mass in a book of the position", (1, 2))
    tables: int = option(6, "tables of a class, of as many exit speeds", (2, 6))
    detail_m: float = option(200.0, "free distance of these comparisons", (20.0, 500.0))
    replicates: int = option(5, "independent replicates", (2, 1000))
    design: int = option(3000, "cuts of a replicate that commands are chosen on", (200, 10**6))
    report: int = option(3000, "cuts of a replicate that commands are judged on", (200, 10**6))
    seed: int = option(15, "of all draws", (0, 10**9))
    coarse: bool = option(False, "tables on a coarse grid, to see that it runs")


def run(options: Options, tell: Tell) -> YardChain:
    """All parts."""
    hump = large_hump()
    draws = Draws(options.replicates, options.design, options.report, options.seed)
    books = BookSize(options.classes, options.tables, options.coarse)
    found: dict[Kind, Samples] = {}
    careful: dict[Kind, Samples] = {}
    detailed: PositionModel | None = None
    for category in ("L", "T"):
        for cars in options.cars:
            kind = Kind(category, cars)
            positions = positions_of(kind.cuts(hump), books)
            tell(f"{kind.name}: tables tuned")
            found[kind] = samples_of(kind, positions, knowledge_of(options.records), options, draws)
            if cars == 1:
                straight = Kind(category, 1, True)
                ways = {name: knowledge_of(options.records)[name] for name in (CATEGORY, MEASURED, RADAR)}
                found[straight] = samples_of(straight, positions, ways, options, draws)
                few = {ESTIMATED: positions[ESTIMATED]}
                careful[straight] = samples_of(straight, few, {MEASURED: ways[MEASURED]}, options, draws, True)
            if kind == LIGHT:
                detailed = positions[ESTIMATED]
            tell(f"{kind.name}: aimed")
    assert detailed is not None, "light single cars are always among the cuts"
    light, p, at = LIGHT.cuts(hump), options.p_overspeed, options.detail_m
    many = replace(draws, design=max(draws.design, 2 * max(options.records_compared)))
    records = tuple(record_rows(light, detailed, options.records_compared, at, p, many))
    stretches = tuple(stretch_rows(hump, options.lengths_m, options.stds_m_s, at, p, draws))
    faulty = tuple(fault_rows(light, detailed, options.records, at, p, draws))
    tell("records, stretches, faults")
    return YardChain(
        draws=draws,
        p_overspeed=p,
        metres=options.metres,
        chains=tuple(chain_of(kind, samples) for kind, samples in found.items()),
        practices=practices(found, careful, options.careful_share),
        saved=tuple(row for kind in (LIGHT, HEAVY) for row in saved(kind, found[kind], options.metres)),
        detail_m=at,
        records=records,
        stds_m_s=options.stds_m_s,
        stretches=stretches,
        faulty=faulty,
        approach=approach_row(light, detailed, at, p, draws),
        brake_saturated={
            f"{speed:g}": brake_saturated(hump, speed, books, options.report, options.seed)
            for speed in (BUNCH_SPEED_M_S["L"], BUNCH_SPEED_M_S["T"])
        },
    )


def samples_of(
    kind: Kind,
    positions: Mapping[str, PositionModel],
    knowledge: Mapping[str, Knowledge],
    options: Options,
    draws: Draws,
    careful: bool = False,
) -> Samples:
    """The figures of one kind of cuts."""
    share = options.careful_share if careful else options.p_overspeed
    figures = chain_samples(kind.cuts(large_hump()), options.metres, positions, knowledge, share, draws)
    return Samples(tuple(knowledge), tuple(positions), figures)


def chain_of(kind: Kind, samples: Samples) -> Chain:
    """The outcomes of one kind of cuts."""
    found = tuple(
        tuple(outcomes(np.asarray(samples.figures[:, i, j])) for j in range(len(samples.positions)))
        for i in range(len(samples.knowledge))
    )
    return Chain(kind.name, samples.knowledge, samples.positions, found)


METHOD = Method(
    Options,
    Options(metres=(100.0,), cars=(1,), records=50, records_compared=(30,), lengths_m=(50.0,), stds_m_s=(0.03,),
            classes=1, tables=2, detail_m=100.0, replicates=2, design=400, report=300, coarse=True),
    YardChain,
    run,
)  # fmt: skip
