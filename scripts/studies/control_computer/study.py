"""The control computer: published figures beside ours, failures, benefit, controllers."""

from __future__ import annotations

from dataclasses import dataclass

from scripts.studies.control_computer.benefit import benefit_groups, benefit_of
from scripts.studies.control_computer.controllers import controllers
from scripts.studies.control_computer.failures import failure_trials
from scripts.studies.control_computer.findings import ControlComputer
from scripts.studies.control_computer.hump_runs import measured
from scripts.studies.control_computer.published import published
from scripts.studies.options import option
from scripts.studies.study import Method, Tell


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
