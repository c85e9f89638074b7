"""The page that plays a train of each run, in a browser as wide as a telephone: cuts at their places on one clock,
alarms, counters, labels, no error, nothing loaded."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections import Counter
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from synth.frame.page.document import script_safe
from synth.hump.compared_runs import MOST_CUTS
from synth.hump.rolling.outcomes import USUAL_COUPLINGS, outcomes
from synth.hump.trains.hump_page.hump_page import HUNDREDTHS, PlayedRun, differences, hump_page
from synth.hump.trains.train_trace import TrainTrace, train_trace
from tests.plant_models.rolling.populations import CATEGORIES
from tests.synth.hump.trains.humped_trains import HumpedTrains, humped_trains

CATEGORY_TYPES = CATEGORIES.members
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
SECONDS, SLID_S = 75.0, 120.0
FRAME_MS = 250
BEFORE_S = 3.0
MOST_PAGE_BYTES = 3e6
EVIL = "</script><script>throw 1</script><img src=x onerror=alert(1)> & \u2028"

PROBE = """
<script>
const out = {};
const at = (id) => document.getElementById(id);
const plans = () => [...document.querySelectorAll(".plan")];
const time = () => Number(plans()[0].dataset.time);
const cuts = () => plans().map((plan) => Object.fromEntries([...plan.querySelectorAll(".cut")].map((g) =>
  [g.dataset.cut, [Number(g.dataset.head), Number(g.dataset.speed), g.dataset.state]])));
const labels = () => plans().map((plan) => [...plan.querySelectorAll(".cut text, .told, .number[text-anchor=end]")]
  .filter((text) => text.textContent && text.getBBox().width > 0)
  .map((text) => [text.textContent, text.getBBox()])
  .map(([text, box]) => [text, box.x, box.x + box.width, box.y + box.height]));
const key = (name) => document.body.dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true }));
const chosen = (id, value) => { at(id).value = value; at(id).dispatchEvent(new Event("change")); };
const slide = (seconds) => { at("slider").value = seconds; at("slider").dispatchEvent(new Event("input")); };
out.first = { time: time(), cuts: cuts(), view: at("view").value, labels: labels() };
slide("SLID_S");
out.slid = { time: time(), cuts: cuts() };
slide(at("slider").min);
out.jumps = [];
const marks = [...at("marks").children];
for (let place = 0; place <= marks.length; place += 1) { key("n"); out.jumps.push([at("alarm").textContent, time()]); }
key("p");
out.back = at("alarm").textContent;
out.marks = marks.map((mark) => mark.title);
marks[0].focus();
marks[0].dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", bubbles: true }));
out.neighbour = [document.activeElement === marks[1], time()];
out.menu = at("train").selectedOptions[0].textContent;
out.meta = document.querySelector("p.meta").textContent;
slide(at("slider").max);
out.counted = [...document.querySelectorAll(".counted")].map((each) => each.textContent);
out.dots = plans().map((plan) => [...plan.querySelectorAll(".coupling")]
  .filter((dot) => dot.style.display === "" && dot.getAttribute("cx")).map((dot) => dot.getAttribute("fill")));
