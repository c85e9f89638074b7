"""Planting faults in the files of a tune, and looking for the finding that each must give."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

from synth.checker.finding import Kind
from synth.checker.verdict import DAMAGED, NOT_CONFIRMED, Verdict, verify
from tuning_tables.json_text import document_checksum

Document = dict[str, Any]


def rewrite(file: Path, change: Callable[[Document], None]) -> None:
    """Change the document of a table and give it the checksum that the changed content has."""
    document = json.loads(file.read_text(encoding="utf-8"))
    change(document)
    document["crc32"] = document_checksum(document)
    file.write_text(json.dumps(document, indent=1, ensure_ascii=False), encoding="utf-8")


def alone(tuned: Path) -> Path:
    """The first JSON table, with the summary beside it but no other export to contradict it."""
    for name in ("book.h5", "c", "st"):
        path = tuned / name
        shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)
    return min((tuned / "tables").glob("*.json"))


def sentences(verdict: Verdict, kind: Kind) -> list[str]:
    return [f"{finding.about}: {finding.sentence}" for finding in verdict.findings if finding.kind is kind]


def found(verdict: Verdict, kind: Kind, words: str) -> bool:
    """Whether a finding of this kind says `words`, a regular expression; and the exit code is the kind's."""
    code = NOT_CONFIRMED if kind is Kind.CLAIM else DAMAGED
    assert verdict.code == code, verdict.findings
    assert any(re.search(words, sentence) for sentence in sentences(verdict, kind)), verdict.findings
    return True


def look(path: Path) -> Verdict:
    """The verdict with next to no passes: they have no part in what files say of one another or hold by themselves."""
    return verify(path, 2, 1)


def judged(path: Path) -> Verdict:
    """The verdict with few passes, which contradict no claim that is right."""
    return verify(path, 100, 1)


def claim_in_summary(folder: Path, document: Document) -> None:
    """Let summary.json in `folder` state of the table in `document` what that states of itself."""
    file = folder / "summary.json"
    summary = json.loads(file.read_text(encoding="utf-8"))
    (case,) = (case for case in summary["tables"]["cases"] if case["id"] == document["id"])
    validated = document["validated"]
    low, high = validated["rms_ci95_m_s"]
    rms = {"value": validated["rms_m_s"], "low95": low, "high95": high, "n": validated["passes"]}
    case.update({f"predicted_{name}": value for name, value in document["predicted"].items()}, rms_m_s=rms)
    file.write_text(json.dumps(summary, ensure_ascii=False), encoding="utf-8")
