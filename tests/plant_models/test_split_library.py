"""Types and positions together hold the numbers that one file a position held before the library was split."""

import hashlib
import json

import pytest

from plant_models.library import BUILT_IN, RETARDERS, SourcedValue, load_position, position_names
from plant_models.library.position_entry import MEAN_CV, REGULATOR
from plant_models.library.retarder_entry import DAY_SPREAD, retarder_from

LOSSES = ("sensor.missed_share", "sensor.missed_burst_s")

BEFORE = {
    "knp-5-bunch": "136d4aeecccac776d56d325a8124c26c0d9205dd269f3c914c4c9197ac97b699",
    "kv-3-bunch": "3a88034f78f0c3d5e1b828d425e3f537afc313e6fbd166a77f66b6bd43c7a328",
    "rnz-2m-park": "e978c12025a4e79ac69c89f06a39ec3efaa35ec775ec0b2aa7d742a54ac4689b",
    "t-50-bunch": "a2aa383ace06923f87cb0a8130e30b03e85deda5bf46049ae8592d5a64793b09",
    "vzpg-5-bunch": "cef24aed5fb7e31dcfeaa04c946c6da6cd4363f7a479d7185111c1f84eca73d6",
}
"""SHA-256 of key, value, unit, range, source and confidence of every number, taken at commit 0514bc8.

Who changes a number, its source or its range on purpose takes the position out of this list.
"""


def before(name: str) -> list[SourcedValue]:
    """The numbers of a position, but for approach, spreads from day to day, and losses, which came later."""
    later = {*REGULATOR, MEAN_CV, DAY_SPREAD, *LOSSES}
    return [value for value in load_position(name).provenance if value.key not in later]


@pytest.mark.parametrize("name", BEFORE)
def test_every_number_and_its_origin_is_what_it_was(name: str) -> None:
    rows = [[v.key, v.value, v.unit, v.range, v.source, v.confidence] for v in before(name)]
    text = json.dumps(rows, ensure_ascii=False, separators=(",", ":"))
    assert hashlib.sha256(text.encode()).hexdigest() == BEFORE[name]


def test_zones_follow_from_places_and_length_to_the_bit() -> None:
    zones = {name: load_position(name).position.zones_m for name in position_names()}
    assert zones["knp-5-bunch"] == zones["kv-3-bunch"] == ((0.0, 12.475), (14.475, 26.95))
    assert zones["vzpg-5-bunch"] == zones["t-50-bunch"] == ((0.0, 12.5), (14.5, 27.0))
    assert zones["rnz-2m-park"] == ((0.0, 3.0), (4.0, 7.0), (8.0, 11.0))
    assert retarder_from(BUILT_IN.file(RETARDERS, "rnz-2m")).length_m == 3.0
