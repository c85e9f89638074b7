"""The command `hump watch`: a night's passes of all positions of a yard; what is shown: what to repair first, why, and
every position.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Final

from synth.frame.command import Command, Limit, Steps, Work
from synth.frame.exhibits import Chapter, Chart, Column, Exhibit, Row, Sentence, Table, Tile, Tiles
from synth.frame.printed_numbers import counted, decimals
from synth.frame.settings.settings_file import parse_settings
from synth.hump.options import YardWatchOptions
from synth.hump.trial.asked_trial import MODEL_ONLY
from synth.hump.watching.asked_yard import AskedYard, asked_yard
from synth.hump.watching.drift_cost import exit_law
from synth.hump.watching.settings import YardWatchSettings
from synth.hump.watching.watched_yard import Repair, WatchedPosition, WatchedYard, watched_yard
from synth.kernels.cache import guarded
from synth.logs.drift.command import LIMITS_OF_USE as OF_A_WATCH
from synth.logs.drift.shown import CAPTION, MARKED, advice, begin_of, number, size_told

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from synth.logs.drift.watch import Watch

MOST_NAMED: Final = 10
"""Positions that a sentence names."""

MOST_CHARTS: Final = 6
"""Drifts with a picture; each takes 60 kB of a page."""

HOW_IT_IS_PRICED: Final = (
    "The trains of the trial are humped with the exits of this retarder as they were measured before the drift, and as "
    "they are since. Every train has errors drawn anew from those passes, so the 95 % intervals cover the chance of "
    "the trains and the few passes; none is narrower than four events in all trains, which chance may hide. Cars lost: "
    "those of cuts that catch up, which must be humped again, and those that a slower train brings fewer. The order is "
    "by what became worse, each with the weight that the file gives it; what became better does not make up for it. "
    "'Ahead for sure' is no where the trains do not decide the order."
)

REPAIRS: Final = (
    Column("rank", "rank"),
    Column("position", "position", words=True),
    Column("drift", "what has drifted", words=True),
    Column("overspeeds_per_hour", "more over-speed couplings", "1/h", decimals(2)),
    Column("cars_lost_per_hour", "cars lost", "1/h", decimals(2)),
    Column("gap_m_per_hour", "more gaps", "m/h", decimals(0), spare=2),
    Column("weight_per_hour", "all that is worse", "cars/h", decimals(2), spare=1),
    Column("is_ahead", "ahead for sure", spare=1),
    Column("why", "not priced because", words=True, spare=1),
    Column("remedy", "remedy", words=True),
    Column("cause", "cause", words=True, spare=4),
)

EVIDENCE: Final = (
    Column("position", "position", words=True),
    Column("size", "size", words=True),
    Column("begin", "begins with pass"),
    Column("begin_cut", "cut", words=True, spare=2),
    Column("passes_to_alarm", "passes to the alarm"),
    Column("odds", "times as likely as the next cause", spare=2),
    Column("mean_before_m_s", "mean exit error before", "m/s", decimals(3)),
    Column("mean_since_m_s", "since", "m/s", decimals(3)),
    Column("std_before_m_s", "spread before", "m/s", decimals(3), spare=1),
    Column("std_since_m_s", "since", "m/s", decimals(3), spare=1),
)

POSITIONS: Final = (
    Column("position", "position", words=True),
    Column("state", "state", words=True),
    Column("new", "new passes"),
    Column("watched", "passes watched"),
    Column("highest", "highest sum of now", form=decimals(1)),
    Column("limit", "alarm at", form=decimals(1)),
    Column("not_read", "not read", words=True),
)


def named(positions: Sequence[WatchedPosition]) -> str:
    """'401, 402 and 7 more'."""
    names = [each.asked.name for each in positions]
    more = len(names) - MOST_NAMED
    return ", ".join(names[:MOST_NAMED]) + (f" and {more} more" if more > 0 else "")


def drifted(found: WatchedYard) -> str:
    """How many positions have drifted, and which is the first."""
    count = len(found.positions)
    if not found.repairs:
        return f"no drift in {counted(count, 'position')}"
    return (
        f"{len(found.repairs)} of {counted(count, 'position')} drifted: "
        f"{named([each.position for each in found.repairs])}"
    )


def silent(found: WatchedYard) -> str:
    """The positions that were not watched now."""
    return f"no new passes of {named(found.silent)}: look at the logger"


def repairs(found: WatchedYard) -> Iterator[Exhibit]:
    """The ranked list."""
    settings = found.asked.settings
    yield Tiles(list(tiles(found)))
    yield Sentence(
        f"{found.new} new passes of {counted(len(found.positions), 'position')}; at most one false alarm of the yard "
        f"in {settings.false_alarms.nights} nights of {settings.false_alarms.passes} passes a position.",
        {
            "positions": len(found.positions),
            "drifted": len(found.repairs),
            "new_passes": found.new,
            "run_length": settings.run_length,
        },
        brief=True,
    )
    for each in found.repairs:
        yield Sentence(f"{each.position.asked.name}: {told(each)}. {advice(each.drift)}", to_do=True)
    if found.repairs:
        yield Table("repairs", "What to repair first", REPAIRS, list(repair_rows(found)), brief=True)
        if any(each.cost is not None for each in found.repairs):
            yield Sentence(HOW_IT_IS_PRICED)


def tiles(found: WatchedYard) -> Iterator[Tile]:
    """How many drifted, how much was watched, and what the first one costs."""
    count = len(found.positions)
    yield Tile(f"{len(found.repairs)} of {count}", "positions have drifted", not found.repairs)
    yield Tile(f"{found.new}", f"new passes of {count - len(found.silent)} positions")
    if not found.repairs:
        return
    first = found.repairs[0]
    if first.weight is not None:
        worse = first.weight.told
        said = f"{worse.value:.2f} [{worse.low95:.2f}, {worse.high95:.2f}]"
        yield Tile(said, f"cars an hour is what {first.position.asked.name} costs, all in all")


def told(repair: Repair) -> str:
    """'mean friction -30 % [-32 %, -28 %]', or both causes where they are about as likely."""
    diagnosis = repair.drift.diagnosis
    first, second = (each.cause.title for each in diagnosis.gains[:2])
    return f"{first} {size_told(repair.drift)}" if diagnosis.decided else f"{first} or {second}, not decided yet"


def repair_rows(found: WatchedYard) -> Iterator[Row]:
    """The drifts, the first to be repaired first."""
    for place, each in enumerate(found.repairs):
        differences = {} if each.cost is None else vars(each.cost)
        yield {
            "rank": place + 1,
            "position": each.position.asked.name,
            "drift": told(each),
            **{name: difference.told for name, difference in differences.items()},
            "weight_per_hour": None if each.weight is None else each.weight.told,
            "is_ahead": found.is_ahead(place),
            "why": each.why or None,
            "remedy": each.drift.diagnosis.first.cause.remedy.value,
            "cause": each.drift.diagnosis.first.cause.name,
        }


def evidence(found: WatchedYard) -> Iterator[Exhibit]:
    """What was measured of each drift, and its charts."""
    yield Table("evidence", "What was measured", EVIDENCE, list(evidence_rows(found)))
    yield Sentence(
        "Passes are numbered as the watch on a position counts them. The mean exit error is exit speed less target; "
        "that of before is of the passes that are still kept, 100 at least where so many were watched. The first "
        f"{MOST_CHARTS} of the list have charts."
    )
    for rank, each in enumerate(found.repairs[:MOST_CHARTS], start=1):
        title = f"Position {each.position.asked.name}: charts of the watch"
        yield Chart(f"watch-{rank}", title, CAPTION + MARKED, partial(drawn, each.watch, title))


def drawn(watch: Watch, title: str) -> Figure:
    """The picture of `watch`."""
    from synth.logs.drift.pictures import control_charts

    return control_charts(watch, title)


def evidence_rows(found: WatchedYard) -> Iterator[Row]:
    """A row a drift."""
    for each in found.repairs:
        watch, diagnosis = each.watch, each.drift.diagnosis
        begin = diagnosis.first.begin
        laws = {"before": exit_law(watch.errors_m_s[:begin]), "since": exit_law(watch.errors_m_s[begin:])}
        yield {
            "position": each.position.asked.name,
            "size": size_told(each.drift),
            "begin": begin_of(watch, each.drift),
            "begin_cut": watch.passes.log.cut_id[begin],
            "passes_to_alarm": number(watch, diagnosis.alarm) - number(watch, begin) + 1,
            "odds": diagnosis.odds,
            **{f"mean_{when}_m_s": law and law.mean_m_s for when, law in laws.items()},
            **{f"std_{when}_m_s": law and law.std_m_s for when, law in laws.items()},
        }


def positions(found: WatchedYard) -> Iterator[Exhibit]:
    """A row a position."""
    yield Table("positions", "All positions", POSITIONS, list(position_rows(found)))
    yield Sentence(
        "An alarm is where a sum reaches its limit. Every position has a sum for each drift that is supposed, up and "
        "down; the highest one of now is told."
    )


def position_rows(found: WatchedYard) -> Iterator[Row]:
    """All of them in the order of the file."""
    for each in found.positions:
        night = each.night
        more = len(each.not_read) - 1
        yield {
            "position": each.asked.name,
            "state": state_of(each),
            "new": night.new,
            "watched": night.kept.watched,
            "highest": night.highest,
            "limit": night.limit,
            "not_read": None if more < 0 else each.not_read[0] + (f" ({more} more)" if more else ""),
        }


def state_of(position: WatchedPosition) -> str:
    """In a word or two."""
    if position.night.found is not None:
        return "drifted"
    return "in order" if position.night.new else "no new passes"


LIMITS_OF_USE = (
    MODEL_ONLY,
    *OF_A_WATCH,
    "After an alarm passes are taken until its cause is sought no longer, 250 at most; then the position waits for its "
    "repair: --repaired, or another configuration.",
    "A cost takes exit errors to be alike for all cuts of the retarder, whatever their category and command.",
    "Switches and wheel detectors are not watched.",
)


def compute(asked: AskedYard, work: Work) -> WatchedYard:
    """All positions, then what the drifts cost."""
    return guarded(watched_yard, asked, work.directory, work.progress)


def limits(found: WatchedYard) -> Iterator[Limit]:
    """Whether any position has drifted, and whether all were watched."""
    yield Limit(drifted(found), not found.repairs)
    if found.silent:
        yield Limit(silent(found), None)


def show(found: WatchedYard) -> Iterator[Chapter]:
    """The list first, then why, then every position."""
    yield Chapter("What to repair first", tuple(repairs(found)))
    if found.repairs:
        yield Chapter("Evidence", tuple(evidence(found)))
    yield Chapter("All positions", tuple(positions(found)))


COMMAND = Command(
    name="hump watch",
    read=partial(parse_settings, YardWatchSettings),
    options=YardWatchOptions,
    resolve=asked_yard,
    head=lambda asked: asked.head,
    steps=lambda asked: Steps(len(asked.positions), "watching", "positions"),
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
