"""The page that plays a train, in a browser: cuts at their places, slider, alarms, no error, nothing loaded."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from synth.hump.trains.hump_page.hump_page import hump_page, script_safe
from synth.hump.trains.hump_page.train_data import HUNDREDTHS, differences
from synth.hump.trains.train_trace import TrainTrace, train_trace
from tests.plant_models.rolling.populations import CATEGORIES
from tests.synth.hump.trains.humped_trains import HumpedTrains, humped_trains

NAMES = tuple(category.name for category in CATEGORIES.members)
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
SECONDS, SLID_S = 75.0, 120.0
FRAME_MS = 250
EVIL = "</script><script>throw 1</script><img src=x onerror=alert(1)> & \u2028"

PROBE = """
<script>
const out = {};
const cuts = () => Object.fromEntries([...document.querySelectorAll("#plan .cut")].map((g) =>
  [g.dataset.cut, [Number(g.dataset.head), Number(g.dataset.speed), g.dataset.state]]));
out.first = { time: Number(document.getElementById("plan").dataset.time), cuts: cuts() };
const slider = document.getElementById("slider");
slider.value = "SLID_S";
slider.dispatchEvent(new Event("input"));
out.slid = { time: Number(document.getElementById("plan").dataset.time), cuts: cuts() };
const alarm = document.querySelector("#alarms li:not(.pale) button");
alarm.click();
out.alarm = { text: alarm.textContent, time: Number(document.getElementById("plan").dataset.time) };
out.drawn = document.querySelectorAll("#plan .cut polyline[points]").length;
out.menu = document.getElementById("train").selectedOptions[0].textContent;
out.passes = document.querySelectorAll("#passes tr").length;
out.title = document.querySelector("p.meta").textContent;
document.getElementById("view").value = "yard";
document.getElementById("view").dispatchEvent(new Event("change"));
out.yard = document.querySelectorAll("#plan .cut").length;
const frames = [];  // the frames of a busy browser may never come: the probe gives its own
window.requestAnimationFrame = (drawn) => frames.push(drawn);
document.getElementById("play").click();
for (const stamp of [0, FRAME_MS]) frames.shift()(stamp);
out.played = Number(document.getElementById("plan").dataset.time);
out.rate = Number(document.getElementById("rate").value);
document.getElementById("play").click();
out.waiting = frames.length;
frames.shift()(2 * FRAME_MS);
out.paused = Number(document.getElementById("plan").dataset.time);
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
def trace(humped: HumpedTrains) -> TrainTrace:
    return train_trace(humped.hump, humped.trains, humped.memory, 0)


Seen = tuple[dict[str, Any], str]
"""What the probe found in the page, and what the browser said."""


def in_browser(page: str, folder: Path, fragment: str) -> Seen:
    """The page with the probe in it, opened at `fragment`."""
    if CHROMIUM is None:
        pytest.skip("no Chromium on this machine")
    file = folder / "hump.html"
    probe = PROBE.replace("SLID_S", str(SLID_S)).replace("FRAME_MS", str(FRAME_MS))
    file.write_text(page.replace("</body>", probe + "</body>"), encoding="utf-8")
    options = ("--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr")
    command = [CHROMIUM, *options, "--window-size=1400,900", "--dump-dom", f"file://{file}{fragment}"]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    (told,) = re.findall(r'<pre id="probe">(.*?)</pre>', ended.stdout, re.DOTALL)
    return json.loads(told.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")), ended.stderr


@pytest.fixture(scope="module")
def seen(humped: HumpedTrains, trace: TrainTrace, tmp_path_factory: pytest.TempPathFactory) -> Seen:
    evil = replace(humped.entry, title=EVIL)
    other = train_trace(humped.hump, humped.trains, humped.memory, 1)
    page = hump_page(evil, {"other": other, EVIL: trace}, [EVIL, *NAMES[1:]])
    return in_browser(page, tmp_path_factory.mktemp("page"), f"#train=1&t={SECONDS}")


def test_the_console_is_silent(seen: Seen) -> None:
    assert "CONSOLE" not in seen[1]


@pytest.mark.parametrize("moment", ["first", "slid"])
def test_cuts_are_where_the_trace_has_them(seen: Seen, trace: TrainTrace, moment: str) -> None:
    told = seen[0][moment]
    assert told["time"] == pytest.approx({"first": SECONDS, "slid": SLID_S}[moment], abs=0.1)
    rolling = 0
    for cut in trace.cuts:
        head, speed, state = told["cuts"][str(cut.cut + 1)]
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


def test_cuts_that_wait_stand_one_behind_the_other(seen: Seen, trace: TrainTrace) -> None:
    cuts = seen[0]["first"]["cuts"]
    waiting = [cut for cut in trace.cuts if cuts[str(cut.cut + 1)][2] == "waits"]
    heads = [cuts[str(cut.cut + 1)][0] for cut in waiting]
    assert len(waiting) > 2
    np.testing.assert_allclose(np.diff(heads), [-cut.length_m for cut in waiting[:-1]], atol=0.02)


def test_a_click_on_an_alarm_goes_there(seen: Seen, trace: TrainTrace) -> None:
    first = next(alarm for alarm in trace.alarms if alarm.kind.severe)
    told = seen[0]["alarm"]
    assert told["time"] == pytest.approx(first.time_s - 3.0, abs=0.02)
    assert told["text"].startswith(f"{first.time_s:.1f} s: cut {first.cut + 1} misrouted behind cut")


def test_all_is_drawn_in_both_views(seen: Seen, trace: TrainTrace) -> None:
    told = seen[0]
    assert told["drawn"] == told["yard"] == len(trace.cuts)
    assert told["passes"] > 0


def test_a_frame_plays_the_time_since_the_frame_before(seen: Seen) -> None:
    told = seen[0]
    assert told["rate"] > 0.0
    assert told["played"] == pytest.approx(told["alarm"]["time"] + FRAME_MS / 1000 * told["rate"], abs=0.02)


def test_a_pause_shows_no_later_time_and_asks_for_no_frame(seen: Seen) -> None:
    told = seen[0]
    assert told["waiting"] == 1
    assert told["paused"] == told["played"]
    assert told["asked"] == 0


def test_names_of_files_stay_text(seen: Seen) -> None:
    assert seen[0]["title"] == seen[0]["menu"] == EVIL


def test_the_page_loads_nothing_and_is_the_same_each_time(humped: HumpedTrains, trace: TrainTrace) -> None:
    page = hump_page(humped.entry, {"first": trace}, NAMES)
    assert page == hump_page(humped.entry, {"first": trace}, NAMES)
    outside = re.findall(r"""(?:src|href)=|@import|url\(|fetch\(|https?://(?!www\.w3\.org/2000/svg)""", page)
    assert outside == []
    assert "default-src 'none'" in page
    assert len(page.encode()) * 40 / len(trace.cuts) < 2e6


def test_nothing_can_end_the_element_of_the_data() -> None:
    text = script_safe({"a": EVIL})
    assert "<" not in text
    assert json.loads(text) == {"a": EVIL}


def test_sums_of_the_steps_are_the_values() -> None:
    values = np.random.default_rng(1).uniform(0.0, 900.0, 400).cumsum()
    again = np.cumsum(differences(values)) / HUNDREDTHS
    assert np.abs(again - values).max() <= 0.5 / HUNDREDTHS + 1e-9
