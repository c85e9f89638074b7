"""Whether the tables for point sensors of a book keep the limits that its configuration sets, case by case."""

from __future__ import annotations

from synth.book.acceptance import CaseVerdict, Verdict, verdict_on, verdict_within
from synth.book.judgement import judgement
from synth.book.sensors.sensor_case import SensorCase
from synth.book.sensors.sensor_tune import SensorBook
from synth.configuration.settings import AcceptanceSettings
from synth.simulation.replicates import share_of


def judge_sensors(book: SensorBook) -> Verdict:
    """The verdict on the simulated passes of all cases.

    A case is infeasible if its unavoidable error makes the rms miss the limit, with all of the 95 % interval: then no
    rule with these sensors keeps it.
    """
    limits = book.config.acceptance
    judged = tuple(judge_sensor_case(case, limits) for case in book.cases)
    return verdict_on(judged, [case.statistics for case in book.cases], limits, book.failed)


def judge_sensor_case(case: SensorCase, limits: AcceptanceSettings) -> CaseVerdict:
    """The verdict on one case, from the passes that its table was simulated on."""
    error = case.exit_speeds_m_s.astype(float) - case.target_speed_m_s
    over = share_of(error > limits.overspeed_margin_m_s, case.exit_weight)
    found = judgement(case.statistics, over, case.table.predicted, limits)
    return verdict_within(case.name, found, case.unavoidable, limits)
