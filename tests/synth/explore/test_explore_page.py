"""The page in a browser: what it shows is what the scripts say, and nothing is loaded."""

from __future__ import annotations

import json
import re
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from synth.retarder.explore.explore_page import explore_page
from synth.retarder.explore.plant_data import plant_data
from synth.retarder.served_class import ServedClass
from tests.in_javascript import CHROMIUM, needs_javascript
from tests.synth.explore.braked import LIMITS_T, TABLES, played, played_passages, told_by
from tuning_tables.controller_code.js_rules import js_rules

EVIL = "</script><script>throw 1</script><img src=x onerror=alert(1)> & \u2028"
MOST_MS = 100.0
FRAGMENT = "#table=estimated&mass=25&factor=1.1&noise=0.02&seed=7&at=31&entry=nonsense&unknown=1"

PROBE = """
<script>
(async () => {
const out = {};
const at = (id) => document.getElementById(id);
const text = (id) => at(id).textContent;
const pause = (ms) => new Promise((done) => setTimeout(done, ms));
const key = (name) => document.body.dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true }));
const slide = (id, value) => { at(id).value = value; at(id).dispatchEvent(new Event("input")); };
const choose = (id, value) => { at(id).value = value; at(id).dispatchEvent(new Event("change")); };
const SLIDERS = ["entry", "factor", "resistance", "seed", "mass", "noise", "delay"];
const values = () => SLIDERS.map((id) => Number(at(id).value));
const dark = (id) => {
  const { width, height } = at(id), { data } = at(id).getContext("2d").getImageData(0, 0, width, height);
  return data.some((value) => value !== 0);
};
await pause(50);
out.menu = [...at("table").options].map((option) => option.textContent);
const moment = () => Number(at("moment").value);
out.first = { table: at("table").selectedIndex, values: values(), moment: moment() };
out.exit = [text("exit"), text("exit-more")];
out.why = [...at("why").children].map((each) => each.textContent);
out.differs = text("differs");
out.figures = [...at("figures").rows].map((row) => [...row.cells].map((cell) => cell.textContent));
out.drawn = [...document.querySelectorAll("canvas")].map(({ id }) => dark(id));
out.rule = { who: text("rule-who"), exit: text("rule-exit-more"), about: text("about") };
out.titles = [...at("figure-head").cells].map((cell) => cell.textContent);
out.width = [document.documentElement.scrollWidth, window.innerWidth];
slide("entry", 5.9);
await pause(400);
out.link = location.hash;
choose("unit", "km/h");
out.in_km_h = [text("exit-more"), text("why")];
key("ArrowRight");
out.moved = moment();
slide("moment", 0);
out.commands = [];
for (let step = 0; step < 3; step += 1) { key("n"); out.commands.push([moment(), at("why").lastChild.textContent]); }
key("p");
out.back = moment();
key("s");
out.seed = Number(at("seed").value);
key("r");
await pause(50);
out.reset = [values(), text("differs")];
choose("table", at("table").options[2].value);
await pause(50);
out.other = [at("table").selectedIndex, text("exit")];
choose("table", at("table").options[4].value);
await pause(100);
out.heard = { exit: text("exit-more"), why: at("why").lastChild.textContent, about: text("about") };
out.heard.hidden = ["rule-panel", "rule-many"].map((id) => at(id).hidden);
out.heard.sliders = ["noise", "timer"].map((id) => !at(id).parentNode.hidden);
slide("timer", 0.5);
await pause(400);
out.heard.link = location.hash;
choose("table", at("table").options[0].value);
choose("passes", "1000");
await pause(1500);
out.many = [at("figure-head").cells[1].textContent, location.hash];
const told = document.createElement("pre");
told.id = "probe";
told.textContent = JSON.stringify(out);
document.body.append(told);
})();
</script>
"""

TIMING = """
<script>
const slider = document.getElementById("entry"), told = document.createElement("pre");
const times = [5.2, 6.1, 5.6, 6.4, 5.9].map((entry) => {
  const begun = performance.now();
  slider.value = entry;
  slider.dispatchEvent(new Event("input"));
  return [performance.now() - begun, document.getElementById("exit-more").textContent];
});
told.id = "probe";
told.textContent = JSON.stringify({ times });
document.body.append(told);
</script>
"""

ONE = """
const { plant, table: values, setting } = given, table = Rule.table(values);
const cut = { ...Draws.cut(plant, setting.seed, 0), factor: setting.factor };
cut.entryMS = plant.laws.entry[plant.laws.entry.length / 2 - 0.5];
cut.resistance = plant.laws.resistance_mean;
const drive = Drive.drive(plant, table.at_any_time === 1, 1);
tell(Passes.run(plant, Laws.byTable(plant, table), { massT: setting.mass, noiseMS: setting.noise, drive }, cut));
"""


def page() -> str:
    """Five tables, one of them infeasible, one for point sensors."""
    tables = [*(played(name, infeasible=name == "measured") for name in TABLES), played_passages()]
    return explore_page(EVIL, EVIL, [replace(tables[0], served=ServedClass(EVIL, tables[0].served.plant)), *tables[1:]])


