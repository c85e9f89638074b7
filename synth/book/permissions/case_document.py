"""What permissions give in one case, as every summary.json that tells of them has it."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from synth.book.permissions.permission import CasePermissions


def failed_document(case: CasePermissions) -> dict[str, str]:
    """Why a permission cannot be told, by its name: `permissions_failed` of a case."""
    return {each.permission.value: each.reason for each in case.failed}


def results_document(case: CasePermissions) -> dict[str, Any]:
    """Figures by name of the permission: `permissions` of a case."""
    return {
        each.permission.value: {
            **asdict(each.statistics),
            "predicted_rms_m_s": each.predicted_rms_m_s,
            "ratio": each.ratio,
            "ratio_ci95": each.ratio_ci95,
        }
        for each in case.results
    }
