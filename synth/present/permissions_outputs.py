"""What permissions of the hardware leave in their directory: a picture, and last of all the summary."""

from __future__ import annotations

from synth.book.permissions.document import permissions_document
from synth.book.permissions.permission import AllPermissions
from synth.book.summary import Document
from synth.configuration.resolved_config import ResolvedConfig
from synth.frame.results_directory import ResultsDirectory
from tuning_tables.canonical import canonical_json


def write_permissions(
    config: ResolvedConfig, told: AllPermissions, created: str, directory: ResultsDirectory
) -> Document:
    """Write everything; the summary as written. Raises `OSError`."""
    if config.output.plots:
        from synth.present.plots.permissions import permissions_picture  # matplotlib
        from synth.present.plots.picture import picture_files

        directory.write_all(picture_files([permissions_picture(config.title, told.cases)], "plots"))
    summary = permissions_document(config, told, created, directory.written)
    directory.finish(canonical_json(summary) + b"\n")
    return summary
