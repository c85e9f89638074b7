"""What an aim table is for: the position that it commands, the cuts, what is required of them, and what is known."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeAlias

from tuning_tables.category_number import require_category_number
from tuning_tables.errors import InvalidTable
from tuning_tables.requirement import require_between, require_finite, require_text

FASTEST_M_S: Final = 40.0
FARTHEST_M: Final = 1e5


@dataclass(frozen=True)
class ParkPosition:
    """The position that is told an exit speed; a cut leaves it when its last axle is `exit_at_m` from the crest."""

    name: str
    exit_at_m: float

    def __post_init__(self) -> None:
        require_text(self.name, "position.name")
        require_between(self.exit_at_m, "position.exit_at_m", 0.0, FARTHEST_M)


@dataclass(frozen=True)
class AimCategory:
    """The weight category of the cuts: its number in controllers, 1 to 5 or 16 to 255, and its name."""

    number: int
    name: str

    def __post_init__(self) -> None:
        require_text(self.name, "category.name")
        require_category_number(self.name, self.number, "category.number")


@dataclass(frozen=True)
class Required:
    """A cut may couple faster than `coupling_speed_m_s` with the probability `p_overspeed`, within (0, 1)."""

    p_overspeed: float
    coupling_speed_m_s: float

    def __post_init__(self) -> None:
        require_finite(self.p_overspeed, "required.p_overspeed")
        if not 0.0 < self.p_overspeed < 1.0:
            raise InvalidTable(f"required.p_overspeed is {self.p_overspeed!r}, but it must lie within (0, 1).")
        require_between(self.coupling_speed_m_s, "required.coupling_speed_m_s", 0.01, FASTEST_M_S)


@dataclass(frozen=True)
class CategoryAlone:
    """Of a cut the category is known and the number of its cars."""


@dataclass(frozen=True)
class MeasuredResistance:
    """Of a cut the rolling resistance was measured, too: by its speeds at `from_m` and `to_m` from the crest.

    `speed_std_m_s`: standard deviation of each of the two speeds.
    """

    from_m: float
    to_m: float
    speed_std_m_s: float

    def __post_init__(self) -> None:
        require_between(self.from_m, "knowledge.from_m", 0.0, FARTHEST_M)
        require_between(self.to_m, "knowledge.to_m", 0.0, FARTHEST_M)
        if not self.from_m < self.to_m:
            raise InvalidTable(
                f"knowledge.to_m is {self.to_m!r}, but it must exceed knowledge.from_m, {self.from_m!r}."
            )
        require_between(self.speed_std_m_s, "knowledge.speed_std_m_s", 0.0, FASTEST_M_S)


Knowledge: TypeAlias = CategoryAlone | MeasuredResistance
