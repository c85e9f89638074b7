"""How many binary digits a quantity needs."""

from __future__ import annotations

import math
from dataclasses import dataclass

from plant_models.errors import require


@dataclass(frozen=True)
class Quantity:
    """A quantity whose absolute value is from `least` to `greatest`, wanted in steps of `step`; one unit for all three.

    Raises `PlantError`.
    """

    name: str
    least: float
    greatest: float
    step: float

    def __post_init__(self) -> None:
        for name, value in (("least", self.least), ("greatest", self.greatest), ("step", self.step)):
            require(
                math.isfinite(value) and value >= 0.0,
                f"{self.name}: {name} is {value!r}; it must be a finite number from 0 on",
            )
        require(self.step > 0.0, f"{self.name}: step is 0; it must be above 0")
        require(
            self.greatest >= self.least,
            f"{self.name}: greatest is {self.greatest:g}; it must not be less than least, {self.least:g}",
        )

    @property
    def bits(self) -> int:
        """Digits that tell all steps apart: the least R with 2^R ≥ (greatest − least)/step + 1, without a sign."""
        return max(1, _digits((self.greatest - self.least) / self.step + 1.0))

    @property
    def bits_of_source(self) -> int:
        """R = log2((greatest − least + 1)/step), rounded up, as [hump-computer-1970s] prints it.

        The 1 is one unit there, not one step, so the result depends on the unit. For a range of whole steps it is
        never too few; for steps below 1 it can be more than is needed, most where the range is small.
        """
        return max(1, _digits((self.greatest - self.least + 1.0) / self.step))


def common_word_bits(quantities: tuple[Quantity, ...]) -> int:
    """Digits of the word that holds any of `quantities`; `PlantError` if there is none."""
    require(len(quantities) > 0, "word length: there is no quantity; there must be at least one")
    return max(quantity.bits for quantity in quantities)


def _digits(values: float) -> int:
    """log2 rounded up; a ratio of decimals that should be a power of 2 must not be one digit more by its rounding."""
    return math.ceil(math.log2(values * (1.0 - 1e-12)))


SOURCE_WORD_BITS = 16
"""What [hump-computer-1970s] chooses."""


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
