"""The closed loop of tables for point sensors that were read from a file: nothing is solved again."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from synth.retarder.passage_class import PassageClass, passage_class
from synth.retarder.sensors.sensor_class import full_brake
from synth.retarder.validation.revalidation import Rehearsal, Revalidation, Tell, no_notice, revalidation
from synth.simulation.exit_statistics import brake_power
from synth.simulation.passage_controller import PassageController, of_table
from synth.simulation.passage_loop import close_passage_loop, simulate_passages
from synth.simulation.passage_sample import PassageSample
from tuning_tables.passages.passage_table import PassageTable


def revalidated_passages(
    tables: Sequence[PassageTable], rehearsal: Rehearsal, infeasible: Sequence[bool], tell: Tell = no_notice
) -> list[Revalidation]:
    """Simulate each table, with its tracker, on the cut class that it is for; `InputError` if there is none."""

    def run(made_for: PassageClass, controller: PassageController) -> PassageSample:
        return simulate_passages(
            made_for.plant,
            made_for.sensors,
            controller,
            rehearsal.seed,
            rehearsal.passes,
            threads=rehearsal.threads,
        )

    @cache
    def at_full_brake(made_for: PassageClass, stages: int) -> PassageSample:
        return run(made_for, full_brake(close_passage_loop(made_for.plant, made_for.sensors, stages)))

    found = []
    for table, known in zip(tables, infeasible, strict=True):
        made_for = passage_class(table, rehearsal.config, rehearsal.source)
        sample = run(made_for, of_table(table, tracking=True))
        power = brake_power(sample, at_full_brake(made_for, len(table.pressure_kpa)), table.target_speed_m_s)
        found.append(revalidation(table, made_for.label, sample, power, known, rehearsal.config))
        tell(found[-1].told)
    return found
