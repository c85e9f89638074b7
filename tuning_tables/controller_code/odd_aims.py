"""Questions to an aim table that no set has: one in which every condition of `exit_speed` counts, and damaged ones.

The self-test makes it of a copy of table 0, change by change, as far as the set has room for it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from tuning_tables.controller_code.code import OddQuestion, Place, Rule, Values
from tuning_tables.controller_code.odd_tables import Asked, as_held
from tuning_tables.language.records import SizedRecord
from tuning_tables.programs.aim_table import AimGrid


def odd_aims(record: SizedRecord, first: Values, exit_speed: Rule) -> Iterator[OddQuestion]:
    """The questions to copies of table 0, `first`."""
    held = {name: np.array(value) for name, value in first.items()}
    for changes, given in (*placed(record), *damaged(record)):
        for name, place, number in changes:
            held[name][place] = number
        table = AimGrid(**{name: as_held(value) for name, value in held.items()})
        yield OddQuestion(changes, exit_speed, given, float(exit_speed.function(table, *given.values())))


def placed(record: SizedRecord) -> Iterator[Asked]:
    """Two listed numbers of cars, three distances and two resistances, or as many as there is room for."""
    sizes = {name: min(most, record.room[name]) for name, most in (("listed", 2), ("distances", 3), ("resistances", 2))}
    axes = {"cars": (2.0, 4.0), "distance_m": (10.0, 20.0, 30.0), "resistance_n_per_kn": (1.0, 2.0)}
    numbers = {"is_measured": 1.0, "lowest_m_s": 0.5, "highest_m_s": 9.0, **sizes}
    base: list[tuple[str, Place, float]] = [*((name, (), float(number)) for name, number in numbers.items())]
    for (name, values), size in zip(axes.items(), sizes.values(), strict=True):
        base += [(name, (place,), value) for place, value in enumerate(values[:size])]
    nodes = list(np.ndindex(*sizes.values()))
    # Less speed for more cars; more for a longer way.
    base += [("speed_m_s", node, 3.0 - node[0] + 0.5 * node[1] - 0.25 * node[2]) for node in nodes]
    yield tuple(base), for_exit_speed(2, 10.0, 1.0)
    for cars in (1, 3, 4, 5):
        yield (), for_exit_speed(cars, 15.0, 1.5)
    for distance_m in (5.0, 20.0, 25.0, 30.0, 35.0):
        yield (), for_exit_speed(2, distance_m, 0.5)
    for resistance in (2.0, 3.0, np.nan, np.inf, -np.inf):
        yield (), for_exit_speed(2, 15.0, resistance)
    # More speed for more cars, so that the first row is the lesser.
    yield tuple(("speed_m_s", node, 2.0 + node[0]) for node in nodes), for_exit_speed(3, 15.0, 1.0)
    last = sizes["distances"] - 1
    for node in ((0, 0, 0), (0, last, 0)):
        # No speed at the node below, then at the one above, or the last; a last speed that is less than the one before.
        yield (("speed_m_s", node, -1.0),), for_exit_speed(2, 15.0 if last else 10.0, 1.0)
        yield (), for_exit_speed(2, 35.0, 1.0)
        yield (("speed_m_s", node, 1.0),), for_exit_speed(2, 35.0, 1.0)
    if last > 0:
        for speed_m_s in (-1.0, 2.5):
            yield (("speed_m_s", (0, last - 1, 0), speed_m_s),), for_exit_speed(2, 35.0, 1.0)
            yield (), for_exit_speed(2, 15.0, 1.0)
        yield from rounded_beyond()
    yield (("is_measured", (), 0.0),), for_exit_speed(2, 10.0, 1.0)


def rounded_beyond() -> Iterator[Asked]:
    """Just before a node, where the part of the way is rounded to 1: low + (high - low) is beyond high, up and down."""
    before = float(np.nextafter(np.float32(1.5), np.float32(0.0)))
    axis = (("distance_m", (0,), -3.0), ("distance_m", (1,), 1.5))
    for below, above in (("0x1.b9f87p-3", "0x1.6b4c86p+1"), ("0x1.862136p+2", "0x1.1f0c22p-1")):
        speeds = (("speed_m_s", (0, 0, 0), float.fromhex(below)), ("speed_m_s", (0, 1, 0), float.fromhex(above)))
        yield (*axis, *speeds, ("lowest_m_s", (), 0.0)), for_exit_speed(2, before, 1.0)


def damaged(record: SizedRecord) -> Iterator[Asked]:
    """Sizes for which there is no room, and bounds that no speed of the table keeps."""
    asked, measured = for_exit_speed(2, 10.0, 1.0), (("is_measured", (), 1.0), ("distance_m", (0,), 10.0))
    for name in ("listed", "distances", "resistances"):
        for number in (0.0, record.room[name] + 1.0):
            yield ((name, (), number), *measured), asked
        yield ((name, (), 1.0), *measured), asked
        # Beyond a distance before which there is none.
        yield (), for_exit_speed(2, 35.0, 1.0)
    yield (("highest_m_s", (), 0.0),), asked
    yield (("highest_m_s", (), 9.0), ("lowest_m_s", (), 9.0)), asked


def for_exit_speed(cars: int, free_distance_m: float, resistance_n_per_kn: float) -> Mapping[str, float]:
    """The numbers that `exit_speed` takes."""
    return {"cars": cars, "free_distance_m": free_distance_m, "resistance_n_per_kn": resistance_n_per_kn}
