"""The plant in the page is Python's: the same random numbers give the same pass, event by event."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models import Plant, WeightForce
from synth.retarder.comparison.baselines import energy_rule
from synth.retarder.explore.explore_page import lines_data, played_controller
from synth.retarder.explore.plant_data import plant_data
from synth.retarder.served_class import sensors_of
from synth.simulation.closed_loop import ClosedLoop, TableController, close_loop
from synth.simulation.passage_controller import PassageTrace, of_table
from synth.simulation.passage_loop import PassageLoop, close_passage_loop
from synth.simulation.random_passes import RandomPasses, random_passes
from tests.in_javascript import needs_javascript, packed
from tests.synth.explore.braked import (
    LIMITS_T,
    STAGES,
    any_time_table,
    approached_table,
    blind_table,
    estimating_table,
    heard_table,
    measured_table,
    plant_of,
    sensed_plant,
    told_by,
)
from tuning_tables import Decisions
from tuning_tables.controller_code.js_rules import JsRules, js_passage_rules, js_rules
from tuning_tables.passages.sensor_layout import DecidesOn

PASSES, FEW = 1000, 150
SCRIPTS = ("motion.js", "drive.js", "laws.js", "passes.js", "passages.js")
ASKING = """
const { plant, table, lines, cuts, massT, noise, delayTimes } = given;
const regulator = lines ? Laws.byLines(plant, lines)
  : plant.sensor.passages ? Passages.byTable(plant, PassageRule.table(table)) : Laws.byTable(plant, Rule.table(table));
