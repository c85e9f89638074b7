"""summary.json of a tune for point sensors: every figure for programs, and the hashes of the files of the tune."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from synth.book.acceptance import CaseVerdict, Verdict
from synth.book.comparison.measured import honesty_of
from synth.book.sensors.sensor_case import SensorCase
from synth.book.sensors.sensor_tune import SensorBook
from synth.book.summary import Document, plain, summary_head
from synth.simulation.replicates import Interval
from synth.solver.passage_polish import PassagePolish

FORMAT = "sensor-summary"
VERSION = 1


def sensor_summary(book: SensorBook, verdict: Verdict, file_hashes: Mapping[str, str]) -> Document:
    """The document of `book`; `file_hashes`: SHA-256 by file name, all files but summary.json itself."""
    document = {
        **summary_head((FORMAT, VERSION), book.config, book.created, verdict),
        "cases": [case_of(case, word) for case, word in zip(book.cases, verdict.cases, strict=True)],
        "files": dict(file_hashes),
    }
    plain_document: Document = plain(document)
    return plain_document


def case_of(case: SensorCase, verdict: CaseVerdict) -> Document:
    """Everything about one case."""
    predicted = case.table.predicted
    honest, honest_ci95 = honesty_of(predicted.rms_m_s, predicted.passes, case.statistics)
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
        "predicted": asdict(predicted),
        "simulated": asdict(case.statistics),
        "honesty": honest,
        "honesty_ci95": honest_ci95,
        "brake_power": asdict(case.brake_power),
        "unavoidable_rms_m_s": case.unavoidable.rms_m_s,
        "unavoidable_ci95_m_s": case.unavoidable.rms_ci95_m_s,
        "passages": passages_of(case),
        "warnings": case.warnings,
        "polish": polish_of(case.polish),
        "escaped_probability": case.predicted.escaped,
    }


def passages_of(case: SensorCase) -> list[Document]:
    """What came of the passages at which is decided."""
    return [
        {
            "sensor": row.sensor,
            "axle": row.axle,
            "path_m": row.path_m,
            **shares("unfinished", unfinished),
            **shares("mistaken", mistaken),
        }
        for row, unfinished, mistaken in zip(
            case.table.passages, case.heard.unfinished, case.heard.mistaken, strict=True
        )
    ]


def shares(name: str, found: tuple[float, Interval]) -> dict[str, float | Sequence[float]]:
    """A share and its interval under `name`."""
    return {name: found[0], f"{name}_ci95": found[1]}


def polish_of(polish: PassagePolish) -> dict[str, Any]:
    """How the search for the switching speeds of least cost ended."""
    return {
        "converged": polish.converged,
        "status": polish.status,
        "evaluations": polish.evaluations,
        "cost_before_m2_s2": polish.cost_before,
        "cost_after_m2_s2": polish.cost_after,
    }