chosen("unit", "km/h");
out.in_km_h = at("runs").textContent + at("marks").lastChild.title + document.querySelector(".cuts").textContent;
out.remembered = localStorage.getItem("unit");
localStorage.clear();
chosen("view", "throat");
slide("SLID_S");
out.throat = labels();
const frames = [];  // the frames of a busy browser may never come: the probe gives its own
window.requestAnimationFrame = (drawn) => frames.push(drawn);
at("play").click();
for (const stamp of [0, FRAME_MS]) frames.shift()(stamp);
out.played = time();
out.rate = Number(at("rate").value);
at("play").click();
out.waiting = frames.length;
frames.shift()(2 * FRAME_MS);
out.paused = time();
out.asked = frames.length;
const told = document.createElement("pre");
told.id = "probe";
told.textContent = JSON.stringify(out);
document.body.append(told);
</script>
"""


@pytest.fixture(scope="module")
def humped() -> HumpedTrains:
    return humped_trains()


@pytest.fixture(scope="module")
def traces(humped: HumpedTrains) -> tuple[TrainTrace, TrainTrace]:
    one, other = (train_trace(humped.hump, humped.trains, humped.memory, lane) for lane in (0, 1))
    return one, other


Seen = dict[str, Any]
"""What the probe found in the page, and under `said` what the browser wrote."""


def in_browser(page: str, folder: Path, fragment: str) -> Seen:
    """The page with the probe in it, opened at `fragment`."""
    if CHROMIUM is None:
        pytest.skip("no Chromium on this machine")
    file = folder / "hump.html"
    probe = PROBE.replace("SLID_S", str(SLID_S)).replace("FRAME_MS", str(FRAME_MS))
    file.write_text(page.replace("</body>", probe + "</body>"), encoding="utf-8")
    options = ("--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr")
    command = [CHROMIUM, *options, "--window-size=500,900", "--dump-dom", f"file://{file}{fragment}"]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    (told,) = re.findall(r'<pre id="probe">(.*?)</pre>', ended.stdout, re.DOTALL)
    found = json.loads(told.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&"))
    return {**found, "said": ended.stderr}


def played(humped: HumpedTrains, name: str, *traces: TrainTrace) -> PlayedRun:
    """A run as a page plays it."""
    return PlayedRun(
        name,
        replace(humped.entry, title=EVIL),
        traces,
        (replace(CATEGORY_TYPES[0], name=EVIL, latin=EVIL), *CATEGORY_TYPES[1:]),
        USUAL_COUPLINGS,
    )


@pytest.fixture(scope="module")
def seen(humped: HumpedTrains, traces: tuple[TrainTrace, TrainTrace], tmp_path_factory: pytest.TempPathFactory) -> Seen:
    """Two runs, of which one plays the first train and the other one the second."""
    one, other = traces
    runs = (played(humped, "one", other, one), played(humped, EVIL, one, other))
    page = hump_page("Two runs", runs, ["other", EVIL])
    return in_browser(page, tmp_path_factory.mktemp("page"), f"#train=1&t={SECONDS}")


def test_the_console_is_silent_and_names_of_files_stay_text(seen: Seen) -> None:
    assert "CONSOLE" not in seen["said"]
    assert seen["menu"] == EVIL
    assert seen["meta"] == f"one: {EVIL}; {EVIL}: {EVIL}"


@pytest.mark.parametrize("moment", ["first", "slid"])
@pytest.mark.parametrize("run", [0, 1])
def test_cuts_are_where_the_trace_has_them(
    seen: Seen, traces: tuple[TrainTrace, TrainTrace], moment: str, run: int
) -> None:
    told, trace = seen[moment], traces[run]
    assert told["time"] == pytest.approx({"first": SECONDS, "slid": SLID_S}[moment], abs=0.1)
    rolling = 0
    for cut in trace.cuts:
        head, speed, state = told["cuts"][run][str(cut.cut + 1)]
        if told["time"] < cut.trace.time_s[0]:
            assert state == "waits"
            assert head <= 0.0
            continue
        assert head == pytest.approx(float(cut.trace.head_at(np.array(told["time"]))), abs=0.05)
        if told["time"] < cut.trace.time_s[-1]:
            expected = float(np.interp(told["time"], cut.trace.time_s, cut.trace.speed_m_s))
            assert speed == pytest.approx(expected, abs=0.03)
            rolling += state == "rolls"
        else:
            assert speed == 0.0
    assert rolling > 4


def test_cuts_that_wait_stand_one_behind_the_other(seen: Seen, traces: tuple[TrainTrace, TrainTrace]) -> None:
    cuts = seen["first"]["cuts"][0]
    waiting = [cut for cut in traces[0].cuts if cuts[str(cut.cut + 1)][2] == "waits"]
    heads = [cuts[str(cut.cut + 1)][0] for cut in waiting]
    assert len(waiting) > 2
    np.testing.assert_allclose(np.diff(heads), [-cut.length_m for cut in waiting[:-1]], atol=0.02)


def test_the_keys_go_through_all_severe_alarms_of_both_runs(seen: Seen, traces: tuple[TrainTrace, TrainTrace]) -> None:
    alarms = sorted((alarm.time_s, run, alarm.kind.severe) for run in (0, 1) for alarm in traces[run].alarms)
    severe = [(time_s, run) for time_s, run, is_severe in alarms if is_severe]
    assert len(severe) > 5
    for number, (time_s, run) in enumerate(severe):
        text, at_s = seen["jumps"][number]
        begin = f"Alarm {number + 1} of {len(severe)}. {('one', EVIL)[run]}, "
        assert text.startswith(begin)
        assert float(text.removeprefix(begin).split(" s: cut ")[0]) == pytest.approx(time_s, abs=0.06)
        assert at_s == pytest.approx(time_s - BEFORE_S, abs=0.02)
    assert all(jump == seen["jumps"][len(severe) - 1] for jump in seen["jumps"][len(severe) :])
    assert seen["back"] == seen["jumps"][len(severe) - 2][0]
    assert len(seen["marks"]) == len(alarms)
    assert seen["neighbour"][0]
    assert seen["neighbour"][1] == pytest.approx(alarms[1][0] - BEFORE_S, abs=0.02)


def test_counters_and_dots_end_as_the_outcomes_of_the_trains(
    seen: Seen, humped: HumpedTrains, traces: tuple[TrainTrace, TrainTrace]
) -> None:
    found = outcomes(humped.hump.routes, humped.trains, humped.memory)
    limits = (*USUAL_COUPLINGS.classes_m_s, np.inf)
    for run, trace in enumerate(traces):
        caught, over = found.caught[run], found.overspeed[run]
        text = f"{found.cars[run]} cars humped · {caught} cuts caught up · {over.sum()} couplings above 1.39 m/s"
        assert re.sub(r"\b1 (cut|coupling)\b", r"1 \1s", seen["counted"][run]) == text
        coupled = [cut.coupled_m_s for cut in trace.cuts if cut.coupled_m_s is not None]
        classes = Counter(int(np.searchsorted(limits, speed)) for speed in coupled)
        assert sorted(Counter(seen["dots"][run]).values()) == sorted(classes.values())
        assert [classes[place] for place in (1, 2, 3)] == list(over)


def test_all_speeds_are_told_in_the_unit_that_is_chosen(seen: Seen) -> None:
    assert "couplings above 5.00 km/h" in seen["in_km_h"]
    assert "m/s" not in seen["in_km_h"]
    assert seen["remembered"] == "km/h"


@pytest.mark.parametrize("moment", ["yard", "throat"])
def test_labels_do_not_lie_on_one_another(seen: Seen, moment: str) -> None:
    plans = {"yard": seen["first"]["labels"], "throat": seen["throat"]}[moment]
    assert seen["first"]["view"] == "yard"
    for labels in plans:
        assert sum(":" in text for text, *_ in labels) > 4
        for (one, left, right, y), (other, other_left, other_right, other_y) in combinations(labels, 2):
            apart = right < other_left + 1.0 or other_right < left + 1.0 or abs(y - other_y) > 8.0
            assert apart, (one, other)


def test_a_frame_plays_the_time_since_the_frame_before_and_a_pause_shows_no_later_one(seen: Seen) -> None:
    assert seen["rate"] > 0.0
    assert seen["played"] == pytest.approx(SLID_S + FRAME_MS / 1000 * seen["rate"], abs=0.1)
    assert (seen["waiting"], seen["asked"]) == (1, 0)
    assert seen["paused"] == seen["played"]


def test_the_page_loads_nothing_and_is_the_same_each_time(
    humped: HumpedTrains, traces: tuple[TrainTrace, TrainTrace]
) -> None:
    run = PlayedRun("", humped.entry, traces, CATEGORY_TYPES, USUAL_COUPLINGS)
    page = hump_page("One", (run,), ["first", "other"])
    assert page == hump_page("One", (run,), ["first", "other"])
    outside = re.findall(r"""(?:src|href)=|@import|url\(|fetch\(|https?://(?!www\.w3\.org/2000/svg)""", page)
    assert outside == []
    assert "default-src 'none'" in page
    with_one = hump_page("One", (replace(run, traces=traces[:1]),), ["first"])
    a_cut = (len(page) - len(with_one)) / len(traces[1].cuts)
    assert len(with_one) + MOST_CUTS * a_cut < MOST_PAGE_BYTES


def test_nothing_can_end_the_element_of_the_data() -> None:
    text = script_safe({"a": EVIL})
    assert "<" not in text
    assert json.loads(text) == {"a": EVIL}


def test_sums_of_the_steps_are_the_values() -> None:
    values = np.random.default_rng(1).uniform(0.0, 900.0, 400).cumsum()
    again = np.cumsum(differences(values)) / HUNDREDTHS
    assert np.abs(again - values).max() <= 0.5 / HUNDREDTHS + 1e-9
