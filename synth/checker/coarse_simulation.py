"""Passes of a cut under a table, in plain Python and coarse steps of time.

Everything moves on in steps of a quarter of the sampling period: position and speed by the acceleration at the middle
of the step, pressure by the valves as they stand. The regulator of the pressure is played as the relay that it is,
with its delays, and not from histories known in advance; friction is a random walk over short stretches of path; the
lines are evaluated in double precision; an estimator of the table runs in float32 and hears at every sample the mean
overpressure since the last. A table that decides at any time is asked at every sample, its gauge shows the true
pressure, and the relay takes a command whatever it is doing. With an approach a pass begins there, with the speed from
which the cut, not braked, reaches the entrance with its entry speed. All this differs from the simulator that made the
claims.

Cuts of low friction are rare and make most of a mean square. So half of the passes have the friction of cuts as it
comes, the others low friction (`low_friction`), and each pass counts by its weight.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import repeat
from random import Random
from typing import Final

from synth.checker.brake_drive import BrakeDrive
from synth.checker.drawn_cuts import friction_numbers
from synth.checker.estimator import Observer
from synth.checker.plant import GRAVITY_M_S2, Plant
from synth.checker.table_reading import Line, Table

STEPS_A_PERIOD: Final = 4
LONGEST_STEP_S: Final = 0.025
CELL_M: Final = 0.05
MOST_CELLS: Final = 2000
NOISE_CELLS_A_LENGTH: Final = 8
SLOWEST_START_M_S: Final = 0.3
"""Of cuts that a steep approach would have brought from less."""
LONGEST_PASS_S: Final = 300.0
"""A cut that is still inside then has stalled: it creeps."""


class NotModelledError(Exception):
    """The passes of this table under this plant are not modelled here; the message is one sentence."""


@dataclass(frozen=True)
class Ground:
    """The path in cells: free acceleration without resistance, and deceleration by one kPa, of each.

    Cells begin at `start_m`, noise cells at the entrance; `approach_m2_s2`: what gravity adds to v² up to there.
    """

    start_m: float
    approach_m2_s2: float
    cell_m: float
    gravity_m_s2: tuple[float, ...]
    brake_m_s2_per_kpa: tuple[float, ...]
    drag_m_s2_per_n_kn: float
    friction_cv: float
    noise_cell_m: float
    noise_cells: int


@dataclass(frozen=True)
class Passes:
    """How the passes ended: exit speeds (0 after a stall), stalls, changes of stage.

    `weight`: how many cuts a pass stands for; `as_it_comes`: its friction was drawn from the law of cuts.
    """

    exit_m_s: tuple[float, ...]
    stalled: tuple[bool, ...]
    switchings: tuple[int, ...]
    weight: tuple[float, ...]
    as_it_comes: tuple[bool, ...]


def simulate(plant: Plant, table: Table, count: int, seed: int) -> Passes:
    """`count` passes of `plant` under `table`; equal arguments give equal passes.

    Raises `NotModelledError` for a table that decides at any time, where a valve closes late or a command is heard only
    after the next sample.
    """
    if table.at_any_time and (plant.drive.closing_delay_s > 0.0 or plant.computing_s >= plant.period_s):
        raise NotModelledError(
            "commands at any time are modelled only for valves that close at once and for a computing delay shorter "
            f"than the sampling period; here valves close after {plant.drive.closing_delay_s:g} s, and the delay is "
            f"{plant.computing_s:g} s of {plant.period_s:g} s"
        )
    ground, random = ground_of(plant), Random(f"{seed} {table.id}")
    rest_kpa = resting_kpa(plant)
    observer = Observer(table.estimator) if table.estimator else None
    friction = friction_numbers(count, random)
    found = [one_pass(plant, ground, table, observer, rest_kpa, each.normal, random) for each in friction]
    speeds, stalled, switchings = zip(*found, strict=True)
    weights = tuple(each.weight for each in friction)
    return Passes(speeds, stalled, switchings, weights, tuple(each.as_it_comes for each in friction))


def ground_of(plant: Plant) -> Ground:
    """The path of `plant` in cells; coefficients are those at the middle of a cell."""
    start_m = -plant.approach_m
    count = min(MOST_CELLS, math.ceil((plant.exit_m - start_m) / CELL_M))
    cell_m = (plant.exit_m - start_m) / count
    middles = [start_m + (i + 0.5) * cell_m for i in range(count)]
    braked = [plant.braked(s) for s in middles]
    reduced = GRAVITY_M_S2 * plant.mass_t / plant.inertia_t * 1e-3
    busy = [n for n in braked if n > 0]
    mean_braked = max(1.0, sum(busy) / max(1, len(busy)))
    noise_cells = min(MOST_CELLS, math.ceil(plant.exit_m * NOISE_CELLS_A_LENGTH / plant.correlation_m))
    return Ground(
        start_m=start_m,
        approach_m2_s2=2.0 * reduced * plant.grade_work(start_m, 0.0),
        cell_m=cell_m,
        gravity_m_s2=tuple(reduced * plant.grade_permille(s) for s in middles),
        brake_m_s2_per_kpa=tuple(n * plant.slope_kn_per_kpa[n - 1] / plant.inertia_t if n else 0.0 for n in braked),
        drag_m_s2_per_n_kn=reduced,
        friction_cv=math.hypot(plant.friction_cv, plant.axle_cv / math.sqrt(mean_braked)),
        noise_cell_m=plant.exit_m / noise_cells,
        noise_cells=noise_cells,
    )


def resting_kpa(plant: Plant) -> float:
    """Pressure at which the initial stage rests: stage 0 after stage 1 was left, another one entered from below."""
    drive = BrakeDrive(plant.drive, plant.stages_kpa[1])
    for stage in range(plant.initial_stage + 1):
        drive.command(plant.stages_kpa[stage], 0.0)
        for _ in range(1000):
            drive.overpressure(0.1)
            if drive.resting:
                break
    return drive.pressure_kpa


def friction_row(plant: Plant, ground: Ground, normal: float, random: Random) -> list[float]:
    """The friction factor ξ in each noise cell of one pass; `normal`: standard normal number of the cut's own."""
    x = ground.noise_cell_m / plant.correlation_m
    memory = math.exp(-x)
    fresh = math.sqrt(1.0 - memory * memory)
    std = plant.path_std * math.sqrt(math.tanh(x / 2.0) / (x / 2.0))  # keeps the variance of the work
    factor = max(plant.friction_floor, 1.0 + ground.friction_cv * normal)
    eta, row = random.gauss(0.0, 1.0), []
    for _ in range(ground.noise_cells):
        row.append(factor * max(0.0, 1.0 + std * eta))
        eta = memory * eta + fresh * random.gauss(0.0, 1.0)
    return row


