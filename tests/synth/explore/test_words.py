"""The words say what the rule does: its lines, its steps, and the pressure that is in the cylinders."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from synth.retarder.explore.plant_data import plant_data
from synth.retarder.served_class import sensors_of
from synth.simulation.closed_loop import close_loop
from synth.simulation.passage_loop import close_passage_loop
from synth.simulation.random_passes import random_passes
from synth.simulation.sampled_pass import drive_pressures_kpa
from tests.in_javascript import needs_javascript
from tests.synth.explore.braked import LIMITS_T, TABLES, estimating_table, heard_table, plant_of, sensed_plant, told_by
from tests.synth.explore.test_passes import cuts_of
from tuning_tables import ControllerTable, decide_for
from tuning_tables.controller_code.js_rules import js_passage_rules, js_rules

SCRIPTS = ("motion.js", "drive.js", "laws.js", "passes.js", "passages.js", "words.js", "passage_words.js")
TELLING = """
const { plant, table: values, cuts } = given, table = Rule.table(values), found = [];
const drive = Drive.drive(plant, table.at_any_time === 1, 1);
const setting = { massT: plant.mass_t, noiseMS: plant.sensor.noise_m_s, drive };
for (const [pass, each] of cuts.entries()) {
  const cut = { ...each, pathZ: floats(each.pathZ), noiseZ: floats(each.noiseZ) };
  Passes.run(plant, Laws.byTable(plant, table), setting, cut, (time, s, v, kpa, stage, question) => {
    if (!question) return;
    const steps = question.isAsked && question.known >= 0 ? Words.steps(table, question) : null;
    found.push({ pass, ...question, steps,
      told: Words.why(plant, table, { time, v, question }, (speed) => `${speed.toFixed(2)} m/s`, given.alarms) });
  });
}
tell(found);
"""


def questions_of(table: ControllerTable, count: int = 40, cut_factor: float | None = None) -> list[dict[str, Any]]:
    """All questions of some passes, with what is told of them; `cut_factor`: of all cuts, else drawn."""
    plant, rules = plant_of(table), js_rules([table])
    loop = close_loop(plant, len(table.stages))
    passes = random_passes(3, 0, count, loop.cells)
    cuts = cuts_of(plant, passes, loop.draws(passes).noise_z)
    given = {
        "plant": plant_data(plant, LIMITS_T, len(table.stages)),
        "table": rules.tables[0],
        "alarms": rules.alarms,
        "cuts": [{**cut, "factor": cut_factor or cut["factor"]} for cut in cuts],
    }
    found: list[dict[str, Any]] = told_by(rules, SCRIPTS, TELLING, given)
    return found


@needs_javascript
@pytest.mark.parametrize("name", TABLES)
def test_every_sentence_ends_with_what_the_rule_commands(name: str) -> None:
    table = TABLES[name]()
    questions = questions_of(table)
    commands = [each for each in questions if each["wanted"] != each["before"]]
    assert len(commands) > 50
    for each in questions:
        ends = f"So stage {each['wanted']} is commanded" if each in commands else "So nothing is commanded."
        if each["isAsked"]:
            assert each["told"][-1].startswith(ends)
            asked = decide_for(table, each["before"], each["s"], each["known"], each["pressureKpa"])
            assert each["wanted"] == asked
        else:
            assert "nothing is asked" in each["told"][-1]
            assert each["wanted"] == each["before"]


@needs_javascript
@pytest.mark.parametrize("name", TABLES)
def test_steps_lead_from_the_stage_in_force_to_the_one_that_is_commanded(name: str) -> None:
    table = TABLES[name]()
    for each in questions_of(table):
        if each["steps"] is None:
            continue
        *passed, last = each["steps"]
        direction = int(np.sign(each["wanted"] - each["before"]))
        assert [step["stage"] for step in passed] == list(range(each["before"], each["wanted"], direction or 1))
        assert all(step["answer"] == direction for step in passed)
        assert last["stage"] == each["wanted"]
        if table.decisions.value == "at_rest" and last["answer"] == direction != 0:
            pytest.fail("a table at rest goes on as long as it is answered alike")
        for step in each["steps"]:
            speed = np.float32(each["known"])
            answer = -1 if step["lower"] is not None and speed < step["lower"] else 0
            if answer == 0 and step["upper"] is not None and speed > step["upper"]:
                answer = 1 if each["s"] >= 0.0 or step["stage"] < table.entrance_stage else 0
            assert step["answer"] == answer


@needs_javascript
def test_an_alarm_of_the_table_is_told() -> None:
    table = estimating_table()
    limit = 1.0 + 1.5 * table.estimator.unlikely_deviation if table.estimator else 0.0
    found = {sentence for each in questions_of(table, 5, limit) for sentence in each["told"]}
    assert "Alarm: the brake works more on this cut than on any of its category." in found
    found = {sentence for each in questions_of(table, 5, 1.0) for sentence in each["told"]}
    assert not any(sentence.startswith("Alarm") for sentence in found)


@needs_javascript
def test_the_pressure_is_that_of_a_gauge_without_noise() -> None:
    table = estimating_table()
    plant = plant_of(table)
    questions = questions_of(table, 10)
    for number in range(10):
        mine = [each for each in questions if each["pass"] == number]
        stages = np.array([each["wanted"] for each in mine])
        theirs = drive_pressures_kpa(plant, len(table.stages), stages, np.array([0, len(mine)]))
        np.testing.assert_allclose([each["pressureKpa"] for each in mine], theirs, atol=1e-6)


HEARING = """
const { plant, room, cuts } = given, table = PassageRule.table(given.table), found = [];
const regulator = Passages.byTable(plant, table), drive = Drive.drive(plant, false, 1);
const setting = { massT: plant.mass_t, noiseS: plant.sensor.timer_noise_s, drive };
for (const each of cuts) {
  const cut = { ...each, pathZ: floats(each.pathZ), noiseZ: floats(each.noiseZ) };
  Passages.run(plant, regulator, setting, cut, (time, s, v, kpa, stage, question) => {
    if (!question) return;
    const { deciding, before } = question;
    const of = deciding < 0 ? [] : PassageWords.switching(table, room, deciding, before);
    const told = PassageWords.why(plant, table, room, { time, v, question }, (speed) => `${speed.toFixed(2)} m/s`);
    found.push({ ...question, of, told });
  });
}
tell(found);
"""


@needs_javascript
def test_words_of_a_pair_of_pulses_are_what_the_rule_does() -> None:
    table, rules = heard_table(), js_passage_rules([heard_table()])
    plant, sensors = sensed_plant(table), sensors_of(table.sensors)
    loop = close_passage_loop(plant, sensors, len(table.pressure_kpa))
    passes = random_passes(3, 0, 40, loop.radar.cells)
    given = {
        "plant": plant_data(plant, LIMITS_T, loop.stages, sensors),
        "room": dict(rules.room),
        "table": rules.tables[0],
        "cuts": cuts_of(plant, passes, loop.draws(passes).noise_z),
    }
    found = told_by(rules, SCRIPTS, HEARING, given)
    assert len([each for each in found if each["wanted"] != each["before"]]) > 50
    for each in found:
        before, wanted, speed = each["before"], each["wanted"], each["known"]
        ends = f"So stage {wanted} is commanded" if wanted != before else "So nothing is commanded."
        assert each["told"][-1].startswith(ends)
        if each["deciding"] < 0 or not each["isAsked"]:
            assert wanted == before
            continue
        highest = table.entrance_stage if each["deciding"] < table.before_entrance else len(table.pressure_kpa) - 1
        row = table.switching_m_s[each["deciding"], before, : max(before, highest)].astype(np.float32)
        assert [value for value, _ in each["of"]] == row.tolist()
        beyond = [stage for value, stage in each["of"] if (speed < value if stage < before else speed > value)]
        assert wanted == max(beyond, key=lambda stage: abs(stage - before), default=before)
