"""The JSON Schema (draft 2020-12) of an aim table, for editors and for readers in other languages.

What it cannot state the reader checks beyond it: the checksum, that axes rise, that everything at the nodes has the
shape of the axes, that speeds lie within their bounds and do not fall, what is null, and that no key is given twice.
"""

from __future__ import annotations

from tuning_tables.aim.aim_table import LOWEST_M_S
from tuning_tables.aim.axes import (
    LARGEST_RESISTANCE_N_PER_KN,
    LONGEST_FREE_DISTANCE_M,
    MOST_CARS,
    MOST_NODES_OF_A_CUT,
    MOST_NUMBERS_OF_CARS,
)
from tuning_tables.aim.document import AIM_FORMAT, AIM_VERSION, CATEGORY_KIND, MEASURED_KIND
from tuning_tables.aim.purpose import FARTHEST_M, FASTEST_M_S
from tuning_tables.category_number import KNOWN_NUMBERS, LARGEST_OWN, LEAST_OWN
from tuning_tables.requirement import SHA256_HEX, UTC_INSTANT
from tuning_tables.schema_parts import DIALECT, array_of, number, object_of, pair_of, text, whole


def aim_schema() -> dict[str, object]:
    """A new dict with the JSON Schema of the format "aim-table", version 1."""
    speed = number(LOWEST_M_S, FASTEST_M_S)
    share = {"type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1}
    top = object_of(
        format={"const": AIM_FORMAT},
        version={"const": AIM_VERSION},
        id=text(),
        created={"type": "string", "pattern": UTC_INSTANT},
        generator=object_of(name=text(), version=text(), config_sha256={"type": "string", "pattern": SHA256_HEX}),
        position=object_of(name=text(), exit_at_m=number(0, FARTHEST_M)),
        category={**object_of(number=whole(1, LARGEST_OWN), name=text()), "oneOf": _categories()},
        required=object_of(p_overspeed=share, coupling_speed_m_s=speed),
        knowledge={"oneOf": [object_of(kind={"const": CATEGORY_KIND}), _measured()]},
        axes=object_of(
            cars=array_of(whole(1, MOST_CARS), 1, MOST_NUMBERS_OF_CARS),
            free_distance_m=array_of(number(0, LONGEST_FREE_DISTANCE_M), 1, MOST_NODES_OF_A_CUT),
            resistance_n_per_kn={"anyOf": [{"type": "null"}, _resistances()]},
        ),
        exit_speed_m_s=_nodes(speed),
        bounds=object_of(exit_speed_m_s=pair_of(speed)),
        interpolation=object_of(error_m_s=number(0, FASTEST_M_S)),
        reported=object_of(
            passes=whole(1),
            p_overspeed=_nodes(number(0, 1)),
            p_overspeed_low95=_nodes(number(0, 1)),
            p_overspeed_high95=_nodes(number(0, 1)),
            mean_gap_m=_nodes(number(0)),
        ),
        crc32={"type": "string", "pattern": "^[0-9a-f]{8}$"},
    )
    return {"$schema": DIALECT, "title": f"{AIM_FORMAT} {AIM_VERSION}", **top, "oneOf": _kinds()}


def _nodes(leaf: dict[str, object]) -> dict[str, object]:
    """Cars, free distances, and in a table by measured resistance resistances; null where there is no exit speed."""
    row = array_of({"anyOf": [{"type": "null"}, leaf, array_of({"anyOf": [{"type": "null"}, leaf]}, 1)]}, 1)
    return array_of(row, 1, MOST_NUMBERS_OF_CARS)


def _resistances() -> dict[str, object]:
    return array_of(number(-LARGEST_RESISTANCE_N_PER_KN, LARGEST_RESISTANCE_N_PER_KN), 1, MOST_NODES_OF_A_CUT)


def _measured() -> dict[str, object]:
    places = {"from_m": number(0, FARTHEST_M), "to_m": number(0, FARTHEST_M)}
    return object_of(kind={"const": MEASURED_KIND}, **places, speed_std_m_s=number(0, FASTEST_M_S))


def _categories() -> list[object]:
    """The number of a category of the yard, or that of a user's own."""
    own = {"name": {"not": {"enum": list(KNOWN_NUMBERS)}}, "number": whole(LEAST_OWN, LARGEST_OWN)}
    known = [{"name": {"const": name}, "number": {"const": number}} for name, number in KNOWN_NUMBERS.items()]
    return [{"properties": each} for each in (own, *known)]


def _kinds() -> list[object]:
    """Resistances have an axis exactly where they were measured."""
    kinds = ((CATEGORY_KIND, {"type": "null"}), (MEASURED_KIND, {"type": "array"}))
    return [
        {
            "properties": {
                "knowledge": {"properties": {"kind": {"const": kind}}},
                "axes": {"properties": {"resistance_n_per_kn": axis}},
            }
        }
        for kind, axis in kinds
    ]
