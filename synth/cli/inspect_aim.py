"""What `retarder-synth inspect` tells of an aim table."""

from __future__ import annotations

from typing import Any

import numpy as np

from synth.cli.inspect_table import told_document
from synth.frame.exhibits import Column, Row, Table
from synth.frame.printed_numbers import counted, decimals
from synth.frame.terminal.printed_page import Printed
from synth.frame.terminal.printed_table import IN_JSON, PrintedTable
from synth.frame.terminal.printed_words import NO_BREAK
from synth.retarder.forms.table_file import AimFile
from tuning_tables.aim.aim_table import AimTable

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
