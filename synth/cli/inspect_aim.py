"""What `retarder-synth inspect` tells of an aim table."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from synth.book.forms.aim_file import AimFile
from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.document import to_aim_document
from tuning_tables.aim.purpose import CategoryAlone

SHOWN_DISTANCES = 6


def aim_document(file: AimFile) -> dict[str, Any]:
    """An aim table for programs."""
    document = to_aim_document(file.table)
    return {"path": str(file.path), "kind": "aim table", "checksum": "right", "tables": [document]}


def aim_words(file: AimFile) -> list[str]:
    """An aim table in words, a line a fact."""
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
        f"configuration {generator.config_sha256[:16]}…",
        f"    reported   {reported_words(table)}",
        f"    nodes      {' x '.join(map(str, table.axes.shape))}, free distance {first:g} to {last:g} m; "
        f"{missing} of {nodes} have no exit speed, between them at most {table.interpolation_error_m_s:g} m/s too slow",
        f"    speeds     {low:g} to {high:g} m/s; in m/s at",
        *speed_lines(table),
    ]


def known_words(table: AimTable) -> str:
    """What is known of a cut."""
    if isinstance(table.knowledge, CategoryAlone):
        return "known by category and number of cars"
    knowledge = table.knowledge
    return (
        f"resistance measured from {knowledge.from_m:g} to {knowledge.to_m:g} m by two speeds "
        f"+-{knowledge.speed_std_m_s:g} m/s"
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


def speed_lines(table: AimTable) -> Iterator[str]:
    """Exit speeds at some free distances, for every number of cars; at the ends and the middle of the resistances."""
    distance, resistance = table.axes.free_distance_m, table.axes.resistance_n_per_kn
    shown = np.unique(np.linspace(0, len(distance) - 1, SHOWN_DISTANCES).round().astype(int))
    yield f"      {'free distance, m':<22}" + "".join(f"{distance[place]:>9g}" for place in shown)
    count = table.speed_nodes.shape[2]
    for row, cars in enumerate(table.axes.cars.tolist()):
        for column in sorted({0, count // 2, count - 1}):
            of = "" if resistance is None else f", {resistance[column]:g} N/kN"
            speeds = table.speed_nodes[row, shown, column]
            name = f"{cars} car{'s' if cars > 1 else ''}{of}"
            yield f"      {name:<22}" + "".join(f"{'none' if np.isnan(v) else f'{v:.3f}':>9}" for v in speeds)
