"""Closed forms of motion at a held stage against the forward density: coasting, constant braking, path noise."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from plant_models import EntrySpeed, Friction, Plant, PressingForce, RollingResistance, TrackProfile
from synth.problem.resolution import Resolution
from synth.solver.chain.chain import Chain, check_chain, persistent_chain
from synth.solver.evaluation import exit_density
from synth.solver.exit_density import ExitDensity
from synth.solver.switching_lines import SwitchingLines

NEVER = math.inf

ONE_SCENARIO = Resolution(
    path_step_m=0.25, speed_step_m_s=0.02, transient_substeps=2, friction_nodes=1, path_levels=1, resistance_nodes=1
)


def without_commands(t: Chain) -> ExitDensity:
    """Exit density when no line is ever crossed: the stage of the entrance is held."""
    shape = (t.actuator.stages, len(t.grid.path_m))
    lines = SwitchingLines(t.grid.path_m.copy(), np.full(shape, -NEVER), np.full(shape, NEVER))
    return exit_density(t, lines)


def moments(density: ExitDensity) -> tuple[float, float]:
    """Mean and variance of the exit energy v²/2, m²/s²."""
    energy = 0.5 * density.speed_m_s**2
    mean = float((density.probability * energy).sum())
    return mean, float((density.probability * (energy - mean) ** 2).sum())


def entry_energy(entry: EntrySpeed) -> tuple[float, float]:
    """Mean and variance of v²/2 for v uniform in [a, b]: E v² = (a² + ab + b²)/3, E v⁴ = (b⁵ − a⁵)/(5 (b − a))."""
    a, b = entry.low_m_s, entry.high_m_s
    mean = (a * a + a * b + b * b) / 6.0
    square = a**4 / 4.0 if a == b else (b**5 - a**5) / (20.0 * (b - a))
    return mean, square - mean**2


def coasting_gain(plant: Plant) -> float:
    """g'·1e-3·(mean over axles of ∫ i ds − w·S_exit): what gravity adds to v²/2 over the whole pass."""
    bounds = [*plant.profile.starts_m, math.inf]

    def climb(a: float, b: float) -> float:
        total = plant.profile.grades_permille[0] * max(0.0, min(b, bounds[0]) - a)
        for grade, low, high in zip(plant.profile.grades_permille, bounds, bounds[1:], strict=False):
            total += grade * max(0.0, min(b, high) - max(a, low))
        return total

    length = plant.exit_m
    drops = [climb(-x, length - x) for x in plant.cut.axle_offsets_m]
    lost = plant.resistance.mean_n_per_kn * length
    return plant.cut.reduced_gravity_m_s2 * 1e-3 * (sum(drops) / len(drops) - lost)


def coasting(plant_with: Callable[..., Plant], **changes: object) -> Plant:
    """A bad runner (w = 6 N/kN) on 11.5 m: it ends well below the top of the grid, which knows no resistance."""
    return plant_with(zones_m=((0.0, 10.0),), **{"resistance": RollingResistance(6.0, 0.0), **changes})


@pytest.mark.parametrize("entry", [EntrySpeed(4.0, 4.0), EntrySpeed(3.5, 4.5)])
@pytest.mark.parametrize("profile", [TrackProfile.uniform(8.0), TrackProfile((0.0, 2.2), (12.0, 3.0))])
def test_coasting_adds_the_energy_of_the_grade(
    plant_with: Callable[..., Plant], entry: EntrySpeed, profile: TrackProfile
) -> None:
    """v² grows by 2 g'(i − w)·S: shifts keep the mean energy exactly, its variance to one cell."""
    plant = coasting(plant_with, entry=entry, profile=profile)
    t = persistent_chain(plant, ONE_SCENARIO)
    density = without_commands(t)
    mean, variance = moments(density)
    mean_0, variance_0 = entry_energy(entry)
    assert mean == pytest.approx(mean_0 + coasting_gain(plant), abs=2e-7)  # 2000-point rule of the entry speed
    # The entry splits every speed over two cells (at most Δe²/4); cubic shifts then add nothing to the variance.
    assert -1e-6 < variance - variance_0 < 0.3 * t.grid.energy_step_m2_s2**2
    assert density.probability.sum() == pytest.approx(1.0, abs=1e-9)
    assert density.stalled == pytest.approx(0.0, abs=1e-12)
    assert density.escaped < 1e-6  # ripples of the cubic far from the mass
    assert density.switchings == 0.0


def test_coasting_exit_speed(plant_with: Callable[..., Plant]) -> None:
    """One entry speed: all mass leaves close to v = sqrt(v0² + 2·gain)."""
    plant = coasting(plant_with, entry=EntrySpeed(4.0, 4.0))
    density = without_commands(persistent_chain(plant, ONE_SCENARIO))
    v = math.sqrt(4.0**2 + 2.0 * coasting_gain(plant))
    assert density.rms_m_s(v) < 0.01  # half a speed cell
    assert density.bias_m_s(v) == pytest.approx(0.0, abs=1e-4)  # curvature of sqrt over one cell


def constantly_braked(plant_with: Callable[..., Plant], **changes: object) -> Plant:
    """A plant whose lowest stage brakes: it rests at P_0 + ε = 115 kPa, 65 kPa over the touch pressure."""
    return plant_with(stages_kpa=(100.0, 300.0), **{"entry": EntrySpeed(4.5, 4.5), **changes})


