"""Bisection keeps as few tables as the loss allows: against a closed form, and on the solver's own tables."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from synth.frame.workers.engine import InThisProcess
from synth.retarder.sweep.plan import Refinement, plan_of
from synth.retarder.sweep.refinement import Bench, Gap, refined
from synth.retarder.sweep.sweep_file import parse_sweep
from synth.retarder.sweep.tune_unit import between_rms_m_s, setup_of, tune_unit, tuned_tables
from synth.retarder.sweep.unit_answer import answer
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.random_passes import random_passes
from tests.sweep.conftest import MEASURED, PLANT, SWEEP, run
from tuning_tables import TableBook, read_book

OWN = 0.03


def parabola(curvature: float) -> Bench[float]:
    """Tables are their targets; lines between are off by curvature (T − T0)(T1 − T)/2, added to an rms in squares."""

    def between(slower: float, faster: float, target: float) -> float:
        return math.hypot(OWN, 0.5 * curvature * (target - slower) * (faster - target))

    return Bench(tune=lambda targets: list(targets), own_rms_m_s=lambda table: OWN, between_rms_m_s=between)


def closed_form_loss(step: float, curvature: float) -> float:
    return math.hypot(OWN, curvature * step**2 / 8.0) - OWN


@pytest.mark.parametrize("loss", [0.0005, 0.002, 0.01])
def test_the_step_is_that_of_the_closed_form(loss: float) -> None:
    curvature = 0.3
    kept, gaps = refined((1.0, 5.0), parabola(curvature), Refinement(loss, 0.01))
    step = 4.0
    while closed_form_loss(step, curvature) > loss:
        step /= 2.0
    assert np.diff(kept) == pytest.approx(step)
    left = [gap for gap in gaps if not gap.refined]
    assert len(left) == len(kept) - 1
    assert max(gap.loss_m_s for gap in left) == pytest.approx(closed_form_loss(step, curvature))
    # No book with even steps on these bisections has fewer tables and keeps the loss.
    assert closed_form_loss(2.0 * step, curvature) > loss


def test_the_smallest_step_ends_it_and_the_loss_left_is_told() -> None:
    kept, gaps = refined((1.0, 2.0), parabola(10.0), Refinement(1e-4, 0.25))
    assert kept == [1.0, 1.25, 1.5, 1.75, 2.0]
    left = [gap for gap in gaps if not gap.refined]
    assert [(gap.low_m_s, gap.high_m_s) for gap in left] == [(1.0, 1.25), (1.25, 1.5), (1.5, 1.75), (1.75, 2.0)]
    assert all(gap.loss_m_s > 1e-4 for gap in left)


def test_only_where_it_is_needed() -> None:
    def between(slower: float, faster: float, target: float) -> float:
        return OWN + (0.01 if slower < 2.0 and faster - slower > 0.3 else 0.0)

    asked: list[float] = []

    def tune(targets: Sequence[float]) -> list[float]:
        asked.extend(targets)
        return list(targets)

    kept, _ = refined((3.0, 1.0, 2.0), Bench(tune, lambda table: OWN, between), Refinement(0.001, 0.1))
    assert kept == [1.0, 1.25, 1.5, 1.75, 2.0, 3.0]
    assert len(asked) == len(set(asked))


def test_lines_between_are_those_that_a_controller_takes() -> None:
    text = (
        PLANT + MEASURED + SWEEP.replace("to = 30", "to = 22").replace("to = 2.0, step = 0.5", "to = 2.5, step = 1.0")
    )
    text = text.replace(
        "path_step_m = 1.0\nspeed_step_m_s = 0.05\nfriction_scenarios = 3\nresistance_scenarios = 1\n", ""
    )  # the default grid instead: a coarse one predicts too much
    config, setup = setup_of(plan_of(parse_sweep(text, "x"), "2020-01-01T00:00:00Z").units[0].order)
    (slower, faster), _ = tuned_tables(config, setup, (1.5, 2.5))
    # At the targets themselves the lines between are the tables' own: rounding is all that may differ.
    for table in (slower, faster):
        target = table.target_speed_m_s
        assert between_rms_m_s(setup.check, slower, faster, target) == pytest.approx(table.predicted.rms_m_s, rel=1e-5)
    # Half-way, the choice of the book is simulated: another way to the lines and another way to the error.
    choice = TableBook((slower, faster)).choose(slower.cut.category, 4, 2.0)
    assert choice.table is not None
    n = 20_000
    loop = close_loop(setup.plant, choice.table.coefficients.shape[0])
    sample = loop.run(TableController(choice.table), loop.draws(random_passes(7, 0, n)))
    square = (sample.exit_speed_m_s - 2.0) ** 2
    half = 1.96 * square.std() / math.sqrt(n)
    exact = between_rms_m_s(setup.check, slower, faster, 2.0)
    assert exact == pytest.approx(math.sqrt(square.mean()), rel=0.1 + half / square.mean())


@pytest.mark.long
def test_a_refined_book_keeps_its_loss(tmp_path: Path) -> None:
    config = tmp_path / "refined.toml"
    coarse = SWEEP.replace("{ from = 1.5, to = 2.0, step = 0.5 }", "[1.0, 3.0]").replace("to = 30", "to = 22")
    loss = 0.002
    wanted = f"interpolation_loss_m_s = {loss}\nsmallest_step_m_s = 0.05\npasses"
    config.write_text(PLANT + MEASURED + coarse.replace("passes", wanted), encoding="utf-8")
    assert run(config, tmp_path / "out", InThisProcess(answer)) == 0
    targets = [table.target_speed_m_s for table in read_book(tmp_path / "out" / "book.h5")]
    assert len(targets) > 2
    assert targets == sorted(targets)
    gaps = tune_unit(plan_of(parse_sweep(config.read_text(), "x"), "2020-01-01T00:00:00Z").units[0].order).gaps
    left = sorted((gap for gap in gaps if not gap.refined), key=lambda gap: gap.low_m_s)
    assert [gap.low_m_s for gap in left] + [left[-1].high_m_s] == targets
    assert max(gap.loss_m_s for gap in left) <= loss
    for gap in gaps:
        assert gap.refined == (gap.loss_m_s > loss)
    tables = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))["tables"]
    (told,) = tables["conditions"]
    assert [gap["loss_m_s"] for gap in tables["interpolation"]] == [gap.loss_m_s for gap in gaps]
    assert told["highest_interpolation_loss_m_s"] == max(gap.loss_m_s for gap in left)
    assert isinstance(gaps[0], Gap)
