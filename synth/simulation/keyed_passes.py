"""Random numbers of passes by key: those of a cut at a position, whichever cuts are beside it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Ints
from plant_models.rolling.keyed_numbers import keyed_uniform, keyed_words
from plant_models.rolling.random_numbers import Purpose
from synth.kernels.loop.normal_numbers import normal_rows
from synth.simulation.random_passes import NOISE_SAMPLES, TOGETHER, RandomPasses


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
