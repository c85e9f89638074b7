"""What shares of variance leave in their directory: document, CSV, pictures, report, and last of all the summary."""

from __future__ import annotations

from importlib.metadata import version
from typing import Final

from synth.book.sensitivity.document import VERSION, sensitivity_csv, sensitivity_document
from synth.book.sensitivity.sensitivity import Sensitivity
from synth.book.summary import Document
from synth.frame.results_directory import ResultsDirectory
from synth.present.plots.picture import Picture, picture_files
from synth.present.report.sensitivity_report import SensitivityReport, sensitivity_page
from tuning_tables.canonical import canonical_json

DOCUMENT: Final = "sensitivity.json"
TABLE: Final = "sensitivity.csv"


def write_sensitivity(found: Sensitivity, created: str, directory: ResultsDirectory) -> Document:
    """Write everything; the document as written. Raises `OSError`."""
    output, pictures = found.config.output, drawn(found)
    document = sensitivity_document(found, created)
    directory.write(DOCUMENT, canonical_json(document) + b"\n")
    directory.write(TABLE, sensitivity_csv(found))
    if output.plots:
        directory.write_all(picture_files(pictures, "plots"))
    if output.report:
        page = sensitivity_page(SensitivityReport(found, created, directory.written, pictures))
        directory.write("report.html", page.encode())
    summary = {
        "format": "sensitivity-summary",
        "version": VERSION,
        "created": created,
        "generator": {"name": "retarder-synth", "version": version("retarder-synth"),
                      "config_sha256": found.config.sha256},
        "measure_first": document["measure_first"],
        "files": directory.written,
    }  # fmt: skip
    directory.finish(canonical_json(summary) + b"\n")
    return document


def drawn(found: Sensitivity) -> tuple[Picture, ...]:
    """The pictures, if anybody wants them."""
    if not (found.config.output.plots or found.config.output.report):
        return ()
    from synth.present.plots.sensitivity_pictures import sensitivity_pictures  # matplotlib

    return tuple(sensitivity_pictures(found))
