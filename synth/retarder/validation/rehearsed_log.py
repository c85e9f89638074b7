"""Passes of tables that were read from a file, as a controller would log them."""

from __future__ import annotations

from collections.abc import Sequence

from plant_models.pressure_gauge import PressureGauge
from synth.retarder.served_class import plant_for
from synth.retarder.validation.revalidation import Rehearsal
from synth.simulation.closed_loop import TableController
from synth.simulation.logged_passes import LoggedClass, mixed_log
from tuning_tables import ControllerTable
from tuning_tables.pass_log.pass_log import PassLog


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