def brake_work(plant: Plant) -> float:
    """∫ Σ K c(N) p ds/(Q + 0.42 n) over the pass, axles 1.5 m apart in one zone of 4 m: N = 1, 2, 1."""
    force = plant.position.force
    assert isinstance(force, PressingForce)
    k, (c1, c2) = force.slope_kn_per_kpa_per_pair, force.slope_factor_by_axles
    return k * 65.0 * (1.5 * c1 + 2.5 * 2.0 * c2 + 1.5 * c1) / (20.0 + 0.42 * 2)


@pytest.mark.parametrize("path_step_m", [0.5, 0.34])  # 5.5 m: with and without nodes at the axle breaks
def test_constant_braking_takes_the_brake_work(plant_with: Callable[..., Plant], path_step_m: float) -> None:
    """The energy falls by exactly ξ·∫β p ds however the quanta fall on the steps of N(s)."""
    plant = constantly_braked(plant_with)
    resolution = Resolution(
        path_step_m, 0.02, transient_substeps=2, friction_nodes=1, path_levels=1, resistance_nodes=1
    )
    mean, variance = moments(without_commands(persistent_chain(plant, resolution)))
    assert mean == pytest.approx(4.5**2 / 2 + coasting_gain(plant) - brake_work(plant), abs=1e-9)
    assert variance < 0.3 * 0.06**2


def test_persistent_friction_spreads_the_exit_by_its_own_variance(plant_with: Callable[..., Plant]) -> None:
    """Var e = (CV·work)² with CV² = σ_c² + σ_a²/N̄, N̄ = (1.5·1 + 2.5·2 + 1.5·1)/5.5; Gauss–Hermite is exact."""
    plant = constantly_braked(plant_with, friction=Friction(0.10, 0.08, 0.0, 2.0))
    resolution = Resolution(0.5, 0.02, transient_substeps=2, friction_nodes=5, path_levels=1, resistance_nodes=1)
    mean, variance = moments(without_commands(persistent_chain(plant, resolution)))
    work = brake_work(plant)
    cv_square = 0.10**2 + 0.08**2 / (8.0 / 5.5)
    assert mean == pytest.approx(4.5**2 / 2 + coasting_gain(plant) - work, abs=1e-9)
    assert variance == pytest.approx(cv_square * work**2, abs=0.3 * 0.06**2)


def test_unknown_resistance_spreads_the_exit_by_its_own_variance(plant_with: Callable[..., Plant]) -> None:
    """Var e = (g'·1e-3·S·σ_w)² exactly for the Gauss quadrature of the gamma law (3 nodes: degree 5)."""
    plant = coasting(plant_with, resistance=RollingResistance(6.0, 0.6), entry=EntrySpeed(4.0, 4.0))
    resolution = Resolution(0.5, 0.002, transient_substeps=1, friction_nodes=1, path_levels=1, resistance_nodes=3)
    mean, variance = moments(without_commands(persistent_chain(plant, resolution)))
    assert mean == pytest.approx(8.0 + coasting_gain(plant), abs=1e-9)
    expected = (plant.cut.reduced_gravity_m_s2 * 1e-3 * plant.exit_m * 0.6) ** 2
    assert variance == pytest.approx(expected, abs=0.3 * 0.006**2)


def test_scenarios_of_the_check_have_the_same_moments(plant_with: Callable[..., Plant]) -> None:
    """ξ_cut and w as sums of main effects: both variances add. 0.5 %: the normal law is cut at four deviations."""
    plant = constantly_braked(
        plant_with, friction=Friction(0.12, 0.0, 0.0, 2.0), resistance=RollingResistance(1.5, 0.6)
    )  # fmt: skip
    resolution = Resolution(0.5, 0.005, transient_substeps=1, friction_nodes=17, path_levels=1, resistance_nodes=3)
    mean, variance = moments(without_commands(check_chain(plant, resolution)))
    work, drag = brake_work(plant), plant.cut.reduced_gravity_m_s2 * 1e-3 * plant.exit_m
    assert mean == pytest.approx(4.5**2 / 2 + coasting_gain(plant) - work, abs=1e-6)
    assert variance == pytest.approx((0.12 * work) ** 2 + (0.6 * drag) ** 2, rel=0.005)


@pytest.mark.parametrize("levels", [2, 5])
@pytest.mark.parametrize("path_step_m", [0.25, 0.5, 1.0])
def test_path_noise_has_the_variance_of_the_continuous_process(
    plant_with: Callable[..., Plant], path_step_m: float, levels: int
) -> None:
    """Var ∫η β p ds = 2σ²ℓ²(L/ℓ − 1 + e^(−L/ℓ))·(βp)² for one axle in a zone of L = 8 m, ℓ = 1 m, any ΔS.

    Tolerance 3 %: the chain's variance over a finite path differs from the process by the end cells; the
    energy grid adds less than Δe²/4. Unscaled noise would be out by tanh(ΔS/2ℓ)/(ΔS/2ℓ), 8 % at 1 m.
    """
    plant = constantly_braked(
        plant_with, axles_m=(0.0,), zones_m=((0.0, 8.0),), mass_t=8.0, friction=Friction(0.0, 0.0, 0.2, 1.0)
    )
    resolution = Resolution(
        path_step_m, 0.02, transient_substeps=2, friction_nodes=1, path_levels=levels, resistance_nodes=1
    )
    _, variance = moments(without_commands(persistent_chain(plant, resolution)))
    braking = 0.05 * 65.0 / (8.0 + 0.42)
    expected = 2.0 * 0.2**2 * (8.0 - 1.0 + math.exp(-8.0)) * braking**2
    assert variance == pytest.approx(expected, rel=0.03)
