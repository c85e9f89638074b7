"""Tables, as tunes write them at rest and at any time, with and without estimator, beside what a competent
manufacturer would build: a predictive controller, and a PI with pulse width.

All have the same permission (commands at rest, or at any time), the same passes and, but for one, the same estimator.
Each is made twice: for the criterion of the tables, where a command has a price, and with commands that cost nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from scripts.studies.cases import CREATED, Case, named_cases, rounded, side_by_side
from scripts.studies.peers.findings import (
    AT_ANY_TIME,
    AT_REST,
    FREE,
    PREDICTIVE,
    PRICED,
    TABLE,
    TABLE_WITHOUT,
    Contest,
    Day,
    Figures,
    Peers,
)
from scripts.studies.peers.peer_loop import PeerLoop, PeerRegulator, peer_loop
from scripts.studies.peers.peer_tuning import FAMILIES, Aimed, Search, TunedPeer, tuned_peer
from scripts.studies.study import Method, Tell, option
from synth.problem.problem import Aim
from synth.retarder.class_setup import Origin, class_setup
from synth.retarder.configuration.config_file import load_config, parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.estimation.estimator_design import estimator_of
from synth.retarder.tuned_table import TunedTable, read_back, solutions, tuned_table
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.controllers import fixed
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.switching_lines import PolynomialLines
from tuning_tables import ControllerTable, Decisions, Estimator, Generator


@dataclass(frozen=True)
class TablePair:
    """Without estimator and with it."""

    without: ControllerTable
    with_estimator: ControllerTable


def tables_of(
    config: ResolvedConfig, case: Case, passes: RandomPasses, at_any_time: bool, price_m2_s2: float
) -> Mapping[Decisions, TablePair]:
    """The tables of `case` for each permission; at any time where asked.

    `price_m2_s2`: of a command, in the criterion.
    """
    origin = Origin(Generator("retarder-synth study", "0", config.sha256), CREATED)
    criterion = replace(config.criterion, switching_tolerance_m2_s2=price_m2_s2)

    def tuned(estimator: bool) -> Mapping[Decisions, ControllerTable]:
        changes = {"estimator": estimator, "commands": "any_time" if at_any_time else "at_rest"}
        asked = replace(config, regulator=config.regulator.model_copy(update=changes))
        setup = class_setup(asked, case.label, case.plant, passes, origin)
        (solution,) = solutions(setup.design, [Aim(case.target_m_s, criterion)])
        return tables_from(config, case, tuned_table(setup, solution))

    without, with_estimator = tuned(False), tuned(True)
    return {decisions: TablePair(without[decisions], with_estimator[decisions]) for decisions in without}


def tables_from(config: ResolvedConfig, case: Case, tuned: TunedTable) -> dict[Decisions, ControllerTable]:
    """Every table that one tune has made on its way."""
    estimator = tuned.table.estimator

    def stored(lines: PolynomialLines | PolynomialSurfaces, of: Estimator | None) -> ControllerTable:
        return read_back(rounded(config, case.plant, lines, case.target_m_s, of))

    made = {Decisions.AT_REST: stored(tuned.at_rest.lines, estimator)}
    if tuned.at_any_time is not None:
        made[Decisions.AT_ANY_TIME] = stored(tuned.at_any_time.lines, estimator)
    return made


FRESH, TUNING = 15485863, 15487469
"""Added to the configured seed: passes that neither tables nor anything else have seen, and those of the peers."""

FREE_M2_S2 = 1e-6
"""What a command costs a table for which commands are free: nearly nothing, so that no rounding decides on one."""

OTHERS = (
    ("three cars", '[targets]\nexit_speeds_m_s = [4.0]\n[[cut]]\ncar = "gondola-4"\ncars = 3\nmass_t = 156\n', "156:4"),
    ("park", '[position]\nname = "rnz-2m-park"\n[targets]\nexit_speeds_m_s = [2.5]\n[[cut]]\ncar = "gondola-4"\n'
     "mass_t = 36\n", "36:2.5"),
)  # fmt: skip
"""Plants besides those of the configuration: name, text, case."""

DAY_FACTORS = (0.8, 1.2)
"""Friction of other days. Tables are designed for any day; peers are tuned on the mean day, and estimate friction."""

PERMISSIONS = {Decisions.AT_REST: AT_REST, Decisions.AT_ANY_TIME: AT_ANY_TIME}


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    cases: tuple[str, ...] = option(("22:2", "22:3", "52:2", "52:3", "52:4", "85:4"), "mass, t : target, m/s")
    any_time: tuple[str, ...] = option(("22:2", "52:3", "85:4", "156:4"), "cases also with commands at any time")
    others: int = option(len(OTHERS), "how many other plants: a cut of three cars, the park", (0, len(OTHERS)))
    passes: int = option(10_000, "fresh passes of each controller", (200, 10**6))
    tuning: int = option(500, "passes that peers are tuned on", (100, 10**5))
    look: int = option(150, "of these, passes for a first look at a grid of their numbers", (20, 10**5))
    starts: int = option(3, "simplex searches from the best points of the grid", (1, 20))
    evaluations: int = option(40, "of each search", (1, 1000))
    day_passes: int = option(4000, "of the fresh passes, those repeated with other friction", (200, 10**6))


@dataclass(frozen=True)
class Order:
    """One case, and how it is asked; `passes` for figures, `tuning` for the peers."""

    config: ResolvedConfig
    case: Case
    name: str
    at_any_time: bool
    passes: RandomPasses
    tuning: RandomPasses
    search: Search
    day_passes: int


def run(options: Options, tell: Tell) -> Peers:
    """All cases."""
    orders = orders_of(options)
    config = orders[0].config

    def contests_of(order: Order) -> tuple[list[Contest], int]:
        found = contests(order)
        tell(order.name)
        return found

    found = side_by_side(contests_of, orders)
    ordered = [each for permission in PERMISSIONS.values() for price in (PRICED, FREE) for case, _ in found
               for each in case if (each.permission, each.price) == (permission, price)]  # fmt: skip
    return Peers(
        config.sha256, config.validation.seed + FRESH, options.passes, options.tuning, max(count for _, count in found),
        tuple(ordered),
    )  # fmt: skip


def orders_of(options: Options) -> list[Order]:
    """The cases of the configuration, then the others."""
    config = load_config(options.config)
    seed = config.validation.seed
    passes = stratified_passes(seed + FRESH, 0, options.passes), stratified_passes(seed + TUNING, 0, options.tuning)
    search = Search(options.look, options.starts, options.evaluations)
    named = [(config, case, case.name, word) for word, case in zip(options.cases, named_cases(config, options.cases),
                                                                   strict=True)]  # fmt: skip
    for name, text, word in OTHERS[: options.others]:
        other = parse_config(text, f"study peers: {name}")
        (case,) = named_cases(other, [word])
        named.append((other, case, f"{name}, {case.name}", word))
    return [
        Order(of, case, name, word in options.any_time, *passes, search, options.day_passes)
        for of, case, name, word in named
    ]


def contests(order: Order) -> tuple[list[Contest], int]:
    """All contests of a case, and the most evaluations of a tuning."""
    found, most = [], 0
    passes = common_passes(order.case.plant, order.passes)
    loop = peer_loop(passes.loop(order.case.plant.top_stage + 1))
    price = order.config.criterion.switching_tolerance_m2_s2
    for name, of_tables, of_peers in ((PRICED, price, price), (FREE, FREE_M2_S2, 0.0)):
        tables = tables_of(order.config, order.case, order.passes, order.at_any_time, of_tables)
        for decisions, pair in tables.items():
            aimed = Aimed(order.case.target_m_s, of_peers, decisions, estimator_of(order.case.plant))
            samples = samples_of_tables(pair, passes)
            tuned = tuned_peers(order, loop, passes, aimed)
            rivals = {each: (loop.run(peer.regulator, passes.draws), peer.parameters) for each, peer in tuned.items()}
            figures = figures_of({**samples, **rivals}, order.case.target_m_s)
            days = days_of(pair.with_estimator, tuned[PREDICTIVE].regulator, loop, passes.first(order.day_passes))
            found.append(Contest(order.name, PERMISSIONS[decisions], name, of_peers, figures, days))
            most = max(most, *(each.evaluations for each in tuned.values()))
    return found, most


Sampled = Mapping[str, tuple[ExitSample, Mapping[str, float]]]
"""By the name of a controller: its passes, and the numbers that tuning has found."""


def samples_of_tables(pair: TablePair, passes: CommonPasses) -> Sampled:
    """The table with estimator first."""
    tables = {TABLE: pair.with_estimator, TABLE_WITHOUT: pair.without}
    return {name: (passes.run(TableController(each)), {}) for name, each in tables.items()}


def tuned_peers(order: Order, loop: PeerLoop, passes: CommonPasses, aimed: Aimed) -> Mapping[str, TunedPeer]:
    """Every peer by its name."""
    tuning = passes.of_others(order.tuning)
    return {family.name: tuned_peer(family, loop, tuning, aimed, order.search) for family in FAMILIES}


def days_of(table: ControllerTable, regulator: PeerRegulator, loop: PeerLoop, passes: CommonPasses) -> tuple[Day, ...]:
    """A table and a peer, as they are, on days of other friction, which neither is told."""
    target, found = table.target_speed_m_s, []
    controller, draws = TableController(table), passes.draws
    for factor in DAY_FACTORS:
        of_day = draws._replace(brake_m_s2_per_kpa=fixed(factor * draws.brake_m_s2_per_kpa, np.float64))
        mine = passes.loop(controller.stages).run(controller, of_day)
        ratio, ratio_ci95 = rms_ratio(loop.run(regulator, of_day), mine, target)
        found.append(Day(factor, exit_statistics(mine, target).rms_m_s, ratio, ratio_ci95))
    return tuple(found)


def figures_of(sampled: Sampled, target_m_s: float) -> tuple[Figures, ...]:
    """The figures of all controllers beside the table with estimator."""
    reference, _ = sampled[TABLE]
    found = []
    for name, (sample, parameters) in sampled.items():
        each = exit_statistics(sample, target_m_s)
        ratio, ratio_ci95 = rms_ratio(sample, reference, target_m_s)
        found.append(
            Figures(
                name, each.rms_m_s, each.rms_ci95_m_s, ratio, ratio_ci95, each.p99_m_s, each.switchings, each.time_s,
                each.stalled, dict(parameters),
            )
        )  # fmt: skip
    return tuple(found)


SMALLEST = Options(None, ("52:3",), (), 0, 200, 100, 20, 1, 8, 200)
METHOD = Method(Options, SMALLEST, Peers, run)
