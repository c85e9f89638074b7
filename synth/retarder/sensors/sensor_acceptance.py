"""What the simulated passes of tables for point sensors say of the limits that their configuration sets."""

from __future__ import annotations

from synth.retarder.acceptance import CaseVerdict, verdict_within
from synth.retarder.configuration.settings import AcceptanceSettings
from synth.retarder.judgement import judgement
from synth.retarder.sensors.sensor_case import SensorCase
from synth.retarder.sensors.sensor_tune import SensorBook
from synth.simulation.replicates import share_of


def judged(book: SensorBook) -> tuple[CaseVerdict, ...]:
    """The verdict on each case.

    A case is infeasible if its unavoidable error makes the rms miss the limit, with all of the 95 % interval: then no
    rule with these sensors keeps it.
    """
    return tuple(judge_sensor_case(case, book.config.acceptance) for case in book.cases)


def judge_sensor_case(case: SensorCase, limits: AcceptanceSettings) -> CaseVerdict:
    """The verdict on one case, from the passes that its table was simulated on."""
    error = case.exit_speeds_m_s.astype(float) - case.target_speed_m_s
    over = share_of(error > limits.overspeed_margin_m_s, case.exit_weight)
    found = judgement(case.statistics, over, case.table.predicted, limits)
    return verdict_within(case.name, found, case.unavoidable, limits)
