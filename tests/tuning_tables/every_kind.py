"""A small table of every kind and of every section that a table may have, and the ways through its document."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from tests.tuning_tables.aim.made_tables import category_table, measured_table, reported_of
from tests.tuning_tables.passages.made_tables import table_of
from tuning_tables import (
    Approach,
    ControllerTable,
    CutId,
    Decisions,
    Estimator,
    Generator,
    PassageTable,
    Predicted,
    RegulatorClock,
    RetarderId,
    Stage,
    Validated,
    ValidRange,
    to_json,
)
from tuning_tables.aim import AimAxes, AimTable
from tuning_tables.declared.members import Leaf, LeafMember, SectionMember, members_of
from tuning_tables.declared.numbers import Count, Number, Row
from tuning_tables.declared.texts import Text, Word
from tuning_tables.document import AnyTable
from tuning_tables.json_text import canonical_json, document_checksum
from tuning_tables.passages.sensor_layout import DecidesOn

Document = dict[str, Any]
JsonPath = tuple[str | int, ...]


def smallest_lines() -> ControllerTable:
    """Two stages with constant lines; numbers of every form that the two layouts write differently."""
    return ControllerTable(
        id="t",
        created="2026-01-01T00:00:00Z",
        generator=Generator("g", "1", "0" * 64),
        retarder=RetarderId("r", ((0.0, 1.0),), 1.0, 1e-7),
        cut=CutId("Л", 1e22, (0.0,)),
        target_speed_m_s=2.5,
        clock=RegulatorClock(sample_period_s=0.1, computing_delay_s=0.02),
        degree=0,
        stages=(Stage(0, 0.0, None, (4.0,)), Stage(1, 100.0, (2.0,), None)),
        valid=ValidRange((0.0, 1.0), (0.0, 9.0)),
        predicted=Predicted(0.00001, -0.5, 0.0, 123456789012345678.0),
        validated=Validated(1, 0.0, (0.0, 1e16)),
    )


def smallest_surfaces() -> ControllerTable:
    """The smallest table with slopes."""
    first, second = smallest_lines().stages
    stages = (replace(first, upper_slope_m_s_per_kpa=-0.5), replace(second, lower_slope_m_s_per_kpa=-(2.0**-24)))
    return replace(smallest_lines(), stages=stages, decisions=Decisions.AT_ANY_TIME)


def whole_lines() -> ControllerTable:
    """A table that has all that a table with lines may have."""
    breaks, drive, brake = (-0.5, 2.0, 5.0), (0.0, 0.132, 0.33), (0.0, 0.0, 0.008)
    return replace(
        smallest_surfaces(),
        cut=CutId("own", 22.0, (0.0, 1.85), 16),
        valid=ValidRange((-0.5, 1.0), (0.0, 9.0)),
        predicted=Predicted(0.1, 0.0, 0.0, 2.0, 0.25, passes=5000),
        estimator=Estimator(0.05, 0.15, 0.006, 0.1, 2.0, 7, 20, 0.2, 0.5, 60.0, breaks, drive, brake),
        approach=Approach(0.5, 0),
    )


def smallest_points() -> PassageTable:
    """Two stages, two sensors, one axle."""
    return table_of(places_m=(-0.5, 26.0), axles_m=(0.0,), rows=((3.0,), (2.5,)), pressures=(0.0, 1e-7))


def smallest_aim() -> AimTable:
    """Two cars, two distances, one null, numbers of other forms."""
    speeds = np.array([[0.5, np.nan], [1.0000001, 7.0]])
    axes = AimAxes(np.array([1, 2]), np.array([0.0, 1e3 / 3.0]))
    return replace(category_table(), axes=axes, exit_speed_m_s=speeds, reported=reported_of(speeds))


def smallest_measured() -> AimTable:
    """One number of cars, two distances, two resistances, one null."""
    speeds = np.array([[[1.0, 1.5], [np.nan, 2.0]]])
    axes = AimAxes(np.array([1]), np.array([10.0, 20.0]), np.array([0.5, 1.5]))
    return replace(measured_table(), axes=axes, exit_speed_m_s=speeds, reported=reported_of(speeds))


SAMPLES: Mapping[str, Callable[[], AnyTable]] = {
    "lines": smallest_lines,
    "surfaces": smallest_surfaces,
    "whole": whole_lines,
    "points": table_of,
    "every axle": lambda: replace(table_of(DecidesOn.EVERY_AXLE), validated=None),
    "smallest points": smallest_points,
    "aim": smallest_aim,
    "measured aim": smallest_measured,
}


def document_of(table: AnyTable) -> Document:
    """The document of `table`, as parsed from its text."""
    document: Document = json.loads(to_json(table))
    return document


def sealed(document: Document) -> bytes:
    """The text of `document` with a checksum and a layout that are right for it, so that only its content is judged."""
    return canonical_json({**document, "crc32": document_checksum(document)})


def places(value: Any, path: JsonPath = ()) -> Iterator[JsonPath]:
    """Every member and every entry of the document, as a path of keys and indices."""
    members = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, member in members:
        yield (*path, key)
        yield from places(member, (*path, key))


def value_at(document: Document, path: JsonPath) -> Any:
    """What stands at `path`."""
    value: Any = document
    for key in path:
        value = value[key]
    return value


def altered(document: Document, path: JsonPath, value: object) -> Document:
    """A copy of `document` with `value` at `path`."""
    changed = copy.deepcopy(document)
    value_at(changed, path[:-1])[path[-1]] = copy.deepcopy(value)
    return changed


def dotted(path: JsonPath) -> str:
    """A path as messages write it."""
    text = ""
    for key in path:
        text += f"[{key}]" if isinstance(key, int) else f".{key}"
    return text.removeprefix(".")


def leaves_of(declared: type, path: JsonPath = ()) -> Iterator[tuple[JsonPath, Leaf]]:
    """Every leaf that a class declares; of several sections those of the second, which all samples have."""
    for name, member in members_of(declared).items():
        match member:
            case LeafMember():
                yield (*path, name), member.leaf
            case SectionMember():
                yield from leaves_of(member.section, (*path, name))
            case _:
                yield from leaves_of(member.section, (*path, name, 1))


def too_far(leaf: Leaf) -> list[object]:
    """Values of the right type just outside the limits of `leaf`."""
    match leaf:
        case Row():
            return [[], *([value] * max(leaf.fewest, 1) for value in too_far(leaf.of))]
        case Count():
            return [leaf.least - 1, *([leaf.most + 1] if leaf.most < 2**53 else [])]
        case Number():
            found: list[object] = [0.0] if leaf.is_positive else []
            found += [] if leaf.least == -math.inf else [math.nextafter(leaf.least, -math.inf)]
            found += [] if leaf.most == math.inf else [math.nextafter(leaf.most, math.inf)]
            return found + ([0.1] if leaf.is_single else [])
        case Text():
            return ["", "two\nlines"]
        case Word():
            return ["other"]
    return []
