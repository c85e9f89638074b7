"""What `inspect` tells of single tables: of every table from which a controller takes stages, a line a fact; of
those for point sensors their passages and switching speeds; and of aim tables.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from synth.frame.exhibits import Column, Row, Table
from synth.frame.printed_numbers import counted, decimals
from synth.frame.terminal.printed_page import IN_JSON, NO_BREAK, Printed, PrintedTable
from synth.retarder.forms.tables_at import AimFile
from synth.retarder.served_class import highest_stage
from tuning_tables.aim.aim_tables import AimTable
from tuning_tables.document import AnyTable, StageTable, to_document
from tuning_tables.json_text import CHECKSUM_KEY
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.sensor_layout import DecidesOn


def told_document(table: AnyTable) -> dict[str, Any]:
    """A table for programs, less what is of the file that it was read from."""
    return {key: value for key, value in to_document(table).items() if key not in ("exported_by", CHECKSUM_KEY)}


def table_words(table: StageTable) -> list[str]:
    """What it is for, who made it, and what it promises."""
    retarder, cut, predicted = table.retarder, table.cut, table.predicted
    zones = ", ".join(f"{begin:g} to {end:g} m" for begin, end in retarder.zones_m)
    validated = "it was not simulated"
    if table.validated:
        low, high = table.validated.rms_ci95_m_s
        rms = table.validated.rms_m_s
        validated = f"simulated rms {rms:.4f} m/s [{low:.4f}, {high:.4f}] in {table.validated.passes} passes"
    number = "without a number" if cut.number is None else f"number {cut.number}"
    origin = "exact" if predicted.passes is None else f"from {predicted.passes} simulated passes"
    return [
        f"  {table.id}: leave with {table.target_speed_m_s:g} m/s",
        f"    retarder   {retarder.name}; zones {zones}; the pass ends at {retarder.exit_m:g} m",
        f"    cut        category {cut.category} ({number}), {cut.mass_t:g} t on {len(cut.axle_offsets_m)} axles",
        f"    made       {table.created} by {table.generator.name} {table.generator.version}, "
        f"configuration {table.generator.config_sha256[:16]}",
        f"    promised   rms {predicted.rms_m_s:.4f} m/s, bias {predicted.bias_m_s:+.4f} m/s, over-speed "
        f"{predicted.p_overspeed:.2g}, {predicted.switchings:.1f} switchings a pass ({origin}); {validated}",
    ]


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


SHOWN_DISTANCES = 6


def aim_document(file: AimFile) -> dict[str, Any]:
    """An aim table for programs."""
    document = told_document(file.table)
    return {"path": str(file.path), "kind": "aim table", "checksum": "right", "tables": [document]}


def aim_page(file: AimFile) -> list[Printed]:
    """An aim table in words, a line a fact, and some of its exit speeds."""
    table = file.table
    required, (low, high) = table.required, table.bounds_m_s
    nodes, missing = table.exit_speed_m_s.size, int(np.isnan(table.exit_speed_m_s).sum())
    first, last = table.axes.free_distance_m[[0, -1]]
    generator = table.generator
    return [
        f"{file.path}: an aim table; its CRC-32 is right",
        f"  {table.id}: couple faster than {required.coupling_speed_m_s:g} m/s with a probability of "
        f"{required.p_overspeed:g}",
        f"    position   {table.position.name}, left {table.position.exit_at_m:g} m from the crest",
        f"    cuts       category {table.category.name} (number {table.category.number}), {known_words(table)}",
        f"    made       {table.created} by {generator.name} {generator.version}, "
        f"configuration {generator.config_sha256[:16]}",
        f"    reported   {reported_words(table)}",
        f"    nodes      {' x '.join(map(str, table.axes.shape))}, free distance {first:g} to {last:g} m; "
        f"{missing} of {nodes} have no exit speed, between them at most {table.interpolation_error_m_s:g} m/s too slow",
        f"    speeds     {low:g} to {high:g} m/s",
        speed_table(table),
    ]


def known_words(table: AimTable) -> str:
    """What is known of a cut."""
    if table.measured is None:
        return "known by category and number of cars"
    return (
        f"resistance measured from {table.measured.from_m:g} to {table.measured.to_m:g} m by two speeds "
        f"+-{table.measured.speed_std_m_s:g} m/s"
    )


def reported_words(table: AimTable) -> str:
    """What cuts did at the nodes: the worst of them, and the mean."""
    reported = table.reported
    p = reported.p_overspeed
    if np.isnan(p).all():
        return "nothing: no node has figures"
    worst = np.unravel_index(np.nanargmax(p), p.shape)
    return (
        f"over-speed {np.nanmean(p):.4f} on average, at most {p[worst]:.4f} [{reported.p_overspeed_low95[worst]:.4f}, "
        f"{reported.p_overspeed_high95[worst]:.4f}], mean gap {np.nanmin(reported.mean_gap_m):.1f} to "
        f"{np.nanmax(reported.mean_gap_m):.1f} m; {reported.passes} passes"
    )


def speed_table(table: AimTable) -> PrintedTable:
    """Exit speeds at some free distances, for every number of cars; at the ends and the middle of the resistances."""
    distance, resistance = table.axes.free_distance_m, table.axes.resistance_n_per_kn
    shown = np.unique(np.linspace(0, len(distance) - 1, SHOWN_DISTANCES).round().astype(int)).tolist()
    nodes = table.exit_speed_m_s.reshape(*table.axes.shape[:2], -1)
    count = nodes.shape[2]
    rows: list[Row] = []
    for row, cars in enumerate(table.axes.cars.tolist()):
        for column in sorted({0, count // 2, count - 1}):
            of = "" if resistance is None else f", {resistance[column]:g} N/kN"
            speeds = {f"node {node}": speed_or_none(nodes[row, node, column]) for node in shown}
            rows.append({"cuts": f"{counted(cars, 'car')}{of}", **speeds})
    columns = [Column("cuts", "exit speed, m/s", words=True)]
    columns += [Column(f"node {node}", f"{distance[node]:g}{NO_BREAK}m free", form=decimals(3)) for node in shown]
    return PrintedTable(Table("speeds", "", columns, rows), IN_JSON)


def speed_or_none(speed_m_s: float) -> float | str:
    """The speed of a node, or that it has none."""
    return "none" if np.isnan(speed_m_s) else float(speed_m_s)
