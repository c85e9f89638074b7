"""Baselines: the energy rule's lines lead to the target, and tuning finds members worth comparing with."""

from __future__ import annotations

import numpy as np
import pytest

from plant_models import Plant
from synth.kernels.loop.motion import LEFT, advance
from synth.retarder.comparison.baselines import (
    FAMILIES,
    TunedBaseline,
    energy_rule,
    relay,
    tune_baselines,
)
from synth.simulation.closed_loop import close_loop, simulate
from synth.simulation.common_passes import common_passes
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.random_passes import RandomPasses, random_passes

TARGET_M_S = 3.0


@pytest.fixture(scope="module")
def passes() -> RandomPasses:
    return random_passes(seed=5, first_pass=0, count=400)


@pytest.fixture(scope="module")
def tuned(plant_52t: Plant, passes: RandomPasses) -> dict[str, TunedBaseline]:
    return {baseline.name: baseline for baseline in tune_baselines(common_passes(plant_52t, passes), TARGET_M_S)}


@pytest.mark.parametrize("stage", [0, 1, 2, 3])
def test_a_cut_on_the_energy_line_leaves_with_the_target(plant_52t: Plant, stage: int) -> None:
    loop = close_loop(plant_52t, 5)
    friction = 0.9
    lines = energy_rule(loop, TARGET_M_S, 4, friction, 0.1, 0.0, 0.2).lines
    path = loop.path
    free = path.gravity_m_s2 - path.drag_m_s2_per_n_kn * plant_52t.resistance.mean_n_per_kn
    brake = friction * path.brake_m_s2_per_kpa
    kpa = loop.stage_overpressures_kpa[stage]
    entry = lines.upper_m_s[stage, 0]
    *_, speed, _, status = advance(path.edges_m, free, brake, kpa, 1e3, 0, 0.0, entry)
    assert status == LEFT
    assert speed == pytest.approx(TARGET_M_S + 0.1, abs=1e-9)
    assert lines.lower_m_s[stage + 1] == pytest.approx(lines.upper_m_s[stage] - 0.2)


def test_thresholds_jump_to_their_stage_and_back(plant_52t: Plant) -> None:
    loop = close_loop(plant_52t, 5)
    lines = relay(loop, TARGET_M_S, 3, 0.1, 0.2).lines
    assert np.all(lines.upper_m_s[:3] == pytest.approx(3.3))
    assert np.all(np.isposinf(lines.upper_m_s[3:]))
    assert np.all(lines.lower_m_s[1:] == pytest.approx(3.1))
    assert np.all(np.isneginf(lines.lower_m_s[0]))


def test_tuning_is_deterministic_and_reports_what_it_reached(
    plant_52t: Plant, passes: RandomPasses, tuned: dict[str, TunedBaseline]
) -> None:
    assert list(tuned) == [family.name for family in FAMILIES]
    again = {baseline.name: baseline for baseline in tune_baselines(common_passes(plant_52t, passes), TARGET_M_S)}
    for name, baseline in tuned.items():
        figures = exit_statistics(simulate(plant_52t, baseline.controller, passes), TARGET_M_S)
        assert figures.rms_m_s == pytest.approx(
            baseline.rms_m_s, rel=1e-12
        )  # sums of other lengths end in other last bits
        assert again[name].parameters == baseline.parameters


def test_richer_laws_are_no_worse_and_all_are_sensible(tuned: dict[str, TunedBaseline]) -> None:
    assert tuned["relay"].rms_m_s < 0.2
    assert tuned["energy rule"].rms_m_s < 0.7 * tuned["relay"].rms_m_s


def test_tuned_baseline_holds_on_fresh_passes(plant_52t: Plant, tuned: dict[str, TunedBaseline]) -> None:
    fresh = random_passes(seed=6, first_pass=0, count=4000)
    for baseline in tuned.values():
        figures = exit_statistics(simulate(plant_52t, baseline.controller, fresh), TARGET_M_S)
        assert figures.rms_m_s < 1.4 * baseline.rms_m_s
