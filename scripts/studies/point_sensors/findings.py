"""What the study `point-sensors` has found: its rows, and what follows from them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from scripts.studies.markdown_table import MarkdownTable
from scripts.studies.point_sensors.rows import WorthRows

HONEST = (0.9, 1.1)
"""Predicted rms over simulated rms: what is claimed of every table."""

LIKE_A_RADAR = (0.9, 1.1)
"""rms of the most sensors over that of the radar that decides as often with the same noise: what is claimed."""


@dataclass(frozen=True)
class PointSensorWorth(WorthRows):
    """All rows, with the tables, sentences and faults that follow from them."""

    def tables(self) -> Mapping[str, MarkdownTable]:
        """See `tables`."""
        from scripts.studies.point_sensors.tables import tables_of

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
