"""How many binary digits a quantity needs."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """A quantity whose absolute value is from `least` to `greatest`, wanted in steps of `step`; all in one unit."""

    name: str
    least: float
    greatest: float
    step: float

    @property
    def bits(self) -> int:
        """Digits that tell all steps apart: the least R with 2^R ≥ (greatest − least)/step + 1, without a sign."""
        return max(1, digits((self.greatest - self.least) / self.step + 1.0))


def digits(values: float) -> int:
    """log2 rounded up; a ratio of decimals that should be a power of 2 must not be one digit more by its rounding."""
    return math.ceil(math.log2(values * (1.0 - 1e-12)))


def common_word_bits(quantities: tuple[Quantity, ...]) -> int:
    """Digits of the word that holds any of `quantities`."""
    return max(quantity.bits for quantity in quantities)


def hump_quantities() -> tuple[Quantity, ...]:
    """What the hump computer handles, in steps of sensors, of the cut record and of the sampling, as this program has.

    The widest take 14 digits; 16 is the next word that is built, and the choice of [hump-computer-1970s].
    """
    return (
        Quantity("measured speed, m/s: strobe, radar", 0.0, 8.5, 0.04),
        Quantity("commanded speed, m/s: strobe, a quarter of the radar's step", 0.0, 8.5, 0.01),
        Quantity("place, m: crest to end of track, 1 m/s for one sample", 0.0, 1500.0, 0.1),
        Quantity("mass of a cut, t: cut record", 0.0, 2046.0, 2.0),
        Quantity("pressure, kPa: supply, a tenth of the dead band", 0.0, 800.0, 1.5),
        Quantity("time in a train, s: 20 minutes, one sample", 0.0, 1200.0, 0.1),
        Quantity("axles of a cut: sorting list", 2.0, 400.0, 1.0),
    )
