"""What `inspect` tells of every table from which a controller takes stages, a line a fact."""

from __future__ import annotations

from typing import Any

from tuning_tables.canonical import CHECKSUM_KEY
from tuning_tables.document import to_document
from tuning_tables.table_kinds import AnyTable, StageTable


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
