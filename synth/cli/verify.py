"""`retarder-synth verify`: the independent checker on exported tables; neither solver nor numpy is imported."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from synth.frame.printed_numbers import counted
from synth.frame.terminal.manner import Manner
from synth.frame.terminal.printed_page import Printed, PrintedVerdict
from synth.frame.terminal.telling import INPUT_FAULT, LIMITS_MISSED, say
from synth.frame.version import Concerned, concerned

if TYPE_CHECKING:
    from synth.checker.aim.table import Aim
    from synth.checker.finding import Finding
    from synth.checker.passages.table import PassageTable
    from synth.checker.statistics import ExitFigures
    from synth.checker.table_reading import Table
    from synth.checker.verdict import AimVerdict, PassageVerdict, TableVerdict, Verdict


def verify_command(source: Path, passes: int, seed: int, output: Path | None, manner: Manner) -> int:
    """Check what is at `source` and print it, a line a table, and on a page in `output`; the exit code."""
    from synth.checker.code_export import code_at
    from synth.checker.finding import NothingToVerifyError
    from synth.checker.verdict import verify

    if output is not None:
        from synth.cli.printed_report import require_place

        require_place("verify", output)
    try:
        verdict = verify(source, passes, seed, manner.step)
    except NothingToVerifyError as fault:
        say(str(fault))
        return INPUT_FAULT
    defects = concerned(lambda: (each.document for each in (*tables_of(verdict), *code_at(source))))
    code = verdict.code or (LIMITS_MISSED if any(each.defect.unsafe for each in defects) else 0)
    told = [*words(verdict), *(each.sentence for each in defects)]
    if output is not None:
        from synth.cli.printed_report import write_report

        page: list[Printed] = [verdict_words(verdict, code), *told]
        write_report("verify", f"Check of {source.name}", page, source, output, steps(code))
    manner.give(lambda: document(verdict, defects, code), lambda: [*told, verdict_words(verdict, code)])
    return code


def tables_of(verdict: Verdict) -> list[Table | Aim | PassageTable]:
    """All tables that were read."""
    lines, passages = ([each.table for each in judged] for judged in (verdict.tables, verdict.passages))
    return [*lines, *(each.aim for each in verdict.aims), *passages]


def document(verdict: Verdict, defects: Sequence[Concerned], code: int) -> dict[str, Any]:
    """The verdict for programs."""
    return {
        "path": str(verdict.path),
        "confirmed": code == 0,
        "exit_code": code,
        "passes": verdict.passes,
        "seed": verdict.seed,
        "files": list(verdict.files),
        "tables": [table_document(each) for each in verdict.tables],
        "aims": [aim_document(each) for each in verdict.aims],
        "passages": [passages_document(each) for each in verdict.passages],
        "findings": [
            {"about": finding.about, "kind": finding.kind.value, "sentence": finding.sentence}
            for finding in verdict.findings
        ],
        "known_defects": [each.document for each in defects],
    }


def table_document(each: TableVerdict) -> dict[str, Any]:
    """One table's verdict for programs."""
    return {
        "id": each.table.id,
        "ok": not each.findings,
        "skipped": each.skipped,
        "exit_gap_m_s": each.exit_gap_m_s,
        "predicted_rms_m_s": each.table.predicted_rms_m_s,
        "simulated": simulated_document(each.figures),
    }


def simulated_document(figures: ExitFigures | None) -> dict[str, Any] | None:
    """What coarse passes gave, for programs."""
    if figures is None:
        return None
    return {
        "passes": figures.passes,
        "rms_m_s": figures.rms_m_s,
        "rms_ci95_m_s": figures.rms_ci95_m_s,
        "bias_m_s": figures.bias_m_s,
        "passes_as_they_come": figures.plain,
        "overspeed_of_these": figures.over,
        "stalls_of_these": figures.stalls,
        "switchings": figures.switchings,
    }


def aim_document(each: AimVerdict) -> dict[str, Any]:
    """One aim table's verdict for programs."""
    speeds = [speed for rows in each.aim.speeds for row in rows for speed in row]
    return {
        "id": each.aim.id,
        "ok": not each.findings,
        "nodes": len(speeds),
        "nodes_without_speed": speeds.count(None),
    }


def aim_words(each: AimVerdict) -> list[str]:
    """One aim table's verdict in lines."""
    told = aim_document(each)
    checked = f"an aim table of {told['nodes']} nodes, {told['nodes_without_speed']} without an exit speed"
    return [f"{each.aim.id}: {state(each.findings)}; {checked}", *finding_lines(each.findings)]


def passages_document(each: PassageVerdict) -> dict[str, Any]:
    """The verdict of one table for point sensors, for programs."""
    return {
        "id": each.table.id,
        "ok": not each.findings,
        "passages": len(each.table.passages),
        "predicted_rms_m_s": each.table.predicted_rms_m_s,
        "simulated": simulated_document(each.figures),
    }


def passages_words(each: PassageVerdict) -> list[str]:
    """The verdict of one table for point sensors in lines."""
    checked = f"{len(each.table.passages)} passages over point sensors; {checked_words(each)}"
    return [f"{each.table.id}: {state(each.findings)}; {checked}", *finding_lines(each.findings)]


def checked_words(each: TableVerdict | PassageVerdict) -> str:
    """What the coarse passes gave, or why there are none."""
    if each.figures is None:
        return f"not simulated: {each.skipped}"
    low, high = each.figures.rms_ci95_m_s
    return (
        f"rms {each.figures.rms_m_s:.3f} [{low:.3f}, {high:.3f}] m/s in {each.figures.passes} passes, "
        f"{each.table.predicted_rms_m_s:.3f} predicted"
    )


def state(findings: Sequence[Finding]) -> str:
    """How many findings there are, in words."""
    return f"{len(findings)} finding{'s' if len(findings) > 1 else ''}" if findings else "ok"


def finding_lines(findings: Sequence[Finding]) -> list[str]:
    """The findings about one table."""
    return [f"  {finding.kind.value}: {finding.sentence}" for finding in findings]


def steps(code: int) -> tuple[str, ...]:
    """What to do first."""
    if code == 0:
        return ("Load the tables, and try them on the track: this check knows nothing of your retarder.",)
    return ("Do not load these tables: make them again, or copy them again from where they were made.",)


def words(verdict: Verdict) -> list[str]:
    """The verdict in lines."""
    lines = []
    for each in verdict.tables:
        lines.append(f"{each.table.id}: {state(each.findings)}; {checked_words(each)}")
        lines += finding_lines(each.findings)
    lines += [line for each in verdict.aims for line in aim_words(each)]
    lines += [line for each in verdict.passages for line in passages_words(each)]
    return [*lines, *(f"{finding.about}: {finding.kind.value}: {finding.sentence}" for finding in verdict.others)]


def verdict_words(verdict: Verdict, code: int) -> PrintedVerdict:
    """What it comes to."""
    found = state(verdict.findings) if verdict.findings else "nothing found"
    found += ", but made by a version with an unsafe defect" if code and not verdict.code else ""
    count = len(tables_of(verdict))
    return PrintedVerdict(code == 0, f"{counted(count, 'table')}, {counted(len(verdict.files), 'file')}: {found}")
