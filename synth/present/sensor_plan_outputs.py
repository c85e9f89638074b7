"""What a plan of point sensors leaves in its directory: pictures, the chosen section, and last of all the summary."""

from __future__ import annotations

from typing import Final

from synth.book.sensors.layout_results import LayoutResults
from synth.book.sensors.layout_summary import layout_summary, layout_toml
from synth.book.summary import Document
from synth.frame.results_directory import ResultsDirectory
from synth.present.plots.picture import picture_files
from tuning_tables.canonical import canonical_json

CHOSEN: Final = "sensors.toml"


def write_sensor_plan(
    results: LayoutResults, config_sha256: str, created: str, directory: ResultsDirectory, plots: bool
) -> Document:
    """Write everything; the summary as written. Raises `OSError`."""
    if plots:
        from synth.present.plots.sensors.layout_pictures import layout_pictures  # matplotlib

        directory.write_all(picture_files(layout_pictures(results), "plots"))
    if results.chosen is not None:
        directory.write(CHOSEN, layout_toml(results, results.chosen).encode())
    summary = layout_summary(results, config_sha256, created, directory.written)
    directory.finish(canonical_json(summary) + b"\n")
    return summary
