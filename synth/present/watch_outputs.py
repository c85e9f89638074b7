"""What a watch leaves: `watch.json`, `charts.csv`, its picture and a report."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from importlib.metadata import version
from typing import Any

from synth.book.summary import plain
from synth.configuration.resolved_config import ResolvedConfig
from synth.frame.page.document import Stamp, document, figure
from synth.frame.page.markup import Markup, element, head_row, joined, table
from synth.frame.picture.figure_file import draw
from synth.frame.picture.picture import Picture, picture_files
from synth.frame.results_directory import ResultsDirectory
from synth.present.plots.control_charts import control_charts
from synth.yard.measured_passes.drift.charts import RUN_LENGTH
from synth.yard.measured_passes.drift.watch import Drift, Watch
from tuning_tables.sheet import sheet

VERSION = 1
"""Of `watch.json`."""

CAPTION = (
    "Upper panel: the sums that decide. There is one for each drift that is supposed; the four highest are named, and "
    "of the others the highest is drawn at each pass. An alarm is where a sum reaches the dashed limit, and nowhere "
    "else. Lower panels: exit speed less target of each pass, by weight category, and the median of the last 25. They "
    "decide nothing, so they have no limits. Triangles: the brake was full to the end, so the cut may have left too "
    "fast whatever the table. Hollow marks at an edge: beyond the panel; charts.csv has the value."
)
MARKED = " Vertical lines: the beginning of the drift (dotted) and the alarm (solid)."


@dataclass(frozen=True)
class WrittenWatch:
    """The text of `watch.json`, and the verdict in sentences."""

    json: str
    verdict: tuple[str, ...]


def write_watch(found: Watch, config: ResolvedConfig, created: str, directory: ResultsDirectory) -> WrittenWatch:
    """Write all files into `directory`; raises `OSError`."""
    sentences = verdict(found)
    text = json.dumps(plain(watch_document(found, config.sha256, sentences)), indent=1, ensure_ascii=False) + "\n"
    caption = CAPTION if found.drift is None else CAPTION + MARKED
    picture = Picture("watch", "Charts", "Charts of the watch", caption, draw(control_charts(found)))
    stamp = Stamp(f"Watch on {config.plants()[0][1].position.name}", created, version("retarder-synth"), config.sha256)
    kind = "accepted" if found.drift is None else "refused"
    box = element("section", *(element("p", each) for each in sentences), class_=f"verdict {kind}", id="verdict")
    sections = [("charts", "Charts", figure(picture))]
    if found.drift is not None:
        sections.append(("causes", "Causes", causes_table(found.drift)))
    directory.write("charts.csv", charts_csv(found))
    directory.write_all(picture_files([picture]))
    directory.write("report.html", document(stamp, box, sections).encode())
    directory.finish(text.encode())
    return WrittenWatch(text, sentences)


def verdict(found: Watch) -> tuple[str, ...]:
    """What drifted, since when, how much, what it costs, and what to do, in sentences."""
    m, drift = len(found.passes), found.drift
    if drift is None:
        return (f"No drift in {m} passes; at most one false alarm in {RUN_LENGTH:g} passes.",)
    diagnosis, first = drift.diagnosis, drift.diagnosis.first
    cause, second = first.cause, diagnosis.gains[1]
    low, high = (f"{number(found, each)}" for each in diagnosis.begins95)
    since = f"since pass {place(found, first.begin)}, between passes {low} and {high}"
    size = f"{cause.told(drift.size.size)} [{cause.told(drift.size.low95)}, {cause.told(drift.size.high95)}]"
    alarm = f"Alarm at pass {place(found, diagnosis.alarm)}."
    if not diagnosis.decided:
        return (
            f"Something drifted {since}; which cannot be decided yet.",
            f"{alarm} Most likely: {cause.title} ({size}), only {diagnosis.odds:.3g} times as likely as "
            f"{second.cause.title} ({second.cause.told(second.size)}). Log more passes, or look at both.",
            cost_sentence(drift),
        )
    return (
        f"Drift: {cause.title} {size} {since}.",
        f"{alarm} Next best: {second.cause.title} ({second.cause.told(second.size)}), 1 to {odds(diagnosis.odds)}.",
        cost_sentence(drift),
        f"{cause.remedy.value.upper()}: {cause.advice}.",
    )


def odds(value: float) -> str:
    """'85' or 'more than 1 000 000'."""
    return f"{value:.0f}" if value < 1e6 else "more than 1 000 000"


def cost_sentence(drift: Drift) -> str:
    """Exits before and after."""
    before, after = drift.before, drift.after
    if not before.passes or not after.passes:
        return "What it costs is not known: no targets on both sides of its beginning."
    return (
        f"Exits: rms of the error {before.rms_m_s:.3f} m/s in {before.passes} passes before, {after.rms_m_s:.3f} in "
        f"{after.passes} since; over-speed {100.0 * before.overspeed:.1f} % before, {100.0 * after.overspeed:.1f} % "
        "since."
    )


def number(found: Watch, index: int) -> int:
    """The number in the log, from 1, of the watched pass `index`."""
    return int(found.number_of[index]) + 1


def place(found: Watch, index: int) -> str:
    """'418 (cut-000417, 3600 s)': number, cut and time of a pass."""
    log = found.passes.log
    return f"{number(found, index)} ({log.cut_id[index]}, {log.time_s[log.first_row[index]]:.0f} s)"


def watch_document(found: Watch, config_sha256: str, sentences: tuple[str, ...]) -> dict[str, Any]:
    """The content of `watch.json`; passes are numbered from 1 as in the log."""
    charts = [
        {"cause": cause.name, "size": size, "highest": float(found.charts.sums[:, i].max())}
        for i, (k, size) in enumerate(found.charts.kinds)
        for cause in (found.evidence.causes[k],)
    ]
    drift = found.drift
    told = None if drift is None else {
        "cause": drift.diagnosis.first.cause.name, "decided": drift.diagnosis.decided, "odds": drift.diagnosis.odds,
        "remedy": drift.diagnosis.first.cause.remedy.value, "unit": drift.diagnosis.first.cause.scale.unit,
        "size": drift.size.size, "size_ci95": [drift.size.low95, drift.size.high95],
        "begin": number(found, drift.diagnosis.first.begin),
        "begin_ci95": [number(found, each) for each in drift.diagnosis.begins95],
        "begin_cut": found.passes.log.cut_id[drift.diagnosis.first.begin],
        "alarm": number(found, drift.diagnosis.alarm), "decided_at": number(found, drift.diagnosis.until),
        "before": asdict(drift.before), "after": asdict(drift.after),
        "causes": [
            {"cause": gain.cause.name, "size": gain.size, "begin": number(found, gain.begin), "log_gain": gain.log_gain}
            for gain in drift.diagnosis.gains
        ],
    }  # fmt: skip
    return {
        "format": "watch-summary", "version": VERSION, "passes": len(found.passes), "config": config_sha256,
        "limit": found.charts.limit, "run_length": RUN_LENGTH, "verdict": list(sentences), "drift": told,
        "charts": charts,
    }  # fmt: skip


def charts_csv(found: Watch) -> bytes:
    """A row a pass: number, cut, exit error, whether the brake was full to the end, and the sum of each chart."""
    causes = found.evidence.causes
    names = [f"{causes[k].name} {causes[k].told(size)}" for k, size in found.charts.kinds]
    rows = []
    for i, sums in enumerate(found.charts.sums.tolist()):
        error = float(found.errors_m_s[i])
        shown = "" if error != error else f"{error:.4f}"
        of_pass = (number(found, i), found.passes.log.cut_id[i], shown, int(found.full_brake[i]))
        rows.append((*of_pass, *(f"{each:.3f}" for each in sums)))
    return sheet(("pass", "cut_id", "exit_error_m_s", "full_brake", *names), rows)


def causes_table(drift: Drift) -> Markup:
    """All causes with their likelihood."""
    lead = "Each at its own most likely size and beginning; logarithm of its likelihood over that of no drift."
    rows = [
        ([gain.cause.title, gain.cause.told(gain.size), f"{gain.log_gain:.1f}", gain.cause.remedy.value], "")
        for gain in drift.diagnosis.gains
    ]
    head = (head_row("cause", "size", "log-likelihood gained", "remedy"),)
    return joined((element("p", lead), table("Causes", head, rows, kind="cases")))
