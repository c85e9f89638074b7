"""What `inspect` tells of tables for point sensors: sensors, passages, switching speeds."""

from __future__ import annotations

import math
from typing import Any

from synth.cli.inspect_table import table_words, told_document
from synth.frame.exhibits import Column, Table
from synth.frame.printed_numbers import decimals
from synth.frame.terminal.printed_page import Printed
from synth.frame.terminal.printed_table import IN_JSON, PrintedTable
from synth.frame.terminal.printed_words import NO_BREAK
from synth.retarder.highest_stage import highest_stage
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.sensor_layout import DecidesOn

AXLES = {DecidesOn.FIRST_AXLE: "the first axle", DecidesOn.EVERY_AXLE: "every axle"}


def passage_document(table: PassageTable) -> dict[str, Any]:
    """A table for programs."""
    return {**told_document(table), "category_number": table.cut.number}


def passage_page(table: PassageTable) -> list[Printed]:
    """A table in words, a line a fact, then its switching speeds."""
    sensors = table.sensors
    places = ", ".join(f"{place:g}" for place in sensors.path_m)
    return [
        *table_words(table),
        f"    sensors    {len(sensors.path_m)} at {places} m; base {sensors.base_m:g} m, timer "
        f"+-{1e3 * sensors.timer_noise_s:g} ms in steps of {1e3 * sensors.timer_resolution_s:g} ms; "
        f"{AXLES[sensors.decides_on]} decides",
        f"    clock      {sensors.clock}",
        f"    approach   the regulator acts from {table.approach.length_m:g} m before the entrance on, where it "
        f"commands no stage above {table.entrance_stage}; it takes over a cut only when the cut ahead has left",
        f"    tracker    believes {table.plausible.speed_m_s[0]:g} to {table.plausible.speed_m_s[1]:g} m/s, gains of "
        f"{table.plausible.acceleration_m_s2:.2f} and losses of {table.plausible.deceleration_m_s2:.2f} m/s2",
        f"    passages   {len(table.passages)}; switching speeds in m/s, below which the lower stage is wanted:",
        switching_table(table),
    ]


def switching_table(table: PassageTable) -> PrintedTable:
    """A row for each passage and stage in force, up to the highest stage that is ever asked for."""
    used = highest_stage(table) + 1
    columns = [
        Column("path_m", "path, m", form=decimals(2), once=True),
        Column("sensor", "sensor", once=True),
        Column("axle", "axle", once=True),
        Column("in_force", "in force"),
        *(Column(f"below {below}", f"{below}{NO_BREAK}|{NO_BREAK}{below + 1}", form=speed_word)
          for below in range(used - 1)),
    ]  # fmt: skip
    rows = [
        {
            "path_m": passage.path_m,
            "sensor": passage.sensor,
            "axle": passage.axle,
            "in_force": stage,
            **{f"below {below}": passage.switching_m_s[stage][below] for below in range(used - 1)},
        }
        for passage in table.passages
        for stage in range(used)
    ]
    return PrintedTable(Table("switching", "", columns, rows), IN_JSON)


def speed_word(speed_m_s: float) -> str:
    """A switching speed; infinite ones mean never."""
    return f"{speed_m_s:.3f}" if math.isfinite(speed_m_s) else "never"
