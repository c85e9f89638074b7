"""The plant in the page is Python's: the same random numbers give the same pass, event by event."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models import Plant, WeightForce
from synth.retarder.explore.plant_data import plant_data
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.random_passes import RandomPasses, random_passes
from tests.in_javascript import needs_javascript, packed
from tests.synth.explore.braked import LIMITS_T, any_time_table, blind_table, estimating_table, measured_table, plant_of
from tests.synth.explore.scripts_of_page import told_by
from tuning_tables import ControllerTable
from tuning_tables.controller_code.js_rules import js_rules

PASSES = 1000
SCRIPTS = ("motion.js", "drive.js", "passes.js")
ASKING = """
const { plant, table: values, cuts, massT, noiseMS, delayTimes } = given, table = Rule.table(values);
const drive = Drive.drive(plant, table.at_any_time === 1, delayTimes);
tell(cuts.map((each) => {
  const cut = { ...each, pathZ: floats(each.pathZ), noiseZ: floats(each.noiseZ) }, events = [];
  const exit = Passes.run(plant, table, { massT, noiseMS, drive }, cut,
    (time, s, v, kpa, stage) => events.push([time, s, v, kpa, stage]));
  return { exit, events };
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
    found, expected = both(table_of_case(), plant_for, mass_t, noise_m_s, delay_times, sized_passes(case))
    assert np.mean([commands for _, _, _, commands in expected]) > 2.0
    for number, (mine, (events, exit_speed, stalled, commands)) in enumerate(zip(found, expected, strict=True)):
        assert len(mine["events"]) == len(events), f"pass {number}"
        np.testing.assert_allclose(np.array(mine["events"]), events, rtol=0.0, atol=1e-6, err_msg=f"pass {number}")
        assert mine["exit"]["exitMS"] == pytest.approx(exit_speed, abs=1e-6)
        assert mine["exit"]["stalled"] == stalled
        assert mine["exit"]["commands"] == commands


def sized_passes(case: str) -> int:
    """The thousand passes for the two kinds of commands, fewer for their variants."""
    return PASSES if case in ("estimated", "any time") else 150


def both(
    table: ControllerTable,
    plant_for: Callable[[ControllerTable], Plant],
    mass_t: float,
    noise_m_s: float,
    delay_times: float,
    count: int,
) -> tuple[list[Any], list[Any]]:
    """The same passes by the page and by the closed loop."""
    nominal = plant_for(table)
    plant = changed(nominal, mass_t, noise_m_s, delay_times)
    loop = close_loop(plant, len(table.stages))
    passes = random_passes(7, 0, count, loop.cells)
    draws, controller = loop.draws(passes), TableController(table)
    rules = js_rules([table])
    given = {
        "plant": plant_data(nominal, LIMITS_T, len(table.stages)),
        "table": rules.tables[0],
        "cuts": cuts_of(plant, passes, draws.noise_z),
        "massT": mass_t,
        "noiseMS": noise_m_s,
        "delayTimes": delay_times,
    }
    expected = []
    for i in range(count):
        one = type(draws)._make(part[i : i + 1] for part in draws)
        trace, sample = loop.follow(controller, one), loop.run(controller, one)
        events = np.column_stack([trace.time_s, trace.path_m, trace.speed_m_s, trace.overpressure_kpa, trace.stage])[
            :-1
        ]
        expected.append((events, sample.exit_speed_m_s[0], bool(sample.stalled[0]), int(sample.switchings[0])))
    return told_by(rules, SCRIPTS, ASKING, given), expected
