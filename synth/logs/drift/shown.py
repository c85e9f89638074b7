"""What is shown of a watch: what has drifted and what it costs, all causes, the charts, and every pass."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from synth.frame.exhibits import Chart, Column, Exhibit, Row, Sentence, Table, Tile, Tiles
from synth.frame.interval import Interval
from synth.frame.printed_numbers import decimals, per_cent
from synth.logs.drift.charts import RUN_LENGTH
from synth.logs.drift.watch import Drift, Watch

CAPTION: Final = (
    "Upper panel: the sums that decide. There is one for each drift that is supposed; the four highest are named, and "
    "of the others the highest is drawn at each pass. An alarm is where a sum reaches the dashed limit, and nowhere "
    "else. Lower panels: exit speed less target of each pass, by weight category, and the median of the last 25. They "
    "decide nothing, so they have no limits. Triangles: the brake was full to the end, so the cut may have left too "
    "fast whatever the table. Hollow marks at an edge: beyond the panel."
)
IN_SHEET: Final = " Every pass is in sheets/passes.csv."
MARKED: Final = " Vertical lines: the beginning of the drift (dotted) and the alarm (solid)."

CAUSES: Final = (
    Column("title", "cause", words=True),
    Column("drift", "drift", words=True),
    Column("size", "size"),
    Column("unit", "unit", words=True),
    Column("begin", "begins with pass"),
    Column("log_gain", "log-likelihood gained", form=decimals(1)),
    Column("remedy", "remedy", words=True),
    Column("cause", "name", words=True, code=True),
)
EXITS: Final = (
    Column("time", "passes", words=True),
    Column("passes", "number"),
    Column("rms_m_s", "rms of the error", "m/s", decimals(3)),
    Column("overspeed", "over-speed", form=per_cent),
)
CHARTS: Final = (
    Column("cause", "cause", words=True),
    Column("drift", "supposed drift", words=True),
    Column("size", "size"),
    Column("highest", "highest sum", form=decimals(1)),
)
PASS: Final = (
    Column("pass", "pass"),
    Column("cut_id", "cut", words=True),
    Column("exit_error_m_s", "exit speed less target", "m/s", decimals(4)),
    Column("full_brake", "full brake to the end"),
)


def alarm(found: Watch) -> str:
    """The highest sum beside the limit, or where a sum has reached it."""
    charts = found.charts
    if found.drift is not None:
        where = place(found, found.drift.diagnosis.alarm)
        return f"alarm at pass {where}: a sum reached the limit of {charts.limit:.1f}"
    return (
        f"no drift in {len(found.passes)} passes: the highest sum is {charts.sums.max():.1f}, an alarm begins at "
        f"{charts.limit:.1f}"
    )


def drifted(found: Watch) -> Iterator[Exhibit]:
    """What drifted, since when, how much, what it costs, and what to do; then every cause."""
    drift = found.drift
    yield tiles(found)
    yield Sentence(
        f"{len(found.passes)} passes, {len(found.charts.kinds)} supposed drifts; at most one false alarm in "
        f"{RUN_LENGTH:g} passes.",
        {
            "passes": len(found.passes),
            "limit": found.charts.limit,
            "run_length": RUN_LENGTH,
            "drift": None if drift is None else figures_of(found, drift),
        },
        brief=True,
    )
    if drift is None:
        return
    for sentence in sentences(found, drift):
        yield Sentence(sentence, brief=True)
    yield Sentence(advice(drift), brief=True, to_do=True)
    yield Table("exits", "Exits before and since", EXITS, list(exit_rows(drift)))
    yield Sentence(
        "Each cause at its most likely beginning and size, of the first one as told above, of the others between those "
        "supposed; the logarithm of its likelihood over that of no drift."
    )
    yield Table("causes", "Causes", CAUSES, list(cause_rows(found, drift)))


def tiles(found: Watch) -> Tiles:
    """How much was watched, how near an alarm is, and what a drift costs."""
    highest, limit, drift = float(found.charts.sums.max()), found.charts.limit, found.drift
    made = [
        Tile(f"{len(found.passes)} passes", "were watched"),
        Tile(f"{highest:.1f}", f"is the highest sum; an alarm begins at {limit:.1f}", drift is None),
    ]
    if drift is not None:
        before, since = drift.before, drift.after
        words = f"is the rms error of {since.passes} passes since then"
        more = f"; of those before it was {before.rms_m_s:.3f} m/s" if before.passes else ""
        made += [Tile(f"{since.rms_m_s:.3f} m/s", f"{words}{more}")] if since.passes else []
    return Tiles(made)


def figures_of(found: Watch, drift: Drift) -> Row:
    """The drift by name; passes are numbered from 1 as in the log."""
    diagnosis, size = drift.diagnosis, drift.size
    first = diagnosis.first
    return {
        "cause": first.cause.name,
        "decided": diagnosis.decided,
        "odds": diagnosis.odds,
        "remedy": first.cause.remedy.value,
        "unit": first.cause.scale.unit,
        "size": Interval(size.size, size.low95, size.high95, drift.last + 1 - first.begin),
        "begin": begin_of(found, drift),
        "begin_cut": found.passes.log.cut_id[first.begin],
        "alarm": number(found, diagnosis.alarm),
        "decided_at": number(found, diagnosis.until),
    }


def begin_of(found: Watch, drift: Drift) -> Interval:
    """The first pass with the drift, told from those up to the decision."""
    diagnosis = drift.diagnosis
    begin = number(found, diagnosis.first.begin)
    low, high = (number(found, each) for each in diagnosis.begins95)
    # The beginning is sought among the supposed sizes, its interval between them too: it may lie just outside.
    return Interval(begin, min(low, begin), max(high, begin), diagnosis.until + 1)


def sentences(found: Watch, drift: Drift) -> Iterator[str]:
    """The verdict in words."""
    diagnosis, first = drift.diagnosis, drift.diagnosis.first
    cause, second = first.cause, diagnosis.gains[1]
    low, high = (f"{number(found, each)}" for each in diagnosis.begins95)
    since = f"since pass {place(found, first.begin)}, between passes {low} and {high}"
    size = size_told(drift)
    next_best = f"{second.cause.title} ({second.cause.told(second.size)})"
    if diagnosis.decided:
        yield f"Drift: {cause.title} {size} {since}."
        yield f"Next best: {next_best}, 1 to {odds(diagnosis.odds)}."
        yield cost_sentence(drift)
        return
    yield f"Something drifted {since}; which cannot be decided yet."
    yield (f"Most likely: {cause.title} ({size}), only {diagnosis.odds:.3g} times as likely as {next_best}.")
    yield cost_sentence(drift)


def size_told(drift: Drift) -> str:
    """'-30 % [-32 %, -28 %]'."""
    cause, size = drift.diagnosis.first.cause, drift.size
    return f"{cause.told(size.size)} [{cause.told(size.low95)}, {cause.told(size.high95)}]"


def advice(drift: Drift) -> str:
    """What to do about it."""
    diagnosis, cause = drift.diagnosis, drift.diagnosis.first.cause
    if diagnosis.decided:
        return f"{cause.remedy.value.upper()}: {cause.advice}."
    return f"Log more passes, or look at both: {cause.title}, and {diagnosis.gains[1].cause.title}."


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


def exit_rows(drift: Drift) -> Iterator[Row]:
    """What it costs."""
    for time, cost in (("before", drift.before), ("since", drift.after)):
        yield {
            "time": time,
            "passes": cost.passes,
            "rms_m_s": cost.rms_m_s,
            "overspeed": cost.overspeed,
        }


def cause_rows(found: Watch, drift: Drift) -> Iterator[Row]:
    """All causes, the most likely first."""
    for gain in drift.diagnosis.gains:
        cause, size = gain.cause, drift.size.size if gain is drift.diagnosis.first else gain.size
        yield {
            "title": cause.title,
            "drift": cause.told(size),
            "size": size,
            "unit": cause.scale.unit,
            "begin": number(found, gain.begin),
            "log_gain": gain.log_gain,
            "remedy": cause.remedy.value,
            "cause": cause.name,
        }


def charts(found: Watch) -> Iterator[Exhibit]:
    """The sums that decide, and what each pass adds to the picture."""
    yield Chart(
        "watch",
        "Charts of the watch",
        CAPTION + IN_SHEET + ("" if found.drift is None else MARKED),
        lambda: _pictures().control_charts(found),
    )
    yield Table("charts", "Supposed drifts", CHARTS, list(chart_rows(found)))
    columns = (*PASS, *(Column(name, f"sum of {name}", form=decimals(3)) for name in chart_names(found)))
    yield Table("passes", "Every pass, and the sums after it", columns, list(pass_rows(found)), long=True)


def chart_names(found: Watch) -> tuple[str, ...]:
    """Cause and size of each sum."""
    causes = found.evidence.causes
    return tuple(f"{causes[k].name} {causes[k].told(size)}" for k, size in found.charts.kinds)


def chart_rows(found: Watch) -> Iterator[Row]:
    """The highest value of each sum."""
    for (k, size), sums in zip(found.charts.kinds, found.charts.sums.T, strict=True):
        cause = found.evidence.causes[k]
        yield {"cause": cause.name, "drift": cause.told(size), "size": size, "highest": float(sums.max())}


def pass_rows(found: Watch) -> Iterator[Row]:
    """Number, cut and exit of each pass, and all sums after it."""
    names = chart_names(found)
    for index, sums in enumerate(found.charts.sums.tolist()):
        yield {
            "pass": number(found, index),
            "cut_id": found.passes.log.cut_id[index],
            "exit_error_m_s": float(found.errors_m_s[index]),
            "full_brake": bool(found.full_brake[index]),
            **dict(zip(names, sums, strict=True)),
        }


def _pictures() -> Any:
    from synth.logs.drift import pictures  # matplotlib

    return pictures
