"""A traced train as plain data for the page: whole numbers of centimetres, hundredths of seconds, each the difference
to the one before."""

from __future__ import annotations

import math

import numpy as np

from plant_models.frozen_arrays import Floats
from plant_models.hump import HumpGraph
from synth.hump.trains.hump_page.plan_data import Data
from synth.hump.trains.train_trace import Alarm, AlarmKind, TracedCut, TrainTrace

HUNDREDTHS = 100.0

TOLD = {
    AlarmKind.MISROUTED: "misrouted behind",
    AlarmKind.CONTACT: "in contact with",
    AlarmKind.UNSEPARATED: "not separated from",
    AlarmKind.FOUL: "foul of",
    AlarmKind.ON_TRACK: "coupled on its track, while that rolled, to",
    AlarmKind.OVERSPEED: "coupled too fast",
    AlarmKind.STOPPED: "stopped before its track",
}
"""What stands between the cut and the cut ahead."""


def train_data(trace: TrainTrace) -> Data:
    """Cuts, passes, occupied elements and alarms."""
    return {
        "begin_s": hundredth(min(float(cut.trace.time_s[0]) for cut in trace.cuts)),
        "end_s": hundredth(trace.end_s),
        "mean_hump_speed_m_s": finite(trace.mean_hump_speed_m_s),
        "cuts": [cut_data(trace, cut) for cut in trace.cuts],
        "occupied": [[o.number, o.cut, hundredth(o.from_s), finite(o.to_s)] for o in trace.occupied],
        "alarms": [alarm_data(alarm, trace) for alarm in trace.alarms],
    }


def cut_data(trace: TrainTrace, cut: TracedCut) -> Data:
    """One cut; `t`, `s`, `v`: its samples."""
    return {
        "cars": cut.cars,
        "category": cut.category,
        "mass_t": round(cut.mass_t, 1),
        "length_m": round(cut.length_m, 3),
        "route": str(cut.route),
        "track": trace.routes.routes[cut.route].track,
        "wanted": trace.routes.routes[cut.wanted].track,
        "crest_s": hundredth(cut.crest_s),
        "hump_speed_m_s": hundredth(cut.hump_speed_m_s),
        "free_m": finite(cut.free_m),
        "coupled_m_s": finite(cut.coupled_m_s),
        "gap_m": finite(cut.gap_m),
        "caught_s": caught_s(trace, cut),
        "passes": [
            [p.number, hundredth(p.begin_s), finite(p.end_s), *map(hundredth, (p.entry_m_s, p.command_m_s)),
             hundredth(p.exit_m_s)]
            for p in cut.passages
        ],
        "t": differences(cut.trace.time_s),
        "s": differences(cut.trace.head_m),
        "v": differences(cut.trace.speed_m_s),
    }  # fmt: skip


def caught_s(trace: TrainTrace, cut: TracedCut) -> float | None:
    """When it caught up, as the figures count it: misrouted, or in contact ahead of its last position."""
    at = trace.routes.retarder[cut.route].max()
    last = trace.routes.numbers[trace.routes.vertex[cut.route, at]] if at >= 0 else None
    counted = (
        alarm.time_s
        for alarm in trace.alarms
        if alarm.cut == cut.cut
        and (alarm.kind is AlarmKind.MISROUTED or (alarm.kind is AlarmKind.CONTACT and alarm.number != last))
    )
    return finite(min(counted, default=None))


def alarm_data(alarm: Alarm, trace: TrainTrace) -> Data:
    """One alarm; an instant that never comes is None. `m_s`: the speed that belongs to it."""
    return {
        "kind": alarm.kind.name.lower(),
        "words": words(alarm, trace.routes.graph),
        "m_s": finite(trace.cuts[alarm.cut].coupled_m_s) if alarm.kind is AlarmKind.OVERSPEED else None,
        "severe": alarm.kind.severe,
        "t": finite(alarm.time_s),
        "cut": alarm.cut,
    }


def words(alarm: Alarm, graph: HumpGraph) -> str:
    """'cut 4 in contact with cut 3 at retarder 411'."""
    told = f"cut {alarm.cut + 1} {TOLD[alarm.kind]}"
    if alarm.ahead is not None:
        told += f" cut {alarm.ahead + 1}"
    return told if alarm.number is None else f"{told} at {graph.element_called(alarm.number)}"


def differences(values: Floats) -> list[int]:
    """The first value and the steps to the next ones, in hundredths; sums of them err by half a hundredth at most."""
    whole = np.round(values * HUNDREDTHS).astype(np.int64)
    return [int(step) for step in np.diff(whole, prepend=0)]


def hundredth(value: float) -> float:
    """To two places."""
    return round(float(value), 2)


def finite(value: float | None) -> float | None:
    """To two places; None for what is not known or never comes."""
    return None if value is None or not math.isfinite(value) else hundredth(value)
