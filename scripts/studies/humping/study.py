"""The day of a hump: how fast trains can be humped, and what it costs in catch-ups, over-speeds and gaps.

Every variant humps the same trains with the same draws. Nothing is tuned to a published figure.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from scripts.studies.humping.base_trial import FEEDBACK, Day
from scripts.studies.humping.beside import PUBLISHED_SPEEDS_M_S
from scripts.studies.humping.causes import causes
from scripts.studies.humping.closed_loops import ClosedLoops, closed_loops
from scripts.studies.humping.couplings import AimedFigures, coupling_pairs
from scripts.studies.humping.disturbances import disturbance_pairs
from scripts.studies.humping.exits import TRAINS, exits_of
from scripts.studies.humping.findings import HumpDay, Inputs
from scripts.studies.humping.frontier import Frontier, frontier_groups, lines_of, normal_families
from scripts.studies.humping.gains import normal_gains, table_gains
from scripts.studies.humping.programs import program_pairs
from scripts.studies.humping.regulated_day import RegulatedDay
from scripts.studies.humping.runs import measured
from scripts.studies.humping.sensitivity import sensitivity_pairs
from scripts.studies.options import option
from scripts.studies.study import Method, Tell

TODAY_STD_M_S, ASKED_STD_M_S = 0.35, 0.15
"""Errors of the exit speed: of regulators as the computer of the 1970s had them, and as it asks for."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    trains: int = option(250, "trains of every variant", (2, 10**6))
    cuts: int = option(40, "cuts of a train", (2, 999))
    stds_m_s: tuple[float, ...] = option((0.03, 0.15, 0.35), "errors of the interval positions", (0.0, 1.0))
    least_s: tuple[float, ...] = option(
        (3.0, 2.0, 1.4, 1.0, 0.6, 0.3, 0.0, -0.4, -1.0, -2.0), "least intervals of the programs, falling", (-10.0, 10.0)
    )
    limits: tuple[float, ...] = option((0.001, 0.005), "shares of catch-ups that may not be passed", (1e-5, 0.5))
    design_cuts: int = option(2000, "cuts that exit speeds of the last position are chosen on", (200, 200_000))
    no_tables: bool = option(False, "tune no tables, run none")
    workers: int = option(2, "processes; they change no result", (1, 1000))
    seed: int = option(17, "of all draws", (0, 10**9))


def run(options: Options, tell: Tell) -> HumpDay:
    """All parts."""
    asked = Day(options.seed, options.cuts, ASKED_STD_M_S, design_cuts=options.design_cuts)
    today = replace(asked, std_m_s=TODAY_STD_M_S)
    base, worse = asked.trial(), today.trial()
    aimed = coupling_pairs(today, options.stds_m_s, tell)
    pairs = {
        "programs": program_pairs(worse),
        "disturbances": disturbance_pairs(asked, base, tell),
        "sensitivity": sensitivity_pairs(base),
        "couplings": list(aimed.values()),
    }
    loops = None if options.no_tables else closed_loops(asked, options.stds_m_s, tell)
    families = [normal_families(base, options.stds_m_s)]
    groups = [pair.group for of_part in pairs.values() for pair in of_part]
    if loops is not None:
        families.append(loops.families())
        groups += [pair.group for pair in (*loops.pairs(), *loops.couplings().values())]
    groups = [group for each in families for group in frontier_groups(each, options.least_s)] + groups
    outcomes = measured(groups, options.trains, options.workers, tell)
    found = {part: tuple(pair.found(outcomes) for pair in of_part) for part, of_part in pairs.items()}
    frontier = Frontier(
        outcomes, lines_of(*families), options.least_s, options.limits, PUBLISHED_SPEEDS_M_S, options.seed
    )
    return HumpDay(
        inputs=Inputs(options.trains, options.cuts, options.seed, base.planner.least_s, options.stds_m_s),
        curves=frontier.curves(),
        gains=normal_gains(frontier, options.stds_m_s),
        programs=found["programs"],
        couplings=tuple(map(AimedFigures, aimed, found["couplings"])),
        causes=causes(replace(worse, control=FEEDBACK), TODAY_STD_M_S, options.trains),
        disturbances=found["disturbances"],
        sensitivity=found["sensitivity"],
        regulated=None if loops is None else regulated_day(loops, frontier),
    )


def regulated_day(loops: ClosedLoops, frontier: Frontier) -> RegulatedDay:
    """What is found where positions work in their closed loop."""
    return RegulatedDay(
        gains=table_gains(frontier, loops),
        beside=tuple(pair.found(frontier.outcomes) for pair in loops.pairs()),
        couplings=loops.found_couplings(frontier.outcomes),
        exits=exits_of({name: made.on(loops.base) for name, made in loops.made.items()}, TRAINS),
    )


METHOD = Method(
    Options,
    Options(trains=2, no_tables=True, cuts=6, stds_m_s=(0.35,), least_s=(0.5, -0.5), design_cuts=200),
    HumpDay,
    run,
)