def one_pass(
    plant: Plant, ground: Ground, table: Table, observer: Observer | None, rest_kpa: float, normal: float,
    random: Random,
) -> tuple[float, bool, int]:  # fmt: skip
    """(exit speed, stalled, changes of stage) of one pass; `normal`: of the cut's friction."""
    if observer is not None:
        observer.begin()
    friction = friction_row(plant, ground, normal, random)
    mean, std = plant.resistance_n_kn
    w = random.gammavariate((mean / std) ** 2, std * std / mean) if std > 0.0 else mean
    drag = w * ground.drag_m_s2_per_n_kn
    drive = BrakeDrive(plant.drive, rest_kpa)
    s, stage, switchings = ground.start_m, plant.initial_stage, 0
    v = start_speed_m_s(ground, drag, plant.entry.draw(random))
    period = plant.period_s
    steps = max(STEPS_A_PERIOD, math.ceil(period / LONGEST_STEP_S))
    # The first sample comes at a random time after the beginning: until then one short row of steps.
    dt, time, end_m = random.random() * period / steps, 0.0, plant.exit_m
    held, losses = drive.overpressure_kpa, lost_readings(plant, random)
    while time < LONGEST_PASS_S:
        pressed = 0.0
        for _ in range(steps):
            if drive.resting:
                p = held
            else:
                p, held = drive.overpressure(dt), drive.overpressure_kpa
            pressed += p
            middle = s + 0.5 * v * dt
            cell = min(int((middle - ground.start_m) / ground.cell_m), len(ground.gravity_m_s2) - 1)
            xi = friction[min(int(max(0.0, middle) / ground.noise_cell_m), ground.noise_cells - 1)]
            a = ground.gravity_m_s2[cell] - drag - xi * ground.brake_m_s2_per_kpa[cell] * p
            s_next = s + (v + 0.5 * a * dt) * dt
            if s_next >= end_m:
                return math.sqrt(max(0.0, v * v + 2.0 * a * (end_m - s))), False, switchings
            s, v = s_next, v + a * dt
            if v <= 0.0:
                return 0.0, True, switchings
        time += dt * steps
        dt = period / steps
        asked, lost = table.at_any_time or drive.resting, next(losses)
        if observer is None and not asked:
            continue  # nobody looks
        seen = math.nan if lost else measured(plant, v, random)
        if observer is not None:
            seen = observer.observe(s, seen, pressed / steps)
        if asked:
            wanted = decision(table, stage, s, seen, drive.pressure_kpa)
            if wanted != stage:
                stage = wanted
                switchings += 1
                drive.command(plant.stages_kpa[stage], plant.computing_s)
    return 0.0, True, switchings