const drive = Drive.drive(plant, regulator.atAnyTime, delayTimes), { run } = plant.sensor.passages ? Passages : Passes;
tell(cuts.map((each) => {
  const cut = { ...each, pathZ: floats(each.pathZ), noiseZ: floats(each.noiseZ) }, events = [], heard = [];
  const exit = run(plant, regulator, { massT, noiseMS: noise, noiseS: noise, drive }, cut,
    (time, s, v, kpa, stage, question) => {
      events.push([time, s, v, kpa, stage]);
      if (question) heard.push([question.sensor ?? -1, question.heard ?? -1, question.wanted]);
    });
  return { exit, events, heard };
}));
"""


def silent(plant: Plant) -> Plant:
    """A third of the readings lost, in bursts."""
    return replace(plant, sensor=replace(plant.sensor, missed_share=0.3))


def closing(plant: Plant) -> Plant:
    """Valves that shut late."""
    pneumatics = replace(plant.position.pneumatics, closing_delay_s=0.004)
    return replace(plant, position=replace(plant.position, pneumatics=pneumatics))


def by_weight(plant: Plant) -> Plant:
    """A force in proportion to the load."""
    return replace(plant, position=replace(plant.position, force=WeightForce(0.0066, 50.0, (1.0, 0.9))))


def changed(plant: Plant, mass_t: float, noise_m_s: float, delay_times: float) -> Plant:
    """The plant as the sliders change it."""
    drive = plant.position.pneumatics
    delays = {
        name: getattr(drive, name) * delay_times for name in ("brake_delay_s", "touch_delay_s", "release_delay_s")
    }
    return replace(
        plant,
        cut=replace(plant.cut, mass_t=mass_t),
        sensor=replace(plant.sensor, noise_m_s=noise_m_s),
        position=replace(plant.position, pneumatics=replace(drive, **delays)),
    )


def cuts_of(plant: Plant, passes: RandomPasses, noise_z: NDArray[np.float32]) -> list[dict[str, Any]]:
    """The random numbers as the page takes them."""
    factor = plant.friction.cut_factor(passes.cut_z, plant.friction_cv)
    resistance = close_loop(plant, 2).resistance_n_kn(passes.resistance_u)
    entry = plant.entry.speed_m_s(passes.entry_u)
    return [
        {
            "factor": factor[i],
            "resistance": resistance[i],
            "entryMS": entry[i],
            "phase": passes.phase_u[i],
            "pathZ": packed(passes.path_z[i]),
            "noiseZ": packed(noise_z[i]),
        }
        for i in range(len(passes))
    ]


CASES = {
    "measured": (measured_table, plant_of, 22.0, 0.05, 1.0),
    "other mass, noise and delays": (measured_table, plant_of, 25.5, 0.11, 2.5),
    "estimated": (estimating_table, plant_of, 22.0, 0.05, 1.0),
    "estimated, readings lost": (estimating_table, lambda table: silent(plant_of(table)), 27.0, 0.05, 1.7),
    "late valves": (measured_table, lambda table: closing(plant_of(table)), 22.0, 0.05, 1.0),
    "force by weight": (measured_table, lambda table: by_weight(plant_of(table)), 28.0, 0.0, 0.5),
    "any time": (any_time_table, plant_of, 23.0, 0.05, 1.0),
    "any time, slow valves": (any_time_table, plant_of, 22.0, 0.08, 3.0),
    "any time without gauge": (blind_table, plant_of, 22.0, 0.05, 1.3),
}


@needs_javascript
@pytest.mark.parametrize("case", CASES)
def test_a_pass_is_that_of_python_event_by_event(case: str) -> None:
    table_of_case, plant_for, mass_t, noise_m_s, delay_times = CASES[case]
    table = table_of_case()
    nominal = plant_for(table)
    loop = close_loop(changed(nominal, mass_t, noise_m_s, delay_times), len(table.stages))
    rules = js_rules([table])
    given = {"plant": plant_data(nominal, LIMITS_T, loop.stages), "table": rules.tables[0]}
    setting = {"massT": mass_t, "noise": noise_m_s, "delayTimes": delay_times}
    compared(rules, given | setting, loop, TableController(table), sized_passes(case))


@needs_javascript
@pytest.mark.parametrize("decisions", Decisions)
@pytest.mark.parametrize("lead_s", [0.0, 0.3])
def test_a_baseline_is_that_of_python_event_by_event(decisions: Decisions, lead_s: float) -> None:
    plant = silent(plant_of(approached_table()))
    loop = close_loop(plant, STAGES)
    law = energy_rule(loop, 3.0, STAGES - 1, 0.9, 0.1, lead_s, 0.1)
    controller = played_controller(replace(law, decisions=decisions))
    given = {"plant": plant_data(plant, LIMITS_T, STAGES), "lines": lines_data(controller)}
    setting = {"massT": plant.cut.mass_t, "noise": plant.sensor.noise_m_s, "delayTimes": 1.0}
    compared(None, given | setting, loop, controller, PASSES if lead_s else FEW)


@needs_javascript
@pytest.mark.parametrize("decides_on", DecidesOn)
def test_a_pass_over_point_sensors_is_that_of_python_event_by_event(decides_on: DecidesOn) -> None:
    table, rules = heard_table(decides_on), js_passage_rules([heard_table(decides_on)])
    plant, sensors = sensed_plant(table), sensors_of(table.sensors)
    loop = close_passage_loop(plant, sensors, len(table.pressure_kpa))
    given = {"plant": plant_data(plant, LIMITS_T, loop.stages, sensors), "table": rules.tables[0]}
    setting = {"massT": plant.cut.mass_t, "noise": sensors.timer_noise_s, "delayTimes": 1.0}
    compared(
        rules,
        given | setting,
        loop,
        of_table(table, tracking=True),
        PASSES if decides_on is DecidesOn.EVERY_AXLE else FEW,
    )


def sized_passes(case: str) -> int:
    """The thousand passes for the two kinds of commands, fewer for their variants."""
    return PASSES if case in ("estimated", "any time") else FEW


def compared(
    rules: JsRules | None, given: dict[str, Any], loop: ClosedLoop | PassageLoop, controller: Any, count: int
) -> None:
    """The same passes by the page and by the closed loop."""
    plant = loop.plant
    radar = loop.radar if isinstance(loop, PassageLoop) else loop
    passes = random_passes(7, 0, count, radar.cells)
    draws, commands = loop.draws(passes), 0
    found = told_by(rules, SCRIPTS, ASKING, given | {"cuts": cuts_of(plant, passes, draws.noise_z)})
    for number, mine in enumerate(found):
        one = type(draws)._make(part[number : number + 1] for part in draws)
        trace, sample = loop.follow(controller, one), loop.run(controller, one)
        theirs = [trace.time_s, trace.path_m, trace.speed_m_s, trace.overpressure_kpa, trace.stage]
        events = np.column_stack(theirs)[:-1]
        assert len(mine["events"]) == len(events), f"pass {number}"
        np.testing.assert_allclose(np.array(mine["events"]), events, rtol=0.0, atol=1e-6, err_msg=f"pass {number}")
        assert mine["exit"]["exitMS"] == pytest.approx(sample.exit_speed_m_s[0], abs=1e-6)
        assert mine["exit"]["stalled"] == sample.stalled[0]
        assert mine["exit"]["commands"] == sample.switchings[0]
        commands += int(sample.switchings[0])
        if isinstance(trace, PassageTrace):
            heard = trace.readings
            assert mine["heard"] == np.column_stack([heard.told_sensor, heard.believed, heard.stage]).tolist()
    assert commands > 2 * count
