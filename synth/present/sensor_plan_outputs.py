"""What a plan of point sensors leaves in its directory: pictures, the chosen section, and last of all the summary."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from synth.book.output_directory import SENSOR_PLAN_PICTURES, SUMMARY, remove_stale
from synth.book.sensors.layout_results import LayoutResults
from synth.book.sensors.layout_summary import layout_summary, layout_toml
from synth.book.summary import Document
from synth.present.outputs import file_hashes
from synth.present.plots.picture import save_picture
from tuning_tables import write_atomically
from tuning_tables.canonical import canonical_json

CHOSEN: Final = "sensors.toml"


def write_sensor_plan(
    results: LayoutResults, config_sha256: str, created: str, directory: Path, plots: bool
) -> Document:
    """Write everything; the summary as written. Raises `OSError`."""
    files: list[Path] = []
    if plots:
        from synth.present.plots.sensors.layout_pictures import layout_pictures  # matplotlib

        for picture in layout_pictures(results):
            files += save_picture(picture, directory / "plots")
    chosen = directory / CHOSEN
    chosen.unlink(missing_ok=True)
    if results.chosen is not None:
        write_atomically(chosen, layout_toml(results, results.chosen).encode())
        files.append(chosen)
    hashes = file_hashes(directory, files)
    remove_stale(directory, set(hashes), pictures=SENSOR_PLAN_PICTURES)
    summary = layout_summary(results, config_sha256, created, hashes)
    write_atomically(directory / SUMMARY, canonical_json(summary) + b"\n")
    return summary
