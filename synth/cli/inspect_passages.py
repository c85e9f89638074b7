"""What `inspect` tells of tables for point sensors: sensors, passages, switching speeds."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from synth.frame.terminal.printed_page import Exhibit
from synth.frame.terminal.printed_table import Column, PrintedTable
from synth.frame.terminal.printed_words import NO_BREAK
from synth.retarder.highest_stage import highest_stage
from tuning_tables.document import to_document
from tuning_tables.passages.passage_row import PassageRow
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.sensor_layout import DecidesOn

AXLES = {DecidesOn.FIRST_AXLE: "the first axle", DecidesOn.EVERY_AXLE: "every axle"}


def passage_document(table: PassageTable) -> dict[str, Any]:
    """A table for programs."""
    return {**to_document(table), "category_number": table.cut.number}


def passage_page(table: PassageTable) -> list[Exhibit]:
    """A table in words, a line a fact, then its switching speeds."""
    retarder, cut, predicted, sensors = table.retarder, table.cut, table.predicted, table.sensors
    zones = ", ".join(f"{begin:g} to {end:g} m" for begin, end in retarder.zones_m)
    validated = "it was not simulated"
    if table.validated:
        low, high = table.validated.rms_ci95_m_s
        rms = table.validated.rms_m_s
        validated = f"simulated rms {rms:.4f} m/s [{low:.4f}, {high:.4f}] in {table.validated.passes} passes"
    number = "without a number" if cut.number is None else f"number {cut.number}"
    places = ", ".join(f"{place:g}" for place in sensors.path_m)
    return [
        f"  {table.id}: leave with {table.target_speed_m_s:g} m/s",
        f"    retarder   {retarder.name}; zones {zones}; the pass ends at {retarder.exit_m:g} m",
        f"    cut        category {cut.category} ({number}), {cut.mass_t:g} t on {len(cut.axle_offsets_m)} axles",
        f"    made       {table.created} by {table.generator.name} {table.generator.version}, "
        f"configuration {table.generator.config_sha256[:16]}",
        f"    promised   rms {predicted.rms_m_s:.4f} m/s, bias {predicted.bias_m_s:+.4f} m/s, over-speed "
        f"{predicted.p_overspeed:.2g}, {predicted.switchings:.1f} switchings a pass (exact); {validated}",
        f"    sensors    {len(sensors.path_m)} at {places} m; base {sensors.base_m:g} m, timer "
        f"+-{1e3 * sensors.timer_noise_s:g} ms in steps of {1e3 * sensors.timer_resolution_s:g} ms; "
        f"{AXLES[sensors.decides_on]} decides",
        f"    approach   the regulator acts from {table.approach.length_m:g} m before the entrance on, where it "
        f"commands no stage above {table.entrance_stage}; it takes over a cut only when the cut ahead has left",
        f"    tracker    believes {table.plausible.speed_m_s[0]:g} to {table.plausible.speed_m_s[1]:g} m/s, gains of "
        f"{table.plausible.acceleration_m_s2:.2f} and losses of {table.plausible.deceleration_m_s2:.2f} m/s2",
        f"    passages   {len(table.passages)}; switching speeds in m/s, below which the lower stage is wanted:",
        switching_table(table),
    ]


class InForce(NamedTuple):
    """What holds at a passage while a stage is in force; sensor and axle are counted from 0, as in the file."""

    passage: PassageRow
    stage: int


def switching_table(table: PassageTable) -> PrintedTable[InForce]:
    """A row for each passage and stage in force, up to the highest stage that is ever asked for."""
    used = highest_stage(table) + 1

    def speed_column(below: int) -> Column[InForce]:
        name = f"{below}{NO_BREAK}|{NO_BREAK}{below + 1}"
        return Column(name, lambda row: speed_word(row.passage.switching_m_s[row.stage][below]))

    columns = (
        Column[InForce]("path, m", lambda row: f"{row.passage.path_m:.2f}", once=True),
        Column[InForce]("sensor", lambda row: str(row.passage.sensor), once=True),
        Column[InForce]("axle", lambda row: str(row.passage.axle), once=True),
        Column[InForce]("in force", lambda row: str(row.stage)),
        *map(speed_column, range(used - 1)),
    )
    rows = [InForce(passage, stage) for passage in table.passages for stage in range(used)]
    return PrintedTable(columns, rows, "the output of --json")


def speed_word(speed_m_s: float) -> str:
    """A switching speed; infinite ones mean never."""
    return f"{speed_m_s:.3f}" if math.isfinite(speed_m_s) else "never"
