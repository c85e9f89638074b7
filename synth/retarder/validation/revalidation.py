"""The closed loop of tables that were read from a file: nothing is solved again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

from plant_models.pressure_regulator import PressureGauge
from synth.frame.workers.engine import Tell, silent
from synth.retarder.comparison.measured import Judgement, judgement, prediction_ratio_of
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.sensors.sensor_case import full_brake as full_brake_at_passages
from synth.retarder.served_class import PassageClass, ServedClass, plant_for, served_class
from synth.simulation.closed_loop import TableController, simulate_many
from synth.simulation.controllers import Controller, full_brake
from synth.simulation.exit_statistics import BrakePower, ExitStatistics, brake_power, exit_statistics, overspeed_of
from synth.simulation.passage_controller import PassageController, of_table
from synth.simulation.passage_loop import close_passage_loop, simulate_passages
from synth.simulation.passes import ExitSample
from synth.simulation.replicates import Interval
from synth.simulation.sampled_pass import LoggedClass, mixed_log
from tuning_tables import ControllerTable
from tuning_tables.document import StageTable
from tuning_tables.pass_log.pass_log import PassLog
from tuning_tables.passages.passage_table import PassageTable


@dataclass(frozen=True)
class Revalidation:
    """What the passes of `plant` under `table` gave, beside what the file says of itself.

    `overspeed`: share of passes above target + margin of the limits, with its interval; `confirmed`: the 95 % intervals
    of the file and of these passes overlap, None where the file has none; `judgement`: what the passes say of the
    limits; `infeasible`: the summary beside the file calls the case so; `same_config`: the table was made from this
    very configuration.
    """

    table: StageTable
    label: str
    statistics: ExitStatistics
    brake_power: BrakePower
    overspeed: tuple[float, Interval]
    prediction_ratio: tuple[float, Interval]
    confirmed: bool | None
    judgement: Judgement
    infeasible: bool
    same_config: bool

    @property
    def told(self) -> str:
        """The table and its rms in a sentence."""
        return f"{self.table.id}: {self.statistics.rms_text} in {self.statistics.passes} passes"


@dataclass(frozen=True)
class Rehearsal:
    """What every table of a source is simulated with: the plants of `config`, and `passes` passes of `seed`."""

    config: ResolvedConfig
    source: str
    passes: int
    seed: int
    threads: int

    def run(self, served: ServedClass, controller: Controller | PassageController) -> ExitSample:
        """The passes of a class under `controller`."""
        if not isinstance(controller, PassageController):
            return simulate_many(served.plant, controller, self.seed, self.passes, threads=self.threads)
        assert isinstance(served, PassageClass)
        return simulate_passages(served.plant, served.sensors, controller, self.seed, self.passes, threads=self.threads)


def revalidated(
    tables: Sequence[StageTable], rehearsal: Rehearsal, infeasible: Sequence[bool], tell: Tell = silent
) -> list[Revalidation]:
    """Simulate each table on the cut class that it is for; `InputError` if there is none for one of them.

    `tell` is given a sentence for each.
    """

    @cache
    def at_full_brake(served: ServedClass, stages: int) -> ExitSample:
        return rehearsal.run(served, hardest(served, stages))

    found = []
    for table, known in zip(tables, infeasible, strict=True):
        served, controller = served_class(table, rehearsal.config, rehearsal.source), regulator_of(table)
        sample = rehearsal.run(served, controller)
        power = brake_power(sample, at_full_brake(served, controller.stages), table.target_speed_m_s)
        found.append(revalidation(table, served.label, sample, power, known, rehearsal.config))
        tell(found[-1].told)
    return found


def regulator_of(table: StageTable) -> TableController | PassageController:
    """The regulator that runs `table`, with its tracker where it decides at passages."""
    return of_table(table, tracking=True) if isinstance(table, PassageTable) else TableController(table)


def hardest(served: ServedClass, stages: int) -> Controller | PassageController:
    """The regulator that decides as one of so many stages, and for more brake whenever it may."""
    plant = served.plant
    if not isinstance(served, PassageClass):
        return full_brake(plant.top_stage + 1, plant.start_m, plant.exit_m)
    return full_brake_at_passages(close_passage_loop(plant, served.sensors, stages))


def revalidation(
    table: StageTable, label: str, sample: ExitSample, power: BrakePower, infeasible: bool, config: ResolvedConfig
) -> Revalidation:
    """What `sample` says of `table`, beside what the table says of itself."""
    target, limits = table.target_speed_m_s, config.acceptance
    found = exit_statistics(sample, target)
    over = overspeed_of(sample, target, limits.overspeed_margin_m_s)
    return Revalidation(
        table=table,
        label=label,
        statistics=found,
        brake_power=power,
        overspeed=over,
        prediction_ratio=prediction_ratio_of(table.predicted.rms_m_s, table.predicted.passes, found),
        confirmed=confirmed(table, found),
        judgement=judgement(found, over, table.predicted, limits),
        infeasible=infeasible,
        same_config=table.generator.config_sha256 == config.sha256,
    )


def confirmed(table: StageTable, found: ExitStatistics) -> bool | None:
    """Whether the interval that the file states and that of `found` overlap."""
    if table.validated is None:
        return None
    low, high = table.validated.rms_ci95_m_s
    return low <= found.rms_ci95_m_s[1] and found.rms_ci95_m_s[0] <= high


def rehearsed_log(
    tables: Sequence[ControllerTable], rehearsal: Rehearsal, passes: int, gauge: PressureGauge | None
) -> PassLog:
    """`passes` passes of each table on the cut class that it is for, as cuts come, in a shuffled order.

    Plants and seed are those of `rehearsal`; but its passes are stratified, and these are drawn as they come.
    `gauge`: what is on the drive, None for nothing. `InputError` if there is no class for one of the tables.
    """
    classes = [
        LoggedClass(
            plant_for(table, rehearsal.config, rehearsal.source)[1], TableController(table), table.target_speed_m_s
        )
        for table in tables
    ]
    return mixed_log(classes, [passes] * len(classes), rehearsal.seed, gauge)
