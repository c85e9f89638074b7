"""A path that treadles set right within the passes: the numbers stay what they are without."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from synth.studies.identification.truths import TRUTHS, Yard
from synth.yard.measured_passes.estimate import posterior
from synth.yard.measured_passes.fitting_passes import FittingPasses
from synth.yard.measured_passes.identify_summary import log_sentences
from synth.yard.measured_passes.pass_rows import pass_rows
from synth.yard.measured_passes.unknowns import unknowns_of
from tuning_tables.pass_log.pass_log import PassLog

TREADLE_M = 12.0


def set_right(log: PassLog, off_m: float) -> PassLog:
    """Its path is `off_m` too far until the treadle, and right behind it."""
    return replace(log, path_m=np.where(log.path_m < TREADLE_M, log.path_m + off_m, log.path_m))


@pytest.mark.parametrize("off_m", [0.2, -0.2])
def test_steps_are_those_of_the_cut(passes: FittingPasses, off_m: float) -> None:
    true, parted = pass_rows(passes), pass_rows(replace(passes, log=set_right(passes.log, off_m)))
    assert np.max(np.abs(parted.step_m - true.step_m)) < 0.03
    assert np.max(np.abs(parted.show_m_s - true.show_m_s)) < 0.005


@pytest.mark.parametrize("off_m", [0.2, -0.2])
def test_the_numbers_are_those_without(passes: FittingPasses, yard: Yard, off_m: float) -> None:
    """By one step from the true numbers each: it moves by less than its standard error."""
    unknowns = unknowns_of(passes, yard.config.parameters)
    truth = TRUTHS[0].values(tuple(unknown.key for unknown in unknowns))
    u = np.array([unknown.standing(truth[unknown.key]) for unknown in unknowns])
    steps = []
    for each in (passes, replace(passes, log=set_right(passes.log, off_m))):
        there = posterior(each, unknowns, 2).linearised(u)
        covariance = np.linalg.inv(np.eye(len(u)) + there.information)
        steps.append(covariance @ (there.scores.sum(axis=0) - u) / np.sqrt(np.diag(covariance)))
    assert np.max(np.abs(steps[1] - steps[0])) < 1.0


def test_it_is_told_with_the_number(passes: FittingPasses) -> None:
    values = TRUTHS[0].values(())
    assert list(log_sentences(passes, values)) == []
    (told,) = log_sentences(replace(passes, log=set_right(passes.log, 0.2)), values)
    met = sum(bool((passes.log.path_m[passes.log.rows(i)] > TREADLE_M).any()) for i in range(len(passes)))
    assert told.startswith(f"The path was set anew {met} times, in {met} of 80 passes, by 0.2")
