"""What a table says of itself: where it comes from and what it is for (the generator, the retarder and the cut it
was made for), where it holds, what was predicted of it, what a closed-loop run confirmed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Final

import numpy as np

from tuning_tables.category_number import KNOWN_NUMBERS, LARGEST_OWN, LEAST_OWN, require_category_number
from tuning_tables.declared.members import Json, require_declared
from tuning_tables.declared.numbers import Count, Number, Row
from tuning_tables.declared.texts import Text
from tuning_tables.errors import SHA256_HEX, UTC_INSTANT, InvalidTable, require_rising, require_text

TABLE_NAME: Final = Text("name of the table, also that of its file")
CREATED: Final = Text("instant of creation, which the caller gives", UTC_INSTANT, "2026-11-20T22:46:00Z")


@dataclass(frozen=True)
class Generator:
    """The program that made the table.

    Examples
    --------
    >>> from tuning_tables import Generator
    >>> Generator(name="by hand", version="1", config_sha256="0" * 64).name
    'by hand'
    """

    name: Annotated[str, Text("its name")]
    version: Annotated[str, Text("its version")]
    config_sha256: Annotated[
        str, Text("SHA-256 of its resolved configuration", SHA256_HEX, "of 64 lower-case hex digits")
    ]

    def __post_init__(self) -> None:
        require_declared(self, "generator")


@dataclass(frozen=True)
class RetarderId:
    """The retarder position that the table is for.

    Zones are in the order of the path and do not overlap; the exit does not lie before the end of the last one.

    Examples
    --------
    >>> from tuning_tables import RetarderId
    >>> RetarderId(
    ...     "my-retarder",
    ...     zones_m=((0.0, 12.0), (14.0, 26.0)),
    ...     exit_m=36.5,
    ...     dead_band_kpa=15.0,
    ... ).exit_m
    36.5
    """

    name: Annotated[str, Text("its name")]
    zones_m: Annotated[
        tuple[tuple[float, float], ...],
        Row(Row(Number("beginning and end of each retarder along the path"), "end", 2, 2), "zone"),
    ]
    exit_m: Annotated[float, Number("path of the first axle at which the pass ends")]
    dead_band_kpa: Annotated[float, Number("dead band of the pressure regulator", 0.0)]

    def __post_init__(self) -> None:
        require_declared(self, "retarder")
        reached_m = -float("inf")
        for index, zone in enumerate(self.zones_m):
            key = f"retarder.zones_m[{index}]"
            require_rising(zone, key)
            if zone[0] < reached_m:
                raise InvalidTable(f"{key} is {zone!r}, but it must not begin before {reached_m!r}, the end before it.")
            reached_m = zone[1]
        if self.exit_m < reached_m:
            raise InvalidTable(
                f"retarder.exit_m is {self.exit_m!r}, but it must not lie before {reached_m!r}, the last zone's end."
            )


@dataclass(frozen=True)
class CutId:
    """The class of cuts that the table is for.

    Axle offsets rise from 0.0. A category of the yard has its number whether the table states it or not.

    Examples
    --------
    >>> from tuning_tables import CutId
    >>> CutId(category="С", mass_t=52.0, axle_offsets_m=(0.0, 1.85, 8.65, 10.5)).number
    3
    """

    category: Annotated[str, Text("weight category")]
    mass_t: Annotated[float, Number("mass of the cut", is_positive=True)]
    axle_offsets_m: Annotated[tuple[float, ...], Row(Number("of each axle behind the first"), "axle")]
    category_number: Annotated[
        int | None, Count("what stands for the category in controllers; without it, that of the yard", 1, LARGEST_OWN)
    ] = None
    SCHEMA: ClassVar[Json] = {
        "oneOf": [
            {"properties": {"category_number": {"type": "null"}}},
            {
                "properties": {
                    "category": {"not": {"enum": list(KNOWN_NUMBERS)}},
                    "category_number": {"type": "integer", "minimum": LEAST_OWN},
                }
            },
            *(
                {"properties": {"category": {"const": name}, "category_number": {"const": number}}}
                for name, number in KNOWN_NUMBERS.items()
            ),
        ]
    }

    def __post_init__(self) -> None:
        require_text(self.category, "cut.category")
        if self.category_number is not None:
            require_category_number(self.category, self.category_number)
        require_declared(self, "cut")
        require_rising(self.axle_offsets_m, "cut.axle_offsets_m")
        if self.axle_offsets_m[0] != 0.0:
            raise InvalidTable(
                f"cut.axle_offsets_m begins with {self.axle_offsets_m[0]!r}, "
                "but it must begin with 0.0: offsets are measured from the first axle."
            )

    @property
    def number(self) -> int | None:
        """What stands for the category in controllers, as stated, else that of a category of the yard, else None."""
        return KNOWN_NUMBERS.get(self.category) if self.category_number is None else self.category_number


SHORTEST_RANGE: Final = 1e-3
"""Of path in m, of speed in m/s."""
FARTHEST: Final = 1e6
"""Of path in m, of speed in m/s."""


@dataclass(frozen=True)
class ValidRange:
    """The path and the speeds on which the lines were fitted.

    The rule clamps the path into this range and does not look at the speed range (see `rule.decide`). Both rise.

    Examples
    --------
    >>> from tuning_tables import ValidRange
    >>> ValidRange(s_m=(0.0, 22.5), v_m_s=(0.5, 8.0))
    ValidRange(s_m=(0.0, 22.5), v_m_s=(0.5, 8.0))
    """

    s_m: Annotated[tuple[float, float], Row(Number("least and greatest path", -FARTHEST, FARTHEST), "end", 2, 2)]
    v_m_s: Annotated[tuple[float, float], Row(Number("least and greatest speed", 0.0, FARTHEST), "end", 2, 2)]

    def __post_init__(self) -> None:
        require_declared(self, "valid")
        for key, ends in (("valid.s_m", self.s_m), ("valid.v_m_s", self.v_m_s)):
            require_rising(ends, key)
            # Shorter ranges mean nothing on a track, and ratios of lengths stay finite.
            if not np.float32(ends[1]) - np.float32(ends[0]) >= SHORTEST_RANGE:
                raise InvalidTable(f"{key} is {ends!r}, but its ends must be at least {SHORTEST_RANGE:g} apart.")


@dataclass(frozen=True)
class Predicted:
    """What the solver expects of this table.

    Examples
    --------
    >>> from tuning_tables import Predicted
    >>> Predicted(
    ...     rms_m_s=0.025, bias_m_s=0.001, p_overspeed=0.0, switchings=7.1
    ... ).passes is None  # not sampled
    True
    """

    rms_m_s: Annotated[float, Number("error of the exit speed, root of its mean square", 0.0)]
    bias_m_s: Annotated[float, Number("mean error of the exit speed")]
    p_overspeed: Annotated[float, Number("probability of more than the target + 0.3 m/s", 0.0, 1.0)]
    switchings: Annotated[float, Number("changes of stage in a pass", 0.0)]
    p_stall: Annotated[
        float | None, Number("probability that the cut comes to a stand in the retarder; null: not computed", 0.0, 1.0)
    ] = None
    passes: Annotated[int | None, Count("simulated passes that the figures come from; null: exact", 1)] = None

    def __post_init__(self) -> None:
        require_declared(self, "predicted")


@dataclass(frozen=True)
class Validated:
    """What a closed loop confirmed; null before it was run.

    Examples
    --------
    >>> from tuning_tables import Validated
    >>> Validated(passes=20_000, rms_m_s=0.025, rms_ci95_m_s=(0.0247, 0.0253)).rms_m_s
    0.025
    """

    passes: Annotated[int, Count("simulated passes", 1)]
    rms_m_s: Annotated[float, Number("error of the exit speed, root of its mean square", 0.0)]
    rms_ci95_m_s: Annotated[tuple[float, float], Row(Number("95 % interval of it", 0.0), "end", 2, 2)]

    def __post_init__(self) -> None:
        require_declared(self, "validated")
        if self.rms_ci95_m_s[0] > self.rms_ci95_m_s[1]:
            raise InvalidTable(
                f"validated.rms_ci95_m_s is {self.rms_ci95_m_s!r}, but its first end must not exceed its second."
            )


def rms_in_words(predicted: Predicted, validated: Validated | None) -> str:
    """The figure that a table is judged by: as simulated, else as predicted."""
    if validated is None:
        return f"predicted rms {predicted.rms_m_s:.4f} m/s"
    low, high = validated.rms_ci95_m_s
    return f"rms {validated.rms_m_s:.4f} [{low:.4f}, {high:.4f}] m/s in {validated.passes} passes"
