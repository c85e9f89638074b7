"""What a yard manager asks: metres of gap and damaging couplings, today's practice beside the chain."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from scripts.studies.aiming.trial import Value, value_if_known
from scripts.studies.yard_chain.chain import CATEGORY, ESTIMATED, MEASURED, Kind

TODAY_EXIT = "σ 0.4"

LIGHT, HEAVY = Kind("L", 1), Kind("T", 1)
LIGHT_STRAIGHT, HEAVY_STRAIGHT = Kind("L", 1, True), Kind("T", 1, True)


@frozen_arrays
class Samples:
    """Figures of every replicate (replicates, knowledge, positions, places, FIGURES) with the names of two axes."""

    knowledge: tuple[str, ...]
    positions: tuple[str, ...]
    figures: Floats

    def of(self, knowledge: str, position: str) -> Floats:
        """(replicates, places, FIGURES) of one pair."""
        return np.asarray(self.figures[:, self.knowledge.index(knowledge), self.positions.index(position)])


@dataclass(frozen=True)
class Practice:
    """Single cars, light and heavy alike often, all free distances alike often: metres of gap a car, and couplings
    above the limit, 1.5 and 2 m/s in a thousand cars. None where some cuts have no commands for the share."""

    name: str
    gap_m: Value | None
    couplings: tuple[Value | None, Value | None, Value | None]


@dataclass(frozen=True)
class Saved:
    """Metres of gap a car that one practice leaves more than another, on the same cuts at one free distance."""

    cuts: str
    metres: float
    exit_alone_m: Value | None
    measuring_alone_m: Value | None
    both_m: Value | None


def practice(name: str, pairs: tuple[Floats, ...]) -> Practice:
    """The mean over kinds of cuts, each (replicates, places, FIGURES)."""
    mean = np.mean([each.mean(axis=1) for each in pairs], axis=0)
    gap, over, harder, hardest = (value_if_known(scale * mean[:, k]) for k, scale in enumerate((1.0, 1e3, 1e3, 1e3)))
    return Practice(name, gap, (over, harder, hardest))


def practices(
    all_cuts: Mapping[Kind, Samples], careful: Mapping[Kind, Samples], careful_share: float
) -> tuple[Practice, ...]:
    """Today's, each step alone, the chain, and that on a straight stretch; `careful`: at the share `careful_share`."""

    def both(
        samples: Mapping[Kind, Samples], light: Kind, heavy: Kind, known: str, position: str
    ) -> tuple[Floats, ...]:
        return samples[light].of(known, position), samples[heavy].of(known, position)

    bent, straight = (LIGHT, HEAVY), (LIGHT_STRAIGHT, HEAVY_STRAIGHT)
    return (
        practice("today: exit σ 0.4, category", both(all_cuts, *bent, CATEGORY, TODAY_EXIT)),
        practice("our tables, category", both(all_cuts, *bent, CATEGORY, ESTIMATED)),
        practice("exit σ 0.4, resistance measured", both(all_cuts, *bent, MEASURED, TODAY_EXIT)),
        practice("our tables, resistance measured", both(all_cuts, *bent, MEASURED, ESTIMATED)),
        practice("the same, straight stretch", both(all_cuts, *straight, MEASURED, ESTIMATED)),
        practice(f"the same, share {careful_share:g}", both(careful, *straight, MEASURED, ESTIMATED)),
    )


def saved(kind: Kind, samples: Samples, metres: tuple[float, ...]) -> tuple[Saved, ...]:
    """What our tables, measuring, and both save beside today's practice; a row a distance."""
    today = samples.of(CATEGORY, TODAY_EXIT)
    pairs = ((CATEGORY, ESTIMATED), (MEASURED, TODAY_EXIT), (MEASURED, ESTIMATED))
    steps = [today - samples.of(*pair) for pair in pairs]
    return tuple(
        Saved(kind.name, place, *(value_if_known(step[:, k, 0]) for step in steps)) for k, place in enumerate(metres)
    )
