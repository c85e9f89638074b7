"""sensitivity.json and sensitivity.csv: every share with its interval, for programs. Same input, same bytes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from importlib.metadata import version
from typing import Any, Final

from synth.book.sensitivity.ranking import measure_first, ranked
from synth.book.sensitivity.sensitivity import REPEATED, OutputShares, Sensitivity
from synth.book.sensitivity.shares import GROUPS, HARMONICS, Share
from synth.book.sensitivity.varied import NEVER_VARIED
from synth.book.summary import Document, plain
from tuning_tables.sheet import sheet

VERSION = 1
DIGITS = 6
"""Decimals of shares; intervals are hundredths wide."""

METHOD: Final = (
    "first-order shares by random balance designs (RBD-FAST, bias corrected) on a Latin hypercube; 95 % "
    "intervals by a jackknife of groups"
)
HEAD: Final = ("label", "target_m_s", "output", "key", "share", "ci95_low", "ci95_high", "decided")
ALL: Final = "all"


def sensitivity_document(found: Sensitivity, created: str) -> Document:
    """The document; shares of all cases together are means over the cases in which the output varies."""
    config, trial = found.config, found.trial
    document: dict[str, Any] = {
        "format": "retarder-sensitivity",
        "version": VERSION,
        "created": created,
        "generator": {"name": "retarder-synth", "version": version("retarder-synth"), "config_sha256": config.sha256},
        "title": config.title,
        "method": METHOD,
        **asdict(trial),
        "repeated_points": REPEATED,
        "harmonics": HARMONICS,
        "groups": GROUPS,
        "measure_first": [measure_first(found.names, each) for each in found.overall],
        "parameters": [{"key": key, "name": name} for key, name in zip(found.keys, found.names, strict=True)],
        "held": {**dict.fromkeys(found.held, "set by the configuration"), **NEVER_VARIED},
        "ranges": {
            label: {one.key: {"nominal": one.nominal, "low": one.low, "high": one.high, "assumed": one.assumed}
                    for one in varied if one.key in found.keys}
            for label, varied in found.varied
        },
        "overall": [output_document(found.keys, each) for each in found.overall],
        "cases": [
            {
                "label": case.label,
                "target_m_s": case.target_m_s,
                "table": case.table_id,
                "outputs": [
                    {"nominal": nominal, **output_document(found.keys, each)}
                    for nominal, each in zip(case.nominal, case.outputs, strict=True)
                ],
            }
            for case in found.cases
        ],
    }  # fmt: skip
    plain_document: Document = plain(document)
    return plain_document


def output_document(keys: tuple[str, ...], found: OutputShares) -> dict[str, Any]:
    """One output; without shares where it does not vary."""
    head = {"output": found.output.name, "unit": found.output.unit, "mean": found.mean, "std": found.std}
    if not found.varies:
        return {**head, "shares": [], "noise": None, "together": None}
    shares = [{"key": key, **share_document(share)} for key, share in ranked(keys, found)]
    return {
        **head, "shares": shares, "noise": share_document(found.noise), "together": share_document(found.together),
    }  # fmt: skip


def share_document(share: Share) -> dict[str, Any]:
    """One share; `decided`: its interval leaves out 0."""
    low, high = share.ci95
    return {
        "share": round(share.value, DIGITS), "ci95": [round(low, DIGITS), round(high, DIGITS)],
        "decided": share.decided,
    }  # fmt: skip


def sensitivity_csv(found: Sensitivity) -> bytes:
    """One row a case, output and key; noise and together are keys too. Lines end as in RFC 4180."""
    return sheet(HEAD, csv_rows(found))


def csv_rows(found: Sensitivity) -> Iterator[tuple[str, ...]]:
    """The rows, those of all cases together first."""
    cases = [(ALL, "", found.overall), *((c.label, f"{c.target_m_s:g}", c.outputs) for c in found.cases)]
    for label, target, outputs in cases:
        for each in outputs:
            if each.varies:
                rows = (*ranked(found.keys, each), ("noise", each.noise), ("together", each.together))
                for key, share in rows:
                    figures = (f"{figure:.{DIGITS}f}" for figure in (share.value, *share.ci95))
                    yield label, target, each.output.name, key, *figures, str(share.decided).lower()
