"""summary.json: every figure of a book for programs, and the hashes of the files that belong to it.

The same book gives the same bytes; times of computing are not in it.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from importlib.metadata import version
from statistics import median
from typing import Any

import numpy as np

from synth.book.acceptance import CaseVerdict, Verdict
from synth.book.case_result import CaseResult
from synth.book.comparison.limit_cycle import hunting_report
from synth.book.comparison.measured import Measured
from synth.book.comparison.pressure_cycle import pressure_hunting
from synth.book.off_nominal.outcome import OffNominal
from synth.book.permissions.case_document import failed_document, results_document
from synth.book.permissions.overview import Overview, median_ratios
from synth.book.tune import Book
from synth.book.tuned_table import AnyEstimate
from synth.configuration.resolved_config import ResolvedConfig
from synth.problem.requirement_found import Finding
from synth.solver.any_time.surface_polish import SurfacePolish
from synth.solver.polish import Polish
from tuning_tables.canonical import LARGEST_EXACT_INTEGER

FORMAT = "retarder-summary"
VERSION = 1

Document = dict[str, Any]
"""A JSON object."""


def summary_of(book: Book, verdict: Verdict, file_hashes: Mapping[str, str]) -> Document:
    """The document of `book`; `file_hashes`: SHA-256 by file name, all files but summary.json itself."""
    document = {
        **summary_head((FORMAT, VERSION), book.config, book.created, verdict),
        "overall": overall(book.cases) | permitted(book.permissions),
        "cases": [case_of(case, word) for case, word in zip(book.cases, verdict.cases, strict=True)],
        "files": dict(file_hashes),
    }
    plain_document: Document = plain(document)
    return plain_document


def summary_head(kind: tuple[str, int], config: ResolvedConfig, created: str, verdict: Verdict) -> Document:
    """What the summaries of all tunes begin with; `kind`: format and version."""
    return {
        "format": kind[0],
        "version": kind[1],
        "created": created,
        "generator": {"name": "retarder-synth", "version": version("retarder-synth"), "config_sha256": config.sha256},
        "title": config.title,
        "config": json.loads(config.canonical_json()),
        "warnings": config.warnings,
        "parameters_assumed": [value.key for value in config.parameters if value.assumed],
        "criterion": config.criterion.sentence,
        "accepted": verdict.accepted,
        "verdict": verdict.sentence,
        "failed": [asdict(case) for case in verdict.failed],
    }


def overall(cases: tuple[CaseResult, ...]) -> Document:
    """Figures over the feasible cases; infeasible ones are only counted."""
    found = [case.comparison for case in cases if case.feasibility.feasible]
    figures: Document = {"cases": len(cases), "feasible": len(found)}
    if found:
        honest = [c.table.honesty for c in found]
        regrets = [c.regret for c in found if c.has_reference]
        figures |= {
            "highest_rms_m_s": max(c.table.statistics.rms_m_s for c in found),
            "median_regret": median(regrets) if regrets else None,
            "honesty": [min(honest), max(honest)],
        }
    return figures


def permitted(found: Overview | None) -> Document:
    """Figures of permissions over all cases that tell of some; empty where nobody asked."""
    if found is None:
        return {}
    return {"permission_median_ratios": median_ratios(found.cases), "permission_widest_half_ci95": found.widest}


def case_of(case: CaseResult, verdict: CaseVerdict) -> Document:
    """Everything about one case."""
    found = case.comparison
    served, entry = case.feasibility.served_m_s, case.plant.entry
    return {
        "id": case.table.id,
        "table": f"tables/{case.table.id}.json",
        "label": case.label,
        "category": case.plant.cut.category,
        "mass_t": case.plant.cut.mass_t,
        "top_stage": case.plant.top_stage,
        "target_speed_m_s": case.target_speed_m_s,
        "verdict": verdict.word,
        "missed_limits": verdict.judgement.missed,
        "undecided_limits": verdict.judgement.undecided,
        "feasible": verdict.feasible,
        "why_infeasible": verdict.obstacle or None,
        "within_reach": verdict.within_reach or None,
        "advice": verdict.advice,
        "entry_m_s": (entry.low_m_s, entry.high_m_s),
        "served_entry_m_s": served,
        "unavoidable_rms_m_s": case.feasibility.unavoidable.rms_m_s,
        "unavoidable_ci95_m_s": case.feasibility.unavoidable.rms_ci95_m_s,
        "predicted": asdict(case.table.predicted),
        "simulated": measured_of(found.table),
        "brake_power": asdict(case.brake_power),
        "honesty": found.table.honesty,
        "honesty_ci95": found.table.honesty_ci95,
        "regret": found.regret,
        "regret_ci95": found.regret_ci95,
        "at_rest_ratio": None if found.at_rest is None else found.at_rest.table_ratio,
        "at_rest_ratio_ci95": None if found.at_rest is None else found.at_rest.table_ratio_ci95,
        "best_baseline": found.best_baseline.name if found.best_baseline else None,
        "comparison": {entry.name: measured_of(entry) for entry in found.entries},
        "requirement": None if case.finding is None else requirement_of(case.finding),
        "estimate": None if case.estimate is None else estimate_of(case.estimate),
        "permissions": None if case.permissions is None else results_document(case.permissions),
        "permissions_failed": {} if case.permissions is None else failed_document(case.permissions),
        "pareto_front": None if case.front is None else case.front.document,
        "off_nominal": {each.key: off_nominal_of(each) for each in case.off_nominal},
        "warnings": case.warnings,
        "grid_check": asdict(case.grid),
        "polish": polish_of(case.polish),
        "ties": case.study.policy_map.ties,
        "escaped_probability": case.predicted.escaped,
        "hunting": {
            "pressure": [{"stage": stage, **asdict(cycle)} for stage, cycle in pressure_hunting(case.plant)],
            "speed": [asdict(each) for each in hunting_report(case.plant, case.study.table_lines)],
        },
    }


def measured_of(entry: Measured) -> Document:
    """The statistics of one controller, with what it promised, and the ratio of the table to it."""
    return {
        **asdict(entry.statistics),
        "predicted_rms_m_s": entry.predicted_rms_m_s,
        "table_ratio": entry.table_ratio,
        "table_ratio_ci95": entry.table_ratio_ci95,
    }


def off_nominal_of(found: OffNominal) -> Document:
    """What became of the table in one condition, or why no plant can be so."""
    if found.outcome is None:
        return {"name": found.name, "impossible": found.impossible}
    return {"name": found.name, **asdict(found.outcome)}


def polish_of(polish: Polish | SurfacePolish) -> Document:
    """How the search for the lines of least cost ended."""
    return {
        "converged": polish.converged,
        "status": polish.status,
        "evaluations": polish.evaluations,
        "cost_before_m2_s2": polish.cost_before,
        "cost_after_m2_s2": polish.cost_after,
    }


def estimate_of(made: AnyEstimate) -> Document:
    """How lines for the estimated speed were designed; shifts that change along the path only where there are some."""
    shift, *along_path = made.trim_m_s
    return {
        "error_m_s": made.error_m_s,
        "trim_m_s": shift,
        **({"trim_along_path_m_s": along_path} if along_path else {}),
        "tuning_rms_before_trim_m_s": made.rms_before_m_s,
        "tuning_rms_m_s": made.rms_after_m_s,
    }


def requirement_of(finding: Finding) -> Document:
    """What keeping the criterion's requirement took, with its sentence."""
    return {**asdict(finding), "sentence": finding.sentence}


def plain(value: Any) -> Any:
    """`value` as JSON holds it: tuples as lists, numbers of numpy as those of Python, NaN and infinities as null.

    Whole numbers that a double cannot hold become strings.
    """
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, int) and abs(value) > LARGEST_EXACT_INTEGER:
        return str(value)
    return value
