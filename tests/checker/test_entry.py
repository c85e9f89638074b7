"""The checker's entry speeds: drawn by itself, distributed as the plant's laws are."""

from __future__ import annotations

import json
from random import Random
from typing import Any

import numpy as np
import pytest

from plant_models import EntryLaw, EntrySpeed, HistogramEntrySpeed, NormalEntrySpeed
from synth.checker.drawn_cuts import Entry, Histogram, Normal, Uniform
from synth.checker.plant import UnusableConfigError, plant_of
from synth.retarder.configuration.config_file import parse_config

DRAWS = 40_000
CUT = '[[cut]]\ncar = "gondola-4"\nmass_t = 22\n'


@pytest.mark.parametrize(
    ("entry", "law"),
    [
        (Uniform(5.0, 6.5), EntrySpeed(5.0, 6.5)),
        (Normal(5.0, 6.5, 5.3, 0.6), NormalEntrySpeed(5.0, 6.5, 5.3, 0.6)),
        (Histogram((4.0, 5.0, 5.5, 6.0, 6.5), (0.0, 3.0, 0.0, 1.0)),
         HistogramEntrySpeed((4.0, 5.0, 5.5, 6.0, 6.5), (0.0, 3.0, 0.0, 1.0))),
    ],
    ids=["uniform", "normal", "histogram"],
)  # fmt: skip
def test_draws_have_the_distribution_of_the_law(entry: Entry, law: EntryLaw) -> None:
    random = Random(7)  # a thousandth of right laws would be called wrong, this seed is none of them
    drawn = np.sort([entry.draw(random) for _ in range(DRAWS)])
    expected = law.speed_m_s((np.arange(DRAWS) + 0.5) / DRAWS)
    steps = np.searchsorted(drawn, expected, side="right") / DRAWS
    distance = float(np.abs(steps - (np.arange(DRAWS) + 0.5) / DRAWS).max())
    assert distance < 1.95 / np.sqrt(DRAWS)  # Kolmogorov and Smirnov, 0.1 %


def plants(text: str) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """The canonical configuration of `text`, and its cuts."""
    config = json.loads(parse_config(text, "x.toml").canonical_json())
    return config, config["cut"]


def test_a_class_with_entry_speeds_of_its_own_is_read_with_them() -> None:
    own = CUT + 'label = "own"\nentry = { edges_m_s = [5, 5.5, 6], shares = [3, 1] }\n'
    config, cuts = plants("[entry]\nmean_m_s = 5.5\nstd_m_s = 0.4\n" + CUT + own)
    assert plant_of(config, cuts[0]).entry == Normal(5.0, 6.5, 5.5, 0.4)
    assert plant_of(config, cuts[1]).entry == Histogram((5.0, 5.5, 6.0), (3.0, 1.0))
    config, cuts = plants(CUT)
    assert plant_of(config, cuts[0]).entry == Uniform(5.0, 6.5)


@pytest.mark.parametrize(
    "entry",
    [
        {},
        5.0,
        {"low_m_s": 5.0},
        {"low_m_s": 5.0, "high_m_s": "6"},
        {"low_m_s": 5.0, "high_m_s": 6.0, "mean_m_s": 5.5},
        {"low_m_s": 5.0, "high_m_s": 6.0, "mean_m_s": 5.5, "std_m_s": 0.0},
        {"edges_m_s": [5.0, 6.0], "shares": [1.0, 2.0]},
        {"edges_m_s": [6.0, 5.0], "shares": [1.0]},
        {"edges_m_s": [5.0, 6.0], "shares": [0.0]},
        {"edges_m_s": [5.0, 6.0], "shares": [1.0], "low_m_s": 5.0},
    ],
)
def test_what_is_no_law_is_refused(entry: object) -> None:
    config, cuts = plants(CUT)
    with pytest.raises(UnusableConfigError, match="entry"):
        plant_of({**config, "entry": entry}, cuts[0])
    with pytest.raises(UnusableConfigError, match="entry"):
        plant_of(config, {**cuts[0], "entry": entry})


def test_a_law_that_hardly_ever_falls_between_its_limits_ends_all_the_same() -> None:
    assert Normal(5.0, 5.1, 20.0, 0.1).draw(Random(1)) == 5.1
