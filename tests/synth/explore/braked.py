"""What the tests of the page share.

Tables that brake cuts of the pilot plant often, and the plants of their classes.
The scripts of the page, run without it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from typing import Any

from plant_models import Approach, Plant, TrackProfile
from synth.retarder.configuration.config_file import load_config
from synth.retarder.estimation.estimator_design import estimator_of
from synth.retarder.explore.explore_page import Beside, PlayedTable, beside, part
from synth.retarder.sensors.passage_table import plausible_motion
from synth.retarder.served_class import PassageClass, ServedClass, sensors_of
from tests.controller_code.sample_book import FOUR_AXLES, table_of, with_slopes
from tests.in_javascript import told
from tests.synth.conftest import pilot_plant
from tests.tuning_tables.passages.made_tables import table_of as passages_of
from tuning_tables import Approach as TableApproach
from tuning_tables import ControllerTable, Decisions, ValidRange
from tuning_tables.controller_code.js_rules import JsRules
from tuning_tables.document import StageTable
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.sensor_layout import DecidesOn

STAGES = 5
LIMITS_T = (22.0, 28.0)
APPROACH_M = 4.0


def plant_of(table: ControllerTable) -> Plant:
    """The pilot plant on a track with two grades, with the approach of the table."""
    approach = Approach() if table.approach is None else Approach(APPROACH_M, 1, 1)
    return replace(pilot_plant(22.0), approach=approach, profile=TrackProfile((0.0, 11.0), (9.0, 6.0)))


def measured_table() -> ControllerTable:
    """Decides at rest on the measured speed."""
    return table_of("plain", "Л", 22.0, FOUR_AXLES, 3.0, stages=STAGES)


def approached_table() -> ControllerTable:
    """The same from before the entrance on, where no stage above 1 may be commanded."""
    table = measured_table()
    valid = ValidRange((-APPROACH_M, table.valid.s_m[1]), table.valid.v_m_s)
    return replace(table, valid=valid, approach=TableApproach(APPROACH_M, 1))


def estimating_table() -> ControllerTable:
    """Decides at rest on the estimated speed, from before the entrance on."""
    table = approached_table()
    return replace(table, estimator=estimator_of(plant_of(table)))


def any_time_table() -> ControllerTable:
    """Decides at every sample, by the pressure and the estimated speed."""
    return with_slopes(estimating_table(), -0.001, -0.0012)


def blind_table() -> ControllerTable:
    """Decides at every sample without a gauge."""
    return replace(measured_table(), decisions=Decisions.AT_ANY_TIME)


HEARD_ROWS = ((4.5, 6.0), (4.0, 5.25), (3.0, 4.5))
"""Of three stages; at every passage."""


def heard_table(decides_on: DecidesOn = DecidesOn.EVERY_AXLE) -> PassageTable:
    """Decides at passages over point sensors."""
    places = (-APPROACH_M, 1.0, 5.5, 10.0, 14.5, 19.0, 23.5)
    table = passages_of(decides_on, places, pilot_plant(22.0).cut.axle_offsets_m, HEARD_ROWS)
    return replace(table, plausible=plausible_motion(sensed_plant(table), sensors_of(table.sensors)))


def sensed_plant(table: PassageTable) -> Plant:
    """The same plant, whose regulator acts from the first sensor of the table on."""
    return replace(plant_of(measured_table()), approach=Approach(table.approach.length_m, 1))


TABLES: Mapping[str, Callable[[], ControllerTable]] = {
    "measured": measured_table,
    "estimated": estimating_table,
    "any time": any_time_table,
    "any time without gauge": blind_table,
}


def passes_beside(table: StageTable, served: ServedClass) -> Beside:
    """On few passes: pages show figures, whether they are good or not."""
    usual = load_config(None)
    return beside(table, served, replace(usual, validation=usual.validation.model_copy(update={"passes": 1000})))


@cache
def played(name: str, infeasible: bool = False) -> PlayedTable:
    """A table as the page takes it."""
    table = replace(TABLES[name](), id=name)
    served = ServedClass(f"class of {name}", plant_of(table))
    return PlayedTable(table, served, LIMITS_T, infeasible, passes_beside(table, served))


@cache
def played_passages() -> PlayedTable:
    """The table for point sensors as the page takes it."""
    table = replace(heard_table(), id="heard")
    served = PassageClass("class of heard", sensed_plant(table), sensors_of(table.sensors))
    return PlayedTable(table, served, LIMITS_T, False, passes_beside(table, served))


def told_by(rules: JsRules | None, scripts: tuple[str, ...], asking: str, given: Any) -> Any:
    """What `asking`, run behind the rules and these scripts of the page, tells."""
    return told("\n".join([rules.text if rules else "", *(part(name) for name in scripts), asking]), given)