def in_browser(folder: Path, probe: str, *options: str) -> dict[str, Any]:
    """What the probe found, on a telephone's width, and under `said` what the browser wrote."""
    if CHROMIUM is None:
        pytest.skip("no Chromium on this machine")
    file = folder / "explore.html"
    file.write_text(page().replace("</body>", probe + "</body>"), encoding="utf-8")
    usual = ("--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--window-size=500,900")
    command = [CHROMIUM, *usual, *options, "--dump-dom", f"file://{file}{FRAGMENT}"]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    (found,) = re.findall(r'<pre id="probe">(.*?)</pre>', ended.stdout, re.DOTALL)
    return {**json.loads(found.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")), "said": ended.stderr}


@pytest.fixture(scope="module")
def seen(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The page as a user works on it; the browser's own clock leaps to what a probe waits for."""
    return in_browser(tmp_path_factory.mktemp("page"), PROBE, "--virtual-time-budget=60000")


def test_the_console_is_silent_and_names_of_files_stay_text(seen: dict[str, Any]) -> None:
    assert "CONSOLE" not in seen["said"]
    assert seen["menu"][0] == f"{EVIL} to 3 m/s, infeasible by its tune"
    assert seen["menu"][1] == "class of estimated to 3 m/s"


def test_the_link_sets_what_it_names_and_what_is_no_number_stays(seen: dict[str, Any]) -> None:
    assert seen["first"]["table"] == 1
    assert seen["first"]["values"] == [5.75, 1.1, 1.75, 7, 25, 0.02, 1]
    assert seen["first"]["moment"] == 31
    assert "table=estimated" in seen["link"]
    assert "mass=25.000" in seen["link"]
    assert "entry=5.900" in seen["link"]
    assert "delay" not in seen["link"]


@needs_javascript
def test_the_exit_is_that_of_the_scripts(seen: dict[str, Any]) -> None:
    one = played("estimated")
    rules = js_rules([make() for make in TABLES.values()])
    given = {
        "plant": plant_data(one.served.plant, LIMITS_T, one.stages),
        "table": rules.tables[list(TABLES).index("estimated")],
        "setting": {"mass": 25.0, "factor": 1.1, "noise": 0.02, "seed": 7},
    }
    exit_ = told_by(rules, ("motion.js", "drive.js", "laws.js", "passes.js", "draws.js"), ONE, given)
    error, more = seen["exit"]
    ends = f"; {exit_['commands']} commands, {exit_['time']:.1f} s"
    assert more == f"exit {exit_['exitMS']:.2f} m/s, target 3.00 m/s{ends}"
    assert error == f"Error {exit_['exitMS'] - 3.0:+.2f} m/s".replace("-", "−")


def test_all_is_drawn_and_fits_a_telephone(seen: dict[str, Any]) -> None:
    assert seen["drawn"] == [True] * 6
    scrolled, width = seen["width"]
    assert scrolled <= width


def test_the_exit_is_told_at_once_when_a_slider_moves(tmp_path: Path) -> None:
    times = in_browser(tmp_path, TIMING)["times"]
    assert 0.0 < min(milliseconds for milliseconds, _ in times) < MOST_MS
    assert len({exit_ for _, exit_ in times}) > 1


def test_figures_of_table_and_rule_stand_beside_those_of_simulated_passes(seen: dict[str, Any]) -> None:
    beside = played("estimated").beside
    assert beside is not None
    assert beside.rule is not None
    law, exits = beside.rule
    titles = [f"{who}, {of}" for of in ("100 cuts here", "1000 simulated") for who in ("this table", law.name)]
    assert seen["titles"] == ["figure", *titles]
    rows = {name: cells for name, *cells in seen["figures"]}
    rms = rows["rms of the exit error, m/s"]
    for cell in rms[:2]:
        assert re.fullmatch(r"\d\.\d{4} of these cuts", cell)
    for cell, found in zip(rms[2:], (beside.table.statistics, exits.statistics), strict=True):
        low, high = found.rms_ci95_m_s
        assert cell == f"{found.rms_m_s:.4f} [{low:.4f}, {high:.4f}]"
    assert re.fullmatch(r"\d\.\d{4} \[\d\.\d{4}, \d\.\d{4}\]", rows["95 of 100 leave within ±, m/s"][0])
    one, other = (float(cell.split(" ")[0]) for cell in rows["leaves nearer to the target than beside"][:2])
    assert one + other == pytest.approx(100.0)
    assert seen["rule"]["who"] == f"{law.name}, the best classical rule"
    assert f"the {law.name} is the better one" in seen["rule"]["about"]
    assert seen["differs"].startswith("Mass, noise or delays are not those of the configuration")
    assert seen["reset"][1] == ""
    title, link = seen["many"]
    assert title == "this table, 1000 cuts here"
    assert link.endswith("cuts=1000")


def test_a_table_for_point_sensors_is_played_alone(seen: dict[str, Any]) -> None:
    heard = seen["heard"]
    assert heard["exit"].startswith("exit ")
    assert heard["why"].startswith("So ")
    assert heard["hidden"] == [True, True]
    assert "No classical rule is tuned for point sensors" in heard["about"]
    assert heard["sliders"] == [False, True]
    assert "timer=0.500" in heard["link"]


def test_words_follow_the_moment_and_the_unit(seen: dict[str, Any]) -> None:
    assert seen["why"][0].endswith(("retarder 1.", "retarder 2.", "between two retarders.", "before the entrance."))
    assert "target 10.80 km/h" in seen["in_km_h"][0]
    assert " m/s" not in seen["in_km_h"][1]
    assert seen["moved"] == 32
    (one, first), (two, second), _ = seen["commands"]
    assert 0 <= one < two
    assert first.startswith("So stage ")
    assert second.startswith("So stage ")
    assert seen["back"] == two
    assert seen["seed"] == 8
    assert seen["other"][0] == 2


def test_equal_tables_give_equal_text_and_a_small_one() -> None:
    assert page() == page()
    assert len(page()) < 300_000
    assert "http" not in re.sub(r"http-equiv", "", page())
