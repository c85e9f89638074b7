"""A position with two classes, its tables, and the same with less friction and a slow exhaust."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import pytest

from synth.frame.workers.engine import Teller
from synth.logs.identified_config import with_numbers
from synth.logs.retune.tuned_books import Case, class_setups, tuned_tables
from synth.retarder.configuration.config_file import ConfigSource, source_of_text
from synth.retarder.configuration.resolved_config import ResolvedConfig
from tests.corpus import Corpus
from tuning_tables import ControllerTable

CREATED = "2000-01-01T00:00:00Z"

TEXT = """
[position]
name = "knp-5-bunch"
[entry]
low_m_s = 4.5
high_m_s = 6.5
[targets]
exit_speeds_m_s = [3.0]
[validation]
passes = 1000
[[cut]]
label = "LS-1"
car = "gondola-4"
cars = 1
mass_t = 36.0
[[cut]]
label = "S-1"
car = "gondola-4"
cars = 1
mass_t = 52.0
"""

KNOWN_MEAN = f"[friction]\nmean_cv = 0.0\n{TEXT}"
"""Tables for it keep no reserve for another mean friction."""

COARSE = """
[grid]
path_step_m = 1.0
speed_step_m_s = 0.05
friction_scenarios = 3
resistance_scenarios = 1
"""
"""Enough for tables that are only to differ."""


@dataclass(frozen=True)
class Yard:
    """A configuration, as it is written and as it is, with its tables by case."""

    source: ConfigSource
    config: ResolvedConfig
    tables: Mapping[Case, ControllerTable]


def yard_of(source: ConfigSource) -> Yard:
    """`source`, tuned."""
    config = source.resolved()
    return Yard(source, config, tuned_tables(config, class_setups(config, CREATED), 2, Teller(lambda _: None)).whole)


@pytest.fixture(scope="session")
def assumed(corpus: Corpus) -> Yard:
    """What the library says."""
    return corpus.value("assumed yard", lambda: yard_of(source_of_text(TEXT + COARSE, "test")))


@pytest.fixture(scope="session")
def worn(assumed: Yard, corpus: Corpus) -> Yard:
    """Friction -30 %, exhaust constant +50 %, and tables tuned with that."""
    return corpus.value("worn yard", lambda: worn_yard(assumed, 0.7))


@pytest.fixture(scope="session")
def known(corpus: Corpus) -> Yard:
    """What the library says, with a mean friction that is taken as known."""
    return corpus.value("known yard", lambda: yard_of(source_of_text(KNOWN_MEAN, "test")))


@pytest.fixture(scope="session")
def worse(known: Yard, corpus: Corpus) -> Yard:
    """Friction -40 %, exhaust constant +50 %, and tables tuned with that."""
    return corpus.value("worse yard", lambda: worn_yard(known, 0.6))


def worn_yard(assumed: Yard, friction: float) -> Yard:
    """So much of the friction, exhaust constant +50 %, and tables tuned with that."""
    known = {each.key: each.value for each in assumed.config.parameters}
    slope, exhaust = "retarder.force.slope_kn_per_kpa", "retarder.pneumatics.exhaust_time_constant_s"
    old = known[slope], known[exhaust]
    assert isinstance(old[0], float)
    assert isinstance(old[1], float)
    worse = {slope: friction * old[0], exhaust: 1.5 * old[1]}
    return yard_of(with_numbers(assumed.source, worse, "truth", lambda _: "truth"))
