"""A retune in sentences, and as a document for programs."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from importlib.metadata import version

from synth.book.summary import Document, plain
from synth.yard.measured_passes.retune.retune import Retuned

VERSION = 1


def retune_sentences(found: Retuned) -> tuple[str, ...]:
    """What was found, the most important first."""
    changed, n = found.changed, found.estimate.passes
    kept = len(found.gains) - len(changed)
    failed = tuple(
        f"{case.name}: no new table, {'the old one is kept' if case.case in found.old else 'and no old one'}: "
        f"{case.reason}"
        for case in found.failed
    )
    if not changed:
        return (
            f"within noise: no table tuned for what {n} passes say is better beyond doubt than the old one in any of "
            f"{len(found.gains)} cases, judged together; no book is written",
            *failed,
        )
    most = min(changed, key=lambda gain: gain.ratio)
    low, high = most.ratio_ci95
    return (
        f"{len(changed)} of {len(found.gains)} cases get new tables, from {n} passes; {kept} are within noise "
        "and keep their lines",
        f"most is gained for {most.label} to {most.target_m_s:g} m/s: rms {most.old_rms_m_s:.4f} to "
        f"{most.new_rms_m_s:.4f} m/s, ratio {most.ratio:.3f} [{low:.3f}, {high:.3f}] (95 %)",
        *failed,
    )


def retune_summary(found: Retuned, file_hashes: Mapping[str, str]) -> Document:
    """The document; `files` names no book where nothing is better."""
    estimate = found.estimate
    document = {
        "format": "retune-summary",
        "version": VERSION,
        "created": found.created,
        "generator": {
            "name": "retarder-synth", "version": version("retarder-synth"), "config_sha256": found.identified.sha256,
        },
        "title": found.config.title,
        "config": json.loads(found.identified.canonical_json()),
        "config_before_sha256": found.config.sha256,
        "provenance": f"identified from {estimate.passes} passes",
        "refused": not found.changed,
        "sentences": retune_sentences(found),
        "numbers": [
            {"key": one.key, "unit": one.unit, "before": one.value(0.0), "value": one.value(float(estimate.u[i])),
             "ci95": estimate.interval(i)}
            for i, one in enumerate(estimate.unknowns)
        ],
        "cases": [
            {"label": g.label, "target_speed_m_s": g.target_m_s, "old_rms_m_s": g.old_rms_m_s,
             "new_rms_m_s": g.new_rms_m_s, "ratio": g.ratio, "ratio_ci95": g.ratio_ci95, "p_value": g.p_value,
             "changed": g in found.changed}
            for g in found.gains
        ],
        "failed": [asdict(case) for case in found.failed],
        "files": dict(file_hashes),
    }  # fmt: skip
    plain_document: Document = plain(document)
    return plain_document
