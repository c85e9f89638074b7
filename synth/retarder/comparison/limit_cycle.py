"""Predicted limit cycles of the speed loop between two neighbouring stages.

It is a relay with delays around an integrator. Its cycle is predicted exactly, as between switchings there are only
exponentials and straight lines, and by its first harmonic (describing function), as a control engineer would. The speed
is nearly a triangle: with equal slopes the harmonic is up to a fifth smaller and its period up to a fourth longer, with
slopes 1 : 2.5 we saw −40 % and −22 %. The exact prediction is right.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from plant_models import Plant, path_coefficients
from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.stage_regulator import stage_locked_actuator
from synth.solver.switching_lines import SwitchingLines

SUBSTEPS = 20
"""Parts of a sampling period in which the extreme speed of a transient is looked for."""

ORBIT_CYCLES = 200
"""Cycles of the sampled orbit that count; as many go before."""


class StagePair(NamedTuple):
    """Two neighbouring stages, at rest and while one changes into the other: overpressure max(0, P − P0).

    `braking_kpa`, `releasing_kpa`: means over `SUBSTEPS` parts of each sampling period, from the sample that
    decides to the first sample that may decide again.
    """

    lower_stage: int
    low_kpa: float
    high_kpa: float
    braking_kpa: Floats
    releasing_kpa: Floats
    sample_period_s: float


class Change(NamedTuple):
    """A change of stage as the speed sees it, relative to the lines.

    `duration_s`: until the next decision may fall; `speed_m_s`: speed gained meanwhile; `overshoot_m_s` ≥ 0:
    how far the speed still runs on; `dead_time_s`: delay of the sudden change that gains the same.
    """

    duration_s: float
    speed_m_s: float
    overshoot_m_s: float
    dead_time_s: float


@dataclass(frozen=True)
class LimitCycle:
    """The cut hunting between `lower_stage` and the stage above it around a pair of lines.

    Speeds are relative to the middle of the lines, which are `gap_m_s` apart (raise above the upper, lower
    below the lower one). `rise_m_s2`, `fall_m_s2` > 0: relative acceleration in the lower, deceleration in the
    upper stage; `brake_delay_s`, `release_delay_s`: from crossing a line to the sudden change of equal effect,
    mean wait for a sample included. `top_m_s`, `bottom_m_s`, `period_s`: closed form; `sampled_…`: the sampled
    loop stepped exactly (half of the largest swing, mean period); `harmonic_…`: NaN for a negative gap.
    """

    lower_stage: int
    gap_m_s: float
    rise_m_s2: float
    fall_m_s2: float
    brake_delay_s: float
    release_delay_s: float
    top_m_s: float
    bottom_m_s: float
    period_s: float
    sampled_amplitude_m_s: float
    sampled_period_s: float
    harmonic_amplitude_m_s: float
    harmonic_period_s: float

    @property
    def amplitude_m_s(self) -> float:
        """Half the swing of the closed form."""
        return 0.5 * (self.top_m_s - self.bottom_m_s)


@dataclass(frozen=True)
class Hunting:
    """Where a plant can hunt under given lines: `periods` of `cycle` fit between `from_m` and `to_m`."""

    from_m: float
    to_m: float
    periods: float
    cycle: LimitCycle


def hunting_report(plant: Plant, lines: SwitchingLines) -> tuple[Hunting, ...]:
    """For each pair of stages the stretches of path on which it can hunt for one period or more.

    A stretch is a longest run of path cells of `lines` in which both lines exist, the lower stage gains on
    them and the upper one falls behind; its cycle is that of the means over the stretch. Where the number
    of braked axles interrupts the run, hunting across the interruption is not seen.
    """
    nodes = lines.nodes_m
    acceleration, brake = accelerations(plant, nodes)
    found: list[Hunting] = []
    for stage in range(min(lines.stages - 1, plant.top_stage)):
        upper, lower = lines.upper_m_s[stage], lines.lower_m_s[stage + 1]
        exist = np.isfinite(upper) & np.isfinite(lower)
        gap, middle = np.zeros(nodes.size), np.zeros(nodes.size)
        gap[exist], middle[exist] = upper[exist] - lower[exist], 0.5 * (upper[exist] + lower[exist])
        speed = 0.5 * (middle[1:] + middle[:-1])
        free = acceleration - np.diff(middle) / np.diff(nodes) * speed
        pair = stage_pair(plant, stage)
        hunts = (free > brake * pair.low_kpa) & (free < brake * pair.high_kpa)
        hunts &= exist[1:] & exist[:-1] & (speed > 0.0)
        for first, last in np.flatnonzero(np.diff(hunts, prepend=False, append=False)).reshape(-1, 2).tolist():
            cells, mean_gap = slice(first, last), float(gap[first : last + 1].mean())
            cycle = relay_cycle(pair, mean_gap, float(free[cells].mean()), float(brake[cells].mean()))
            time = float((np.diff(nodes)[cells] / speed[cells]).sum())
            if cycle is not None and time >= cycle.period_s:
                found.append(Hunting(float(nodes[first]), float(nodes[last]), time / cycle.period_s, cycle))
    return tuple(found)


def accelerations(plant: Plant, edges_m: Floats) -> tuple[Floats, Floats]:
    """Means over the path cells: acceleration without brake (m/s²), deceleration by one kPa (m/s² per kPa)."""
    path = path_coefficients(plant.position, plant.cut, plant.profile, edges_m)
    return path.free_m_s2(plant.resistance.mean_n_per_kn), path.brake_m_s2_per_kpa


def stage_pair(plant: Plant, lower_stage: int) -> StagePair:
    """`lower_stage` and the next above it as they rest and change when they alternate."""
    if not 0 <= lower_stage < plant.top_stage:
        raise ValueError(f"limit cycle: lower stage {lower_stage}; this cut may use stages 0 to {plant.top_stage}")
    actuator = stage_locked_actuator(plant.position, plant.sensor, plant.top_stage, SUBSTEPS)
    upper_mode = int(np.flatnonzero(actuator.mode_stage == lower_stage + 1)[0])
    lower_mode = int(actuator.chain_mode[actuator.command[upper_mode, lower_stage]])
    braking = actuator.command[lower_mode, lower_stage + 1]
    upper_mode = int(actuator.chain_mode[braking])
    releasing = actuator.command[upper_mode, lower_stage]
    rests, profiles, samples = actuator.mode_overpressure_kpa, actuator.chain_overpressure_kpa, actuator.chain_samples
    changes = [profiles[chain, : samples[chain] * SUBSTEPS] for chain in (braking, releasing)]
    low, high = float(rests[lower_mode]), float(rests[upper_mode])
    return StagePair(lower_stage, low, high, changes[0], changes[1], plant.sensor.sample_period_s)


def change(pair: StagePair, braking: bool, free: float, brake: float) -> Change:
    """What a change of stage does to the speed where the acceleration is `free` − `brake`·overpressure."""
    profile, after = (pair.braking_kpa, pair.high_kpa) if braking else (pair.releasing_kpa, pair.low_kpa)
    part_s = pair.sample_period_s / SUBSTEPS
    gained = np.append(0.0, np.cumsum(free - brake * profile) * part_s)
    overshoot = float(gained.max() if braking else -gained.min())
    dead_time = float(np.abs(after - profile).sum()) * part_s / (pair.high_kpa - pair.low_kpa)
    return Change(profile.size * part_s, float(gained[-1]), overshoot, dead_time)


def relay_cycle(pair: StagePair, gap_m_s: float, free: float, brake: float) -> LimitCycle | None:
    """Hunting of `pair` where the acceleration relative to the lines is `free` − `brake`·overpressure, m/s².

    Closed form: straight lines between the decisions of `turning_speeds`, and the transients that these begin.
    """
    rise, fall = free - brake * pair.low_kpa, brake * pair.high_kpa - free
    if rise <= 0.0 or fall <= 0.0:
        return None
    up, down = change(pair, True, free, brake), change(pair, False, free, brake)
    wait = 0.5 * pair.sample_period_s
    raised, lowered = turning_speeds(gap_m_s, rise * wait, fall * wait, up, down)
    delays = up.dead_time_s + wait, down.dead_time_s + wait
    top, bottom = raised + up.overshoot_m_s - 0.5 * gap_m_s, lowered - down.overshoot_m_s - 0.5 * gap_m_s
    period = up.duration_s + (raised + up.speed_m_s - lowered) / fall
    period += down.duration_s + (raised - lowered - down.speed_m_s) / rise
    sampled = sampled_orbit(gap_m_s, rise, fall, up, down, pair.sample_period_s)
    harmonic = first_harmonic(gap_m_s, rise, fall, *delays)
    return LimitCycle(pair.lower_stage, gap_m_s, rise, fall, *delays, top, bottom, period, *sampled, *harmonic)


def turning_speeds(gap: float, risen: float, fallen: float, up: Change, down: Change) -> tuple[float, float]:
    """Speeds above the lower line at which the raise and the lowering are decided.

    `risen`, `fallen`: what the speed gains and loses in half a sampling period, the mean wait for a sample. A decision
    comes later where the lock of the change before ends later.
    """
    raised, lowered = gap + risen, -fallen
    if up.speed_m_s + down.speed_m_s <= 0.0:  # then only the lock after braking can end too late
        return raised, min(lowered, raised + up.speed_m_s)
    return max(raised, lowered + down.speed_m_s), lowered


def sampled_orbit(gap: float, rise: float, fall: float, up: Change, down: Change, wait_s: float) -> tuple[float, float]:
    """(half of the largest swing m/s, mean period s), stepped exactly from one phase of samples `wait_s` apart."""
    speed, time, tops, bottoms = gap, 0.0, [0.0], [0.0]
    for cycle in range(2 * ORBIT_CYCLES):
        if cycle == ORBIT_CYCLES:
            time, tops, bottoms = 0.0, [], []
        # Samples at rest in the lower stage until one is above the upper line, then until one is below the lower.
        waited = math.floor((gap - speed) / (rise * wait_s)) + 1 if speed <= gap else 0
        speed += waited * rise * wait_s
        tops.append(speed + up.overshoot_m_s)
        speed += up.speed_m_s
        held = math.floor(speed / (fall * wait_s)) + 1 if speed >= 0.0 else 0
        speed -= held * fall * wait_s
        bottoms.append(speed - down.overshoot_m_s)
        speed += down.speed_m_s
        time += up.duration_s + down.duration_s + (waited + held) * wait_s
    return 0.5 * (max(tops) - min(bottoms)), time / ORBIT_CYCLES


def first_harmonic(gap: float, rise: float, fall: float, brake_s: float, release_s: float) -> tuple[float, float]:
    """(amplitude m/s, period s) by harmonic balance; NaN for a negative gap.

    With b = (rise + fall)/2 and the share D = fall/(rise + fall) of time spent in the lower stage (no mean
    acceleration) the harmonic of the speed is A = 4b·sin(πD)/(πω), and the two switchings, τ_b and τ_r late,
    are `gap` apart: A·(sin(πD − ωτ_b) + sin(πD + ωτ_r)) = gap. For D = ½ and equal delays it is the
    describing function of the relay with hysteresis and dead time.
    """
    from scipy.optimize import brentq  # start-up: scipy only where it is needed

    if gap < 0.0:
        return math.nan, math.nan
    share = math.pi * fall / (rise + fall)
    reach = 2.0 * (rise + fall) * math.sin(share) / math.pi  # A·ω

    def excess(omega: float) -> float:
        return reach * (math.sin(share - omega * brake_s) + math.sin(share + omega * release_s)) - gap * omega

    # The sum of sines is a product of sine and cosine: beyond the first zero of either no gap is left.
    fastest = math.pi / (brake_s + release_s)
    if release_s != brake_s:
        room = math.pi - share if release_s > brake_s else share
        fastest = min(fastest, 2.0 * room / abs(release_s - brake_s))
    omega = fastest if gap == 0.0 else float(brentq(excess, 0.0, fastest))
    return reach / omega, 2.0 * math.pi / omega


@frozen_arrays
class CycleWave:
    """Speeds `speed_m_s` (n,) relative to the middle of the lines at `time_s` (n,), from one raise to the next.

    Between the points the speed is linear, but for the transients, of which `SUBSTEPS` points a sampling period are
    given.
    """

    time_s: Floats
    speed_m_s: Floats


def cycle_wave(plant: Plant, cycle: LimitCycle) -> CycleWave:
    """The closed form of `cycle`, a limit cycle of `plant`, point by point."""
    pair = stage_pair(plant, cycle.lower_stage)
    part_s, wait_s = pair.sample_period_s / SUBSTEPS, 0.5 * pair.sample_period_s
    brake = (cycle.rise_m_s2 + cycle.fall_m_s2) / (pair.high_kpa - pair.low_kpa)
    free = cycle.rise_m_s2 + brake * pair.low_kpa
    up, down = change(pair, True, free, brake), change(pair, False, free, brake)
    slopes = cycle.rise_m_s2 * wait_s, cycle.fall_m_s2 * wait_s
    raised, lowered = turning_speeds(cycle.gap_m_s, *slopes, up, down)
    times, speeds = [np.zeros(1)], [np.array([raised])]
    for profile_kpa, after, until, rate in (
        (pair.braking_kpa, up, lowered, -cycle.fall_m_s2),
        (pair.releasing_kpa, down, raised, cycle.rise_m_s2),
    ):
        begun, start = times[-1][-1], speeds[-1][-1]
        times.append(begun + part_s * np.arange(1, profile_kpa.size + 1))
        speeds.append(start + np.cumsum((free - brake * profile_kpa) * part_s))
        times.append(np.array([begun + after.duration_s + (until - start - after.speed_m_s) / rate]))
        speeds.append(np.array([until]))
    return CycleWave(np.concatenate(times), np.concatenate(speeds) - 0.5 * cycle.gap_m_s)
