"""What regulators twice as accurate give: the dissertation reports half of the over-speeds and gaps ÷ 1.5."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.library.weight_category import WeightCategory
from scripts.studies.aiming.places import FromCrest
from scripts.studies.aiming.trial import Cuts, Draws, Value, samples, value_of
from synth.aim.knowledge import ByCategory
from synth.aim.position_models import NormalPosition
from synth.aim.scene import AimScene

BEFORE, AFTER = 0.115, 0.055
"""Middle of the shares of over-speeds that the dissertation reports: 10 to 13 %, and 5 to 6 %."""


@dataclass(frozen=True)
class Doubled:
    """One category and distance from the crest: gap a car at the over-speeds of before with `coarse_std_m_s`, at those
    of after with half of it, and their ratio; the same at over-speeds of before; and the share above 2 m/s of both."""

    category: str
    metres: float
    gap_before_m: Value
    gap_after_m: Value
    ratio: Value | None
    ratio_at_same_share: Value | None
    above_2_before: Value
    above_2_after: Value


def doubled_accuracy(
    scene: AimScene, category: WeightCategory, metres: tuple[float, ...], coarse_std_m_s: float, draws: Draws
) -> tuple[Doubled, ...]:
    """A row a distance, single cars by category."""
    places, cuts = FromCrest(metres), Cuts(scene, category)
    coarse, fine = (NormalPosition(std, only_brakes=False) for std in (coarse_std_m_s, 0.5 * coarse_std_m_s))
    before = samples(cuts, places, coarse, ByCategory(), BEFORE, draws)
    after = samples(cuts, places, fine, ByCategory(), AFTER, draws)
    same = samples(cuts, places, fine, ByCategory(), BEFORE, draws)
    rows = []
    for k, place in enumerate(metres):
        gaps = [each[:, k, 0] for each in (before, after, same)]
        rows.append(
            Doubled(
                category.latin, place, value_of(gaps[0]), value_of(gaps[1]), ratio(gaps[0], gaps[1]),
                ratio(gaps[0], gaps[2]), value_of(before[:, k, 3]), value_of(after[:, k, 3]),
            )
        )  # fmt: skip
    return tuple(rows)


def ratio(of: np.ndarray, to: np.ndarray) -> Value | None:
    """Quotient of paired replicates (of logarithms); None where one is 0."""
    if (of <= 0.0).any() or (to <= 0.0).any():
        return None
    logs = value_of(np.log(of / to))
    low, high = logs.ci95
    return Value(float(np.exp(logs.value)), (float(np.exp(low)), float(np.exp(high))))
