"""A path that treadles set right within the passes: the numbers stay what they are without."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from scripts.studies.identification.truths import TRUTHS, Yard
from synth.logs.estimate import posterior
from synth.logs.fitting_passes import FittingPasses
from synth.logs.identify_shown import log_sentences
from synth.logs.pass_rows import pass_rows
from synth.logs.unknowns import unknowns_of
from tuning_tables.pass_log.pass_log import PassLog

TREADLE_M = 12.0


def set_right(log: PassLog, off_m: float) -> PassLog:
    """Its path is `off_m` too far until the treadle, and right behind it."""
    return replace(log, path_m=np.where(log.path_m < TREADLE_M, log.path_m + off_m, log.path_m))


def log_start(log: PassLog) -> float:
    """Ahead of all passes."""
    return float(log.path_m.min())


@pytest.mark.parametrize("off_m", [0.2, -0.2])
def test_steps_are_those_of_the_cut(passes: FittingPasses, off_m: float) -> None:
    true, parted = pass_rows(passes), pass_rows(replace(passes, log=set_right(passes.log, off_m)))
    assert np.max(np.abs(parted.step_m - true.step_m)) < 0.03
    met = set_right(passes.log, off_m).path_m != passes.log.path_m
    alone = np.add.reduceat(met, passes.log.first_row[:-1]) == np.diff(passes.log.first_row)
    assert (np.isfinite(parted.show_m_s) == alone).all()


def test_a_path_that_counts_too_much_says_nothing_wrong_of_the_sensor(passes: FittingPasses) -> None:
    """2 % too much from each treadle to the next; between the first and the last the path is known."""
    treadles_m = (0.0, 8.0, 16.0, 24.0)
    log, last = passes.log, np.full(len(passes.log.path_m), log_start(passes.log))
    for at in treadles_m:
        last = np.where(log.path_m >= at, at, last)
    counted = last + 1.02 * (log.path_m - last)
    true, parted = pass_rows(passes), pass_rows(replace(passes, log=replace(log, path_m=counted)))
    both = np.isfinite(parted.show_m_s)
    assert both.mean() > 0.9
    assert abs(np.mean((parted.show_m_s - true.show_m_s)[both])) < 0.005
    known = (log.path_m > 8.5) & (log.path_m < 15.0)
    assert np.max(np.abs(parted.step_m - true.step_m)[known]) < 0.002


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
