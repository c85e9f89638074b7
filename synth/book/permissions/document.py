"""Permissions of the hardware for programs: what each gives in every case, as summary.json of the command."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from importlib.metadata import version

from synth.book.permissions.case_document import failed_document, results_document
from synth.book.permissions.overview import median_ratios
from synth.book.permissions.permission import AllPermissions, CasePermissions
from synth.book.summary import Document, plain
from synth.configuration.resolved_config import ResolvedConfig

VERSION = 1


def permissions_document(
    config: ResolvedConfig, told: AllPermissions, created: str, hashes: Mapping[str, str]
) -> Document:
    """The document; `hashes`: SHA-256 by name of the other files."""
    document: Document = plain(
        {
            "format": "permissions-summary",
            "version": VERSION,
            "created": created,
            "generator": {
                "name": "retarder-synth",
                "version": version("retarder-synth"),
                "config_sha256": config.sha256,
            },
            "title": config.title,
            "median_ratios": median_ratios(told.cases),
            "cases": [case_document(case) for case in told.cases],
            "failed": [asdict(case) for case in told.failed],
            "files": dict(hashes),
        }
    )
    return document


def case_document(case: CasePermissions) -> Document:
    """One case."""
    return {
        "label": case.label,
        "target_speed_m_s": case.target_speed_m_s,
        "as_configured": {**asdict(case.table), "predicted_rms_m_s": case.predicted_rms_m_s},
        "permissions": results_document(case),
        "permissions_failed": failed_document(case),
    }
