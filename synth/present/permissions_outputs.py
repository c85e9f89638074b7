"""What permissions of the hardware leave in their directory: a picture, and last of all the summary."""

from __future__ import annotations

from pathlib import Path

from synth.book.output_directory import PERMISSIONS_PICTURES, SUMMARY, remove_stale
from synth.book.permissions.document import permissions_document
from synth.book.permissions.permission import AllPermissions
from synth.book.summary import Document
from synth.configuration.resolved_config import ResolvedConfig
from synth.present.outputs import file_hashes
from tuning_tables import write_atomically
from tuning_tables.canonical import canonical_json


def write_permissions(config: ResolvedConfig, told: AllPermissions, created: str, directory: Path) -> Document:
    """Write everything; the summary as written. Raises `OSError`."""
    files: list[Path] = []
    if config.output.plots:
        from synth.present.plots.permissions import permissions_picture  # matplotlib
        from synth.present.plots.picture import save_picture

        files += save_picture(permissions_picture(config.title, told.cases), directory / "plots")
    hashes = file_hashes(directory, files)
    remove_stale(directory, set(hashes), pictures=PERMISSIONS_PICTURES)
    summary = permissions_document(config, told, created, hashes)
    write_atomically(directory / SUMMARY, canonical_json(summary) + b"\n")
    return summary
