"""`retarder-synth verify`: the independent checker on exported tables; neither solver nor numpy is imported."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from synth.cli import INPUT_FAULT, say

if TYPE_CHECKING:
    from synth.checker.verdict import TableVerdict, Verdict


def verify_command(source: Path, passes: int, seed: int, as_json: bool) -> int:
    """Check what is at `source` and print it, a line a table; the exit code."""
    from synth.checker.finding import NothingToVerifyError
    from synth.checker.verdict import verify

    try:
        verdict = verify(source, passes, seed)
    except NothingToVerifyError as fault:
        say(str(fault))
        return INPUT_FAULT
    if as_json:
        print(json.dumps(document(verdict), indent=1, ensure_ascii=False))
    else:
        print(*words(verdict), sep="\n")
    return verdict.code


def document(verdict: Verdict) -> dict[str, Any]:
    """The verdict for programs."""
    return {
        "path": str(verdict.path),
        "confirmed": verdict.code == 0,
        "exit_code": verdict.code,
        "passes": verdict.passes,
        "seed": verdict.seed,
        "files": list(verdict.files),
        "tables": [table_document(each) for each in verdict.tables],
        "findings": [
            {"about": finding.about, "kind": finding.kind.value, "sentence": finding.sentence}
            for finding in verdict.findings
        ],
    }


def table_document(each: TableVerdict) -> dict[str, Any]:
    """One table's verdict for programs."""
    figures = each.figures
    return {
        "id": each.table.id,
        "ok": not each.findings,
        "skipped": each.skipped,
        "exit_gap_m_s": each.exit_gap_m_s,
        "simulated": figures
        and {
            "rms_m_s": figures.rms_m_s,
            "rms_ci95_m_s": figures.rms_ci95_m_s,
            "bias_m_s": figures.bias_m_s,
            "passes_as_they_come": figures.plain,
            "overspeed_of_these": figures.over,
            "stalls_of_these": figures.stalls,
            "switchings": figures.switchings,
        },
    }


def words(verdict: Verdict) -> list[str]:
    """The verdict in lines."""
    lines = []
    for each in verdict.tables:
        figures, table = each.figures, each.table
        count = len(each.findings)
        state = f"{count} finding{'s' if count > 1 else ''}" if count else "ok"
        if figures is not None:
            low, high = figures.rms_ci95_m_s
            checked = (
                f"rms {figures.rms_m_s:.3f} [{low:.3f}, {high:.3f}] m/s in {figures.passes} passes, "
                f"{table.predicted_rms_m_s:.3f} predicted"
            )
        else:
            checked = f"not simulated: {each.skipped}"
        lines.append(f"{table.id}: {state}; {checked}")
        lines += [f"  {finding.kind.value}: {finding.sentence}" for finding in each.findings]
    lines += [f"{finding.about}: {finding.kind.value}: {finding.sentence}" for finding in verdict.others]
    count = len(verdict.findings)
    found = f"{count} finding{'s' if count > 1 else ''}" if count else "nothing found"
    return [*lines, f"{len(verdict.tables)} tables, {len(verdict.files)} files: {found}"]
