"""What shares of variance leave in their directory: document, CSV, pictures, report, and last of all the summary."""

from __future__ import annotations

from importlib.metadata import version
from pathlib import Path
from typing import Final

from synth.book.output_directory import SENSITIVITY_LAYOUT, SENSITIVITY_PICTURES, SUMMARY, remove_stale
from synth.book.sensitivity.document import VERSION, sensitivity_csv, sensitivity_document
from synth.book.sensitivity.sensitivity import Sensitivity
from synth.book.summary import Document
from synth.present.outputs import file_hashes
from synth.present.plots.picture import Picture, save_picture
from synth.present.report.sensitivity_report import SensitivityReport, sensitivity_page
from tuning_tables import write_atomically
from tuning_tables.canonical import canonical_json

DOCUMENT: Final = "sensitivity.json"
TABLE: Final = "sensitivity.csv"


def write_sensitivity(found: Sensitivity, created: str, directory: Path) -> Document:
    """Write everything; the document as written. Raises `OSError`."""
    output = found.config.output
    document = sensitivity_document(found, created)
    write_atomically(directory / DOCUMENT, canonical_json(document) + b"\n")
    write_atomically(directory / TABLE, sensitivity_csv(found))
    files, pictures = [directory / DOCUMENT, directory / TABLE], drawn(found)
    if output.plots:
        for picture in pictures:
            files += save_picture(picture, directory / "plots")
    hashes = file_hashes(directory, files)
    if output.report:
        page = directory / "report.html"
        write_atomically(page, sensitivity_page(SensitivityReport(found, created, hashes, pictures)).encode())
        hashes |= file_hashes(directory, [page])
    remove_stale(directory, set(hashes), pictures=SENSITIVITY_PICTURES)
    summary = {
        "format": SENSITIVITY_LAYOUT.form,
        "version": VERSION,
        "created": created,
        "generator": {"name": "retarder-synth", "version": version("retarder-synth"),
                      "config_sha256": found.config.sha256},
        "measure_first": document["measure_first"],
        "files": hashes,
    }  # fmt: skip
    write_atomically(directory / SUMMARY, canonical_json(summary) + b"\n")
    return document


def drawn(found: Sensitivity) -> tuple[Picture, ...]:
    """The pictures, if anybody wants them."""
    if not (found.config.output.plots or found.config.output.report):
        return ()
    from synth.present.plots.sensitivity_pictures import sensitivity_pictures  # matplotlib

    return tuple(sensitivity_pictures(found))
