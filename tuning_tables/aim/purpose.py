"""What an aim table is for: the position that it commands, the cuts, what is required of them, and what is known."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Final

from tuning_tables.category_number import KNOWN_NUMBERS, LARGEST_OWN, LEAST_OWN, require_category_number
from tuning_tables.declared.members import Json, require_declared
from tuning_tables.declared.numbers import Count, Number
from tuning_tables.declared.texts import Text
from tuning_tables.errors import InvalidTable

FASTEST_M_S: Final = 40.0
FARTHEST_M: Final = 1e5


@dataclass(frozen=True)
class ParkPosition:
    """The position that is told an exit speed.

    Examples
    --------
    >>> from tuning_tables.aim import ParkPosition
    >>> ParkPosition("rnz-2m-park", exit_at_m=330.0).exit_at_m
    330.0
    """

    name: Annotated[str, Text("its name")]
    exit_at_m: Annotated[float, Number("a cut leaves it when its last axle is so far from the crest", 0.0, FARTHEST_M)]

    def __post_init__(self) -> None:
        require_declared(self, "position")


@dataclass(frozen=True)
class AimCategory:
    """The weight category of the cuts.

    Examples
    --------
    >>> from tuning_tables.aim import AimCategory
    >>> AimCategory(number=3, name="С").name
    'С'
    """

    number: Annotated[int, Count("what stands for it in controllers", 1, LARGEST_OWN)]
    name: Annotated[str, Text("its name")]
    SCHEMA: ClassVar[Json] = {
        "oneOf": [
            {"properties": {"name": {"not": {"enum": list(KNOWN_NUMBERS)}}, "number": {"minimum": LEAST_OWN}}},
            *(
                {"properties": {"name": {"const": name}, "number": {"const": number}}}
                for name, number in KNOWN_NUMBERS.items()
            ),
        ]
    }

    def __post_init__(self) -> None:
        require_declared(self, "category")
        require_category_number(self.name, self.number, "category.number")


@dataclass(frozen=True)
class Required:
    """What is required of the speed at which cuts couple.

    Examples
    --------
    >>> from tuning_tables.aim import Required
    >>> Required(p_overspeed=0.1, coupling_speed_m_s=1.4).p_overspeed
    0.1
    """

    p_overspeed: Annotated[
        float, Number("a cut may couple faster than that with this probability, within (0, 1)", 0.0, 1.0)
    ]
    coupling_speed_m_s: Annotated[float, Number("fastest coupling that is wanted", 0.01, FASTEST_M_S)]
    SCHEMA: ClassVar[Json] = {"properties": {"p_overspeed": {"exclusiveMinimum": 0, "exclusiveMaximum": 1}}}

    def __post_init__(self) -> None:
        require_declared(self, "required")
        if not 0.0 < self.p_overspeed < 1.0:
            raise InvalidTable(f"required.p_overspeed is {self.p_overspeed!r}, but it must lie within (0, 1).")


@dataclass(frozen=True)
class MeasuredResistance:
    """By which speeds the rolling resistance of a cut was measured; null: its category alone is known.

    Examples
    --------
    >>> from tuning_tables.aim import MeasuredResistance
    >>> MeasuredResistance(from_m=210.0, to_m=290.0, speed_std_m_s=0.1).to_m
    290.0
    """

    from_m: Annotated[float, Number("first place, from the crest", 0.0, FARTHEST_M)]
    to_m: Annotated[float, Number("second place, from the crest", 0.0, FARTHEST_M)]
    speed_std_m_s: Annotated[float, Number("standard deviation of each of the two speeds", 0.0, FASTEST_M_S)]

    def __post_init__(self) -> None:
        require_declared(self, "measured")
        if not self.from_m < self.to_m:
            raise InvalidTable(f"measured.to_m is {self.to_m!r}, but it must exceed measured.from_m, {self.from_m!r}.")
