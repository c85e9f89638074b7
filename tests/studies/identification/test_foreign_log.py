"""A plant that the model does not contain: the tests say so, and a table for what was identified is better there."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from synth.logs import unknowns as asked
from synth.logs.fitting_passes import fitting_passes
from synth.logs.identified_config import identified
from synth.logs.identify import Identified, identify
from synth.retarder.configuration.config_file import ConfigSource, config_source, parse_config
from tests.studies.identification.coarse_table import coarse_table
from tests.studies.identification.conftest import MASSES_T, TARGET_M_S
from tests.studies.identification.foreign.foreign_log import foreign_exits, foreign_log
from tests.studies.identification.foreign.foreign_plant import ForeignPlant
from tuning_tables import ControllerTable

PASSES, SEED, EXITS = 100, 5, 500

CLASSES = "".join(
    f'[[cut]]\nlabel = "{label}"\ncar = "gondola-4"\nmass_t = {mass}\ntargets_m_s = [{TARGET_M_S}]\n'
    for label, mass in MASSES_T.items()
)

Found = tuple[Identified, ConfigSource]


@pytest.fixture(scope="module")
def found(assumed_tables: Mapping[str, ControllerTable], foreign_plants: Mapping[str, ForeignPlant]) -> Found:
    """What 200 passes of the foreign railway say."""
    source = ConfigSource("the assumed numbers", {**config_source(None).tree, **tree()}, config_source(None).library)
    config = source.resolved()
    log = foreign_log(assumed_tables, foreign_plants, PASSES, SEED)
    return identify(fitting_passes(log, config.plants(), "the assumed numbers"), config, 2), source


def tree() -> dict[str, object]:
    """The classes as a configuration has them."""
    import tomllib

    assert parse_config(CLASSES, "classes").cuts
    return tomllib.loads(CLASSES)


@pytest.mark.long
def test_the_tests_say_that_the_model_does_not_hold(found: Found) -> None:
    """Its friction falls with speed, and its drive fills by choked flow through a valve that opens slowly."""
    told = found[0]
    said = {test.effect.looks_for.split(":")[0] for test in told.wrong}
    assert "innovations of the gauge go together from reading to reading" in said
    (friction,) = (test for test in told.tests if test.effect.looks_for == "friction changes with speed")
    assert friction.interval[1] < 0.0


@pytest.mark.long
def test_a_table_for_what_was_identified_beats_the_assumed_one(
    found: Found,
    assumed_tables: Mapping[str, ControllerTable],
    foreign_plants: Mapping[str, ForeignPlant],
) -> None:
    """On the foreign railway itself, on the same cuts: mean square error of the exits, paired."""
    told, source = found
    new = identified(source, told.estimate, told.origin).resolved()
    assert new.retarder.friction.common_cv == pytest.approx(told.estimate.values[asked.COMMON_CV], rel=1e-5)
    plants = dict(new.plants())
    gains = []
    for label in ("empty", "half"):
        after = coarse_table(plants[label], TARGET_M_S)
        ends = [foreign_exits(t, foreign_plants[label], EXITS, SEED + 1) for t in (assumed_tables[label], after)]
        square = [np.where(e.stalled, TARGET_M_S, e.speed_m_s - TARGET_M_S) ** 2 for e in ends]
        gain = square[0] - square[1]
        gains.append(float(gain.mean() / (gain.std() / np.sqrt(EXITS))))
    assert min(gains) > 0.0
    assert sum(gains) / np.sqrt(len(gains)) > 2.0
