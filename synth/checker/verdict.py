"""All checks of one source, and what they come to."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from synth.checker.aim.sense import claim_faults
from synth.checker.aim.sense import sense as aim_sense
from synth.checker.aim.table import Aim
from synth.checker.claims import own_faults, simulated_faults
from synth.checker.coarse_simulation import NotModelledError, simulate
from synth.checker.content import require_right_crc32
from synth.checker.estimator_sense import estimator_faults
from synth.checker.exports import ExportReport, check_exports
from synth.checker.finding import DamagedError, Finding, Kind
from synth.checker.passages.sense import sense as passage_sense
from synth.checker.passages.simulation import simulate as simulate_passages
from synth.checker.passages.table import PassageTable
from synth.checker.plant import UnusableConfigError
from synth.checker.source import Source, read_source
from synth.checker.statistics import ExitFigures, figures_of
from synth.checker.summary import DEFAULT_PREDICTION_RATIO, OtherSummaryError, Summary, read_summary
from synth.checker.table_reading import Table
from synth.checker.table_sense import exit_gap_m_s, sense

V = TypeVar("V", "TableVerdict", "PassageVerdict")

CONFIRMED, NOT_CONFIRMED, DAMAGED = 0, 1, 3


@dataclass(frozen=True)
class TableVerdict:
    """One table: what was found, what the coarse simulation gave; `skipped` says why there was none."""

    table: Table
    findings: tuple[Finding, ...]
    figures: ExitFigures | None
    skipped: str | None
    exit_gap_m_s: float


@dataclass(frozen=True)
class AimVerdict:
    """One aim table, and what was found."""

    aim: Aim
    findings: tuple[Finding, ...]


@dataclass(frozen=True)
class PassageVerdict:
    """One table for point sensors, what was found, what the coarse simulation gave; `skipped` as of `TableVerdict`."""

    table: PassageTable
    findings: tuple[Finding, ...]
    figures: ExitFigures | None
    skipped: str | None


@dataclass(frozen=True)
class Verdict:
    """Everything about a source; `others` are findings that belong to no sound table."""

    path: Path
    passes: int
    seed: int
    tables: tuple[TableVerdict, ...]
    others: tuple[Finding, ...]
    files: tuple[str, ...]
    aims: tuple[AimVerdict, ...] = ()
    passages: tuple[PassageVerdict, ...] = ()

    @property
    def findings(self) -> tuple[Finding, ...]:
        """All of them."""
        verdicts: tuple[TableVerdict | AimVerdict | PassageVerdict, ...] = (*self.tables, *self.aims, *self.passages)
        return tuple(finding for each in verdicts for finding in each.findings) + self.others

    @property
    def code(self) -> int:
        """0 all confirmed, 1 a claim is not, 3 something is damaged or disagrees."""
        kinds = {finding.kind for finding in self.findings}
        if kinds & {Kind.DAMAGED, Kind.DISAGREES}:
            return DAMAGED
        return NOT_CONFIRMED if kinds else CONFIRMED


def untold(sentence: str) -> None:
    """Nobody asks how far it is."""


def verify(path: Path, passes: int, seed: int, tell: Callable[[str], None] = untold) -> Verdict:
    """Check the table, book or directory at `path`, and `tell` each step; `NothingToVerifyError` where there is nothing
    to read."""
    require_right_crc32()
    source = read_source(path)
    tell(f"read: {len(source.tables) + len(source.aims) + len(source.passages)} tables")
    report = check_exports(source, source.folder) if source.folder else ExportReport((), ())
    tell(f"compared with: {', '.join(report.files) or 'no exports'}")
    # The summary of a tune says nothing of tables to aim by.
    of_tables = bool(source.tables or source.passages or not source.aims)
    summary, summary_findings = summary_beside(source) if of_tables else (None, [])
    found = [*source.findings, *report.findings, *summary_findings]
    tables = tuple(told(judge(table, summary, passes, seed, found), tell) for table in source.tables)
    aims = tuple(judge_aim(aim, found) for aim in source.aims)
    passages = tuple(told(judge_passages(each, summary, passes, seed, found), tell) for each in source.passages)
    ids = {each.id for each in source.tables} | {each.id for each in source.aims}
    ids |= {each.id for each in source.passages}
    others = tuple(finding for finding in found if finding.about not in ids)
    files = (*source.files, *report.files, *([summary.path.name] if summary else []))
    return Verdict(path, passes, seed, tables, others, files, aims, passages)


def told(judged: V, tell: Callable[[str], None]) -> V:
    """`judged`, of which is told that it is."""
    tell(f"judged: {judged.table.id}")
    return judged


def judge_aim(aim: Aim, found: list[Finding]) -> AimVerdict:
    """Everything about one aim table; `found` are findings of files, some of them about it."""
    findings = [finding for finding in found if finding.about == aim.id]
    senseless = [Finding(Kind.DAMAGED, aim.id, sentence) for sentence in aim_sense(aim)]
    claims = [] if senseless else [Finding(Kind.CLAIM, aim.id, sentence) for sentence in claim_faults(aim)]
    return AimVerdict(aim, (*findings, *senseless, *claims))


def judge_passages(
    table: PassageTable, summary: Summary | None, passes: int, seed: int, found: list[Finding]
) -> PassageVerdict:
    """Everything about one table for point sensors; `found` are findings of files, some of them about it."""
    senseless = [Finding(Kind.DAMAGED, table.id, sentence) for sentence in passage_sense(table)]
    judged = judge_figures(table, summary, passes, seed, bool(senseless))
    findings = [finding for finding in found if finding.about == table.id]
    return PassageVerdict(table, (*findings, *senseless, *judged.findings), judged.figures, judged.skipped)


def judge(table: Table, summary: Summary | None, passes: int, seed: int, found: list[Finding]) -> TableVerdict:
    """Everything about one table; `found` are findings of files, some of them about it."""
    senseless = list(sense(table))
    judged = judge_figures(table, summary, passes, seed, bool(senseless))
    findings = [finding for finding in found if finding.about == table.id]
    findings += [*senseless, *judged.findings]
    return TableVerdict(table, tuple(findings), judged.figures, judged.skipped, exit_gap_m_s(table))


@dataclass(frozen=True)
class FigureVerdict:
    """What was found of the figures of a table."""

    findings: tuple[Finding, ...]
    figures: ExitFigures | None
    skipped: str | None


def judge_figures(
    table: Table | PassageTable, summary: Summary | None, passes: int, seed: int, senseless: bool
) -> FigureVerdict:
    """The figures of a table against one another, against the summary, and against coarse passes of its plant."""
    prediction_ratio = summary.prediction_ratio() if summary else DEFAULT_PREDICTION_RATIO
    disagreements: list[str] = []
    claims = list(own_faults(table, prediction_ratio))
    figures, skipped = None, None
    if senseless:
        skipped = "it makes no sense"
    elif summary is None:
        skipped = "no usable summary.json of a tune is beside it, so the plant is not known"
    elif summary.config_sha256 != table.config_sha256:
        skipped = "summary.json beside it belongs to another configuration"
    else:
        disagreements += summary.case_faults(table)
        try:
            plant = summary.plant(table)
            if isinstance(table, Table):
                disagreements += estimator_faults(table.estimator, plant, summary.estimating)
                disagreements += summary.command_faults(table)
                coarse = simulate(plant, table, passes, seed)
            else:
                coarse = simulate_passages(plant, table, passes, seed)
            figures = figures_of(coarse, table.target_m_s)
            claims += simulated_faults(table, figures, prediction_ratio)
        except UnusableConfigError as fault:
            disagreements.append(str(fault))
            skipped = "the plant is not known"
        except NotModelledError as fault:
            claims.append(f"its figures cannot be confirmed: {fault}")
            skipped = str(fault)
    findings = [Finding(Kind.DISAGREES, table.id, sentence) for sentence in disagreements]
    findings += [Finding(Kind.CLAIM, table.id, sentence) for sentence in claims]
    return FigureVerdict(tuple(findings), figures, skipped)


def summary_beside(source: Source) -> tuple[Summary | None, list[Finding]]:
    """The summary that belongs to the source, and what is wrong with it and, for a directory, with its files."""
    here = source.folder or source.path.parent
    places = [here] if source.folder else [here, here.parent]
    file = next((place / "summary.json" for place in places if (place / "summary.json").is_file()), None)
    if file is None:
        return None, []
    try:
        summary = read_summary(file)
    except OtherSummaryError:
        return None, []
    except DamagedError as fault:
        return None, [Finding(Kind.DAMAGED, "summary.json", str(fault))] if source.folder else []
    fault_of_config = summary.config_fault()
    if fault_of_config is not None:
        return None, [Finding(Kind.DISAGREES, "summary.json", fault_of_config)]
    return summary, list(directory_findings(source, summary)) if source.folder else []


def directory_findings(source: Source, summary: Summary) -> Iterator[Finding]:
    """Files and tables that the summary of a directory tells otherwise."""
    try:
        yield from (Finding(Kind.DISAGREES, name, sentence) for name, sentence in summary.file_faults())
    except DamagedError as fault:
        yield Finding(Kind.DAMAGED, "summary.json", f"a file that it lists is odd: {fault}")
    there: tuple[Table | PassageTable, ...] = (*source.tables, *source.passages)
    for name in sorted(summary.cases.keys() - {table.id for table in there}):
        yield Finding(Kind.DISAGREES, "summary.json", f"it tells of {name}, which is not there")
    for table in there:
        if table.config_sha256 != summary.config_sha256:
            yield Finding(Kind.DISAGREES, table.id, "it was made from another configuration than summary.json tells")
