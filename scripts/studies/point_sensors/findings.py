"""What the study `point-sensors` has found: its rows, what follows from them, and its tables."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from scripts.studies.point_sensors.rows import WorthRows
from scripts.studies.study import ABSENT, MarkdownTable, around, plus_minus, table

if TYPE_CHECKING:
    from scripts.studies.point_sensors.rows import FaultRow, SensorRow

COLUMNS = tuple((axles, layout) for axles in ("first", "every") for layout in ("equal", "planned"))
"""Axles and layout of the columns of `worth`."""

_NUMBERED = re.compile(r"^sensors? (\d+)( and \d+)? ")


def tables_of(found: WorthRows) -> Mapping[str, MarkdownTable]:
    """`worth`: a row a case and number; `proof`: beside the radar, prediction ratio, regret; `layouts`: what a layout
    is worth; `exits`: besides the rms; `faults`: the worst sensor of each kind; `many`: towards a radar; `grid`: by
    grid; `missed`: by the share of passages counted as not heard."""
    return {
        "worth": worth(found), "proof": proof(found), "layouts": layouts(found), "exits": exits(found),
        "faults": faults(found), "many": many(found), "grid": grid(found),
        "missed": missed(found),
    }  # fmt: skip


def worth(found: WorthRows) -> MarkdownTable:
    """rms by number, axles and layout, and of the radar."""
    cells = []
    for radar in found.radar:
        mine = {(row.sensors, row.axles, row.layout): row for row in found.sensors if row.case == radar.case}
        numbers = dict.fromkeys(number for number, _, layout in mine if layout != "rule")
        cells += [
            (radar.case, str(number), *(rms_of(mine.get((number, *column))) for column in COLUMNS))
            for number in numbers
        ]
        cells.append((radar.case, "radar", rms(radar.rms_m_s, radar.rms_ci95_m_s), *(ABSENT,) * 3))
    return table(
        "rms, m/s ± half its 95 % interval; sensors are counted with the one behind the exit",
        ("case", "sensors", *(f"{axles} axle, {layout}" for axles, layout in COLUMNS)),
        cells,
    )


def rms_of(row: SensorRow | None) -> str:
    """The cell of a layout."""
    return ABSENT if row is None else rms(row.rms_m_s, row.rms_ci95_m_s)


def proof(found: WorthRows) -> MarkdownTable:
    """What stands behind the rms: beside the radar, prediction ratio, regret."""
    rows = [
        (row.case, row.axles, str(row.sensors), row.layout, around(row.radar_ratio, row.radar_ratio_ci95, 2),
         f"{row.predicted_m_s:.4f}", around(row.prediction_ratio, row.prediction_ratio_ci95, 2),
         f"{row.told.regret:.2f}")
        for row in found.sensors
        if row.told is not None
    ]  # fmt: skip
    return table(
        "rms / rms of the radar on the same passes; predicted rms, m/s; prediction ratio: predicted / simulated rms; "
        "regret: predicted rms / predicted rms of speeds made for each friction",
        ("case", "axles", "sensors", "layout", "rms / radar", "predicted", "prediction ratio", "regret"),
        rows,
    )


def layouts(found: WorthRows) -> MarkdownTable:
    """Planned beside equal sections and the rule."""
    rows = []
    for row in found.sensors:
        if row.layout == "equal":
            continue
        equal = next((each for each in found.sensors if each.layout == "equal" and same(each, row)), None)
        rows.append((
            row.case, row.axles, str(row.sensors), row.layout, rms(row.rms_m_s, row.rms_ci95_m_s),
            ABSENT if equal is None else rms(equal.rms_m_s, equal.rms_ci95_m_s),
            ABSENT if row.equal_ratio is None else around(row.equal_ratio[0], row.equal_ratio[1], 2),
            around(row.unfinished, row.unfinished_ci95, 1, 100.0), ", ".join(f"{place:g}" for place in row.places_m),
        ))  # fmt: skip
    return table(
        "rms, m/s ± half its 95 % interval; planned / equal sections, paired; passages that find a change of stage "
        "unfinished, %; places of the sensors, m from the entrance",
        ("case", "axles", "sensors", "layout", "rms", "equal sections", "ratio", "unfinished, %", "places, m"),
        rows,
    )


def same(one: SensorRow, other: SensorRow) -> bool:
    """Whether two rows differ in their layout alone."""
    return (one.case, one.axles, one.sensors) == (other.case, other.axles, other.sensors)


def exits(found: WorthRows) -> MarkdownTable:
    """Switchings, stalls, over-speed of planned layouts and of the radar."""
    rows = [
        (row.case, "radar", ABSENT, f"{row.switchings:.2f}", percent(row.overspeed, row.overspeed_ci95),
         percent(row.stalled, row.stalled_ci95))
        for row in found.radar
    ]  # fmt: skip
    rows += [
        (row.case, str(row.sensors), row.axles, f"{row.switchings:.2f}", percent(row.overspeed, row.overspeed_ci95),
         percent(row.stalled, row.stalled_ci95))
        for row in found.sensors
        if row.layout == "planned"
    ]  # fmt: skip
    order = [row.case for row in found.radar]
    return table(
        "switchings a pass; exits more than 0.3 m/s too fast and cars that stop in the position, % [95 %]",
        ("case", "sensors", "axles", "switchings", "too fast", "stalled"),
        sorted(rows, key=lambda row: order.index(next(iter(row)))),
    )


def faults(found: WorthRows) -> MarkdownTable:
    """For each kind of fault the sensor at which it costs most."""
    worst: dict[tuple[str, str, str], FaultRow] = {}
    for row in found.faulty:
        key = (row.case, row.axles, kind_of(row.fault))
        if key not in worst or row.rms_m_s > worst[key].rms_m_s:
            worst[key] = row
    return table(
        "the worst sensor for each kind of fault: rms, m/s ± half its 95 % interval; rms / rms without fault, paired; "
        "the same where the tracker believes almost anything; too fast by 0.3 m/s and stalled, %",
        ("case", "axles", "fault", "rms", "ratio", "without limits", "too fast", "stalled"),
        (fault_cells(row) for row in worst.values()),
    )


def kind_of(fault: str) -> str:
    """The fault without the number of its sensor."""
    return _NUMBERED.sub("", fault)


def fault_cells(row: FaultRow) -> tuple[str, ...]:
    """The cells of one fault."""
    return (
        row.case, row.axles, row.fault, rms(row.rms_m_s, row.rms_ci95_m_s), around(row.ratio, row.ratio_ci95, 2),
        around(row.wide_ratio, row.wide_ratio_ci95, 2), percent(row.overspeed, row.overspeed_ci95),
        percent(row.stalled, row.stalled_ci95),
    )  # fmt: skip


def many(found: WorthRows) -> MarkdownTable:
    """More and more sensors beside the radar."""
    return table(
        "the same noise, decisions as often: rms, m/s ± half its 95 % interval; ratio paired",
        ("noise", "passages", "apart, m", "period of the radar, s", "sensors", "radar", "ratio"),
        (
            (row.noise, str(row.passages), f"{row.distance_m:.2f}", f"{row.period_s:.3f}",
             rms(row.rms_m_s, row.rms_ci95_m_s), rms(row.radar_rms_m_s, row.radar_rms_ci95_m_s),
             around(row.ratio, row.ratio_ci95, 3))
            for row in found.many
        ),
    )  # fmt: skip


def grid(found: WorthRows) -> MarkdownTable:
    """Equal sections, tables made on several grids."""
    return table(
        "the same layout, equal sections, its table made on two grids: path step, m; speed step, m/s",
        ("case", "axles", "sensors", "grid", "predicted", "rms", "prediction ratio"),
        (
            (row.case, row.axles, str(row.sensors),
             f"{row.path_step_m:g}, {row.speed_step_m_s:g}",
             f"{row.predicted_m_s:.4f}", rms(row.rms_m_s, row.rms_ci95_m_s), f"{row.prediction_ratio:.2f}")
            for row in found.grids
        ),
    )  # fmt: skip


def missed(found: WorthRows) -> MarkdownTable:
    """What counting passages as not heard costs and saves."""
    return table(
        "planned layouts by the share of passages that the design counts as not heard, %: rms without fault, predicted "
        "and simulated; the dead sensor that costs most, from 0; most cuts stalled by a dead sensor, %",
        ("case", "axles", "sensors", "not heard", "predicted", "rms", "worst dead", "rms with it", "stalled"),
        (
            (row.case, row.axles, str(row.sensors), f"{100.0 * row.missed_share:g}", f"{row.predicted_m_s:.4f}",
             rms(row.rms_m_s, row.rms_ci95_m_s), str(row.worst), rms(row.dead_rms_m_s, row.dead_rms_ci95_m_s),
             percent(row.most_stalled, row.most_stalled_ci95))
            for row in found.missed
        ),
    )  # fmt: skip


def rms(value_m_s: float, ends_m_s: Iterable[float]) -> str:
    """'0.0382 ± 0.0004'."""
    return plus_minus(value_m_s, tuple(ends_m_s), 4)


def percent(share: float, ends: tuple[float, float]) -> str:
    """'0.12 [0.08, 0.17]'."""
    return around(share, ends, 2, 100.0)


HONEST = (0.9, 1.1)
"""Predicted rms over simulated rms: what is claimed of every table."""

LIKE_A_RADAR = (0.9, 1.1)
"""rms of the most sensors over that of the radar that decides as often with the same noise: what is claimed."""


@dataclass(frozen=True)
class PointSensorWorth(WorthRows):
    """All rows, with the tables, sentences and faults that follow from them."""

    def tables(self) -> Mapping[str, MarkdownTable]:
        """See `tables`."""

        return tables_of(self)

    def sentences(self) -> tuple[str, ...]:
        """How much was simulated, and the largest losses."""
        worst = max(self.faulty, key=lambda row: row.rms_m_s)
        bias = [row.prediction_ratio for row in self.sensors]
        return (
            f"{self.passes} stratified passes of seed {self.seed}, the same cuts for every table; "
            f"{self.fault_passes} of them for every fault",
            f"predicted / simulated rms: {min(bias):.3f} to {max(bias):.3f} in {len(bias)} tables",
            f"the worst fault: {worst.fault} ({worst.case}, {worst.axles} axle), rms {worst.rms_m_s:.3f} m/s",
        )

    def faults(self) -> tuple[str, ...]:
        """Claims that fail beyond their interval."""
        found = [
            f"{row.name}: predicted / simulated is {row.prediction_ratio:.3f}"
            for row in self.sensors
            if row.prediction_ratio_ci95[1] < HONEST[0] or row.prediction_ratio_ci95[0] > HONEST[1]
        ]
        found += [
            f"{row.name}: worse than equal sections, ratio {row.equal_ratio[0]:.3f}"
            for row in self.sensors
            if row.equal_ratio is not None and row.equal_ratio[1][0] > 1.0
        ]
        most = {row.noise: row for row in self.many}  # the last of each noise has the most sensors
        found += [
            f"{row.passages} passages with noise {row.noise}: rms / rms of the radar is {row.ratio:.3f}"
            for row in most.values()
            if row.ratio_ci95[1] < LIKE_A_RADAR[0] or row.ratio_ci95[0] > LIKE_A_RADAR[1]
        ]
        return tuple(found)