def start_speed_m_s(ground: Ground, drag_m_s2: float, entry_m_s: float) -> float:
    """The speed at the beginning of a cut that reaches the entrance, not braked, with `entry_m_s`."""
    if ground.start_m == 0.0:
        return entry_m_s
    square = entry_m_s**2 - ground.approach_m2_s2 - 2.0 * drag_m_s2 * ground.start_m
    return max(math.sqrt(max(0.0, square)), SLOWEST_START_M_S)


def measured(plant: Plant, v: float, random: Random) -> float:
    """What the sensor reports of the speed `v`."""
    seen = v + plant.noise_m_s * random.gauss(0.0, 1.0)
    if plant.resolution_m_s > 0.0:
        seen = round(seen / plant.resolution_m_s) * plant.resolution_m_s
    return max(0.0, seen)


def lost_readings(plant: Plant, random: Random) -> Iterator[bool]:
    """Whether the radar loses a reading, sample by sample: bursts of geometric length, and as long between them."""
    if plant.missed_share == 0.0:
        yield from repeat(False)
    burst = max(1.0, plant.missed_burst_s / plant.period_s)
    between = burst * (1.0 - plant.missed_share) / plant.missed_share
    lost = random.random() < plant.missed_share
    while True:
        yield lost
        if random.random() < 1.0 / (burst if lost else between):
            lost = not lost


def decision(table: Table, stage: int, s: float, v: float, kpa: float = math.nan) -> int:
    """The stage to command, in double precision: the present one where no speed is known, `v` being NaN or below 0.

    `kpa`: what the gauge shows, NaN for none.
    """
    if not v >= 0.0:
        return stage
    s = min(max(s, table.path_m[0]), table.path_m[1])
    added = added_m_s(table, stage, kpa)
    raised = lowered = stage
    while raised - stage < table.farthest and is_raised(table, raised, s, v - added[1]):
        raised += 1
    while stage - lowered < table.farthest and is_lowered(table, lowered, s, v - added[0]):
        lowered -= 1
    return lowered if lowered < stage else raised


def is_lowered(table: Table, stage: int, s: float, v: float) -> bool:
    """Whether the cut is too slow for `stage`."""
    lower = table.lines[stage][0]
    return lower is not None and v < speed_at(lower, s)


def is_raised(table: Table, stage: int, s: float, v: float) -> bool:
    """Whether the cut is too fast for `stage`, and the next one may be commanded."""
    upper = table.lines[stage][1]
    return upper is not None and (s >= 0.0 or stage < table.entrance_stage) and v > speed_at(upper, s)


def added_m_s(table: Table, stage: int, kpa: float) -> tuple[float, float]:
    """What the pressure adds to the two lines of `stage`."""
    slopes = table.slopes[stage]
    if slopes == (None, None) or not math.isfinite(kpa):
        return 0.0, 0.0
    clamped = min(max(kpa, table.pressures_kpa[0]), table.pressures_kpa[table.top_stage])
    lower, upper = ((slope or 0.0) * (clamped - table.pressures_kpa[stage]) for slope in slopes)
    return lower, upper


def speed_at(line: Line, s: float) -> float:
    """A line at `s`."""
    value = 0.0
    for coefficient in reversed(line):
        value = value * s + coefficient
    return value
