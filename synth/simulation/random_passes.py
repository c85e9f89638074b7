"""Random numbers of simulated passes, drawn once and used for every controller (common random numbers): in rows, or
by key, those of a cut at a position, whichever cuts are beside it; and which readings a radar loses, in bursts.

Whether a reading is lost is a Markov chain of two states, one step a sample (Gilbert 1960): a burst ends with
probability 1/L at each sample, L its mean length in readings, and a new one begins with the probability that makes the
stationary share what it is to be. The numbers that decide come from the key of the pass, so no other number of the
pass moves, and a pass loses the same readings under every controller.

The numbers of the sensor come again after so many readings, and with them the losses. So the chain runs round a ring:
it goes round twice with the same numbers, and the second turn, which ends as it began, is kept. A burst may thus last
over the place where they come again.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import fields

import numpy as np
from numpy.typing import NDArray

from plant_models import DopplerSensor
from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from plant_models.rolling.random_numbers import Purpose, keyed_uniform, keyed_words
from synth.kernels.loop.normal_numbers import normal_rows

BLOCK_PASSES = 1000
"""Passes that share one random stream; fixed, because pass i must not depend on how many are asked for."""

PATH_CELLS = 512
"""Most random numbers along the path of one pass; a closed loop uses the first of them, one a cell."""

TOGETHER = 32
"""Passes whose numbers are worked out at a time: their rows stay in the cache."""

NOISE_SAMPLES = 256
"""Random numbers of the speed sensor in one pass; after that many samples they come again (25 s at 0.1 s)."""


LOSSES = 3
"""Number of the child stream of a block that the keys of lost readings come from; 0 and 1 are those of path and sensor,
2 that of strata."""


@frozen_arrays
class RandomPasses:
    """Standard random numbers of n passes; what they mean physically is decided by the plant.

    `cut_z` (n,) standard normal for ξ_cut; `entry_u`, `phase_u`, `resistance_u` (n,) uniform in [0, 1) for
    the entry speed, the phase of the sampling and the rolling resistance; `path_z` (n, cells) and `noise_z`
    (n, 256) standard normal float32 for η along the path and the sensor. A NaN in `noise_z` is a missing reading.
    `loss_key` (n,), not negative, begins the numbers that readings of the pass are lost by (`lost_readings`).
    `weight` (n,): how many cuts each pass stands for; 1 where passes are drawn as cuts come.
    """

    cut_z: Floats
    entry_u: Floats
    phase_u: Floats
    resistance_u: Floats
    path_z: NDArray[np.float32]
    noise_z: NDArray[np.float32]
    loss_key: Ints
    weight: Floats

    def __post_init__(self) -> None:
        for array in vars(self).values():
            if len(array) != len(self.cut_z):
                raise ValueError("random passes: all arrays must have one entry a pass")

    def __len__(self) -> int:
        return len(self.cut_z)

    def part(self, start: int, stop: int) -> RandomPasses:
        """Passes `start` … `stop − 1` of these, as views."""
        return RandomPasses(**{name: getattr(self, name)[start:stop] for name in NAMES})

    def every(self, step: int, start: int) -> RandomPasses:
        """Passes `start`, `start` + `step`, … of these, as views."""
        return RandomPasses(**{name: getattr(self, name)[start::step] for name in NAMES})


PassRow = Callable[[int, int, int, int], RandomPasses]
"""An endless row of passes: (seed, first pass, count, path cells)."""

NAMES = tuple(field.name for field in fields(RandomPasses))


def random_passes(seed: int, first_pass: int, count: int, path_cells: int = PATH_CELLS) -> RandomPasses:
    """Passes `first_pass` … `first_pass + count − 1` of the endless row that `seed` stands for.

    Pass i has the same numbers whatever `first_pass` and `count`: block b of 1000 passes is drawn whole from
    `SeedSequence(seed, spawn_key=(b,))` and its children. Who needs no more than `path_cells` numbers along the path
    saves the time for the others; it does not change them.
    """
    return row_of_passes(block_of_passes, seed, first_pass, count, path_cells)


def row_of_passes(
    block_of: Callable[[int, int, int], RandomPasses], seed: int, first_pass: int, count: int, path_cells: int
) -> RandomPasses:
    """Passes `first_pass` … `first_pass + count − 1` of a row; `block_of(seed, block, path_cells)` gives its blocks."""
    if not 1 <= path_cells <= PATH_CELLS:
        raise ValueError(f"random passes: {path_cells} path cells, but 1 to {PATH_CELLS} are possible")
    if seed < 0 or first_pass < 0 or count < 0:
        raise ValueError(f"random passes: seed {seed}, first pass {first_pass} and count {count} must not be negative")
    end = first_pass + count
    pieces: list[RandomPasses] = []
    for block in range(first_pass // BLOCK_PASSES, max(-(-end // BLOCK_PASSES), first_pass // BLOCK_PASSES + 1)):
        start = block * BLOCK_PASSES
        drawn = block_of(seed, block, path_cells)
        pieces.append(drawn.part(max(first_pass, start) - start, min(end, start + BLOCK_PASSES) - start))
    if len(pieces) == 1:
        return pieces[0]
    return RandomPasses(**{name: np.concatenate([getattr(piece, name) for piece in pieces]) for name in NAMES})


def block_of_passes(seed: int, block: int, path_cells: int) -> RandomPasses:
    """All passes of one block, in the order of drawing that the row is defined by."""
    sequence = np.random.SeedSequence(seed, spawn_key=(block,))
    path, noise = sequence.spawn(2)
    rng = np.random.Generator(np.random.SFC64(sequence))
    return RandomPasses(
        cut_z=rng.standard_normal(BLOCK_PASSES),
        entry_u=rng.random(BLOCK_PASSES),
        phase_u=rng.random(BLOCK_PASSES),
        resistance_u=rng.random(BLOCK_PASSES),
        noise_z=normal_columns(noise, NOISE_SAMPLES),
        path_z=normal_columns(path, path_cells),
        loss_key=loss_keys(seed, block),
        weight=np.ones(BLOCK_PASSES),
    )


def loss_keys(seed: int, block: int) -> Ints:
    """Keys of one block, (1000,), of a stream of their own: they move none of its other numbers."""
    stream = np.random.SFC64(np.random.SeedSequence(seed, spawn_key=(block, LOSSES)))
    return (stream.random_raw(BLOCK_PASSES) >> np.uint64(1)).astype(np.int64)


def normal_columns(sequence: np.random.SeedSequence, columns: int) -> NDArray[np.float32]:
    """Standard normal numbers of one block, (1000, columns): two columns are drawn at a time, for all passes."""
    words = np.random.SFC64(sequence).random_raw(-(-columns // 2) * BLOCK_PASSES)
    drawn = np.empty((BLOCK_PASSES, columns), dtype=np.float32)
    normal_rows(words, drawn, np.empty((2, TOGETHER), dtype=np.float32))
    return drawn


def keyed_passes(seed: int, keys: tuple[Ints, ...], friction_keys: tuple[Ints, ...], path_cells: int) -> RandomPasses:
    """Passes told apart by `keys`, arrays (n,) each; two with the same `friction_keys` have the same ξ_cut.

    A pass has the same numbers whatever n, and the same first ones along the path whatever `path_cells`.
    """
    from scipy.special import ndtri  # start-up: scipy only where it is needed

    entry, phase, resistance = keyed_uniform(seed, Purpose.PASS_CLOCK, keys, 3)
    return RandomPasses(
        cut_z=ndtri(keyed_uniform(seed, Purpose.CUT_FRICTION, friction_keys, 1)[0]),
        entry_u=entry,
        phase_u=phase,
        resistance_u=resistance,
        path_z=keyed_normal(seed, Purpose.PASS_PATH, keys, path_cells),
        noise_z=keyed_normal(seed, Purpose.PASS_NOISE, keys, NOISE_SAMPLES),
        loss_key=(keyed_words(seed, Purpose.PASS_LOSS, keys, 1)[0] >> np.uint64(1)).astype(np.int64),
        weight=np.ones(len(phase)),
    )


def keyed_normal(seed: int, purpose: Purpose, keys: tuple[Ints, ...], columns: int) -> NDArray[np.float32]:
    """Standard normal numbers (n, columns)."""
    words = keyed_words(seed, purpose, keys, -(-columns // 2))
    drawn = np.empty((words.shape[1], columns), dtype=np.float32)
    normal_rows(words.reshape(-1), drawn, np.empty((2, TOGETHER), dtype=np.float32))
    return drawn


BURSTS_A_TURN = 8
"""Mean bursts that a ring has room for at least: that its chain does not end as it began then has probability e⁻⁸."""


def readings_z(passes: RandomPasses, sensor: DopplerSensor) -> NDArray[np.float32]:
    """The numbers of the readings of `passes`, NaN where `sensor` loses one; (n, 256) or some times as many columns.

    Those of `passes` themselves where it loses none.
    """
    if sensor.missed_share == 0.0:
        return passes.noise_z
    samples = passes.noise_z.shape[1]
    turns = max(1, math.ceil(BURSTS_A_TURN * sensor.missed_readings / samples))
    lost = lost_readings(passes.loss_key, sensor, turns * samples)
    return np.where(lost, np.float32(np.nan), np.tile(passes.noise_z, (1, turns)))


def lost_readings(keys: Ints, sensor: DopplerSensor, samples: int) -> Bools:
    """Which of `samples` readings are lost in passes with these `keys` (n,), (n, samples)."""
    stay = 1.0 - 1.0 / sensor.missed_readings
    begin = (1.0 - stay) * sensor.missed_share / (1.0 - sensor.missed_share)
    first, *u = keyed_uniform(0, Purpose.LOST_READING, (keys,), samples + 1)
    lost = np.empty((samples, len(keys)), dtype=np.bool_)
    now = first < sensor.missed_share
    for _ in range(2):
        for sample in range(samples):
            now = u[sample] < np.where(now, stay, begin)
            lost[sample] = now
    return np.ascontiguousarray(lost.T)
