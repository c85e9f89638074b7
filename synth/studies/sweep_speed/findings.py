"""What the study of a sweep has found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from synth.studies.markdown_table import MarkdownTable, table
from synth.studies.study import Findings
from synth.studies.sweep_speed.binding import Binding
from synth.studies.timing.machine import Machine

MANY = 10_000


@dataclass(frozen=True)
class UnitRow:
    """One class with all its targets: seconds in a worker, memory at most and as estimated, when it was done."""

    unit: str
    mass_t: float
    tables: int
    seconds: float
    peak_mib: float
    estimate_mib: float
    done_s: float


@dataclass(frozen=True)
class SweepSpeed(Findings):
    """All units in the order in which they were done."""

    machine: Machine
    workers: int
    targets: int
    passes: int
    total_s: float
    failed: int
    units: tuple[UnitRow, ...]
    binding: Binding

    @property
    def made(self) -> int:
        """Tables."""
        return sum(unit.tables for unit in self.units)

    @property
    def busy(self) -> float:
        """Share of the time that the workers were at work."""
        return sum(unit.seconds for unit in self.units) / self.total_s / self.workers

    @property
    def minutes_for_many(self) -> float:
        """The measured rate carried on."""
        return MANY * self.total_s / self.made / 60.0

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`sweep`: one figure a row."""
        seconds = [unit.seconds for unit in self.units]
        ratios = [unit.peak_mib / unit.estimate_mib for unit in self.units]
        b = self.binding
        rows = (
            ("tables", f"{self.made}, of {len(self.units)} classes × {self.targets} targets, {self.passes} passes "
                       "each"),
            ("time", f"{self.total_s:.0f} s by {self.workers} workers, at work {100.0 * self.busy:.0f} % of it"),
            ("rate", f"{60.0 * self.made / self.total_s:.0f} tables a minute; {MANY} would take "
                     f"{self.minutes_for_many:.0f} minutes"),
            ("a class", f"{min(seconds):.1f} to {max(seconds):.1f} s"),
            ("memory of a worker", f"{max(unit.peak_mib for unit in self.units):.0f} MiB at most; "
                                   f"{min(ratios):.2f} to {max(ratios):.2f} of the estimate"),
            ("binding", f"{b.tables} tables: read in {b.read_s:.1f} s, written in {b.write_s:.1f} s, "
                        f"{b.book_mib:.1f} MiB; memory {b.peak_mib:.0f} MiB, {b.bare_mib:.0f} before"),
        )  # fmt: skip
        return {"sweep": table("A sweep from nothing", ("", ""), rows)}

    def sentences(self) -> tuple[str, ...]:
        """The machine."""
        return (self.machine.sentence,)

    def faults(self) -> tuple[str, ...]:
        """No class may fail, and none may take more memory than is reckoned with."""
        found = [f"{self.failed} classes failed"] if self.failed else []
        above = [unit.unit for unit in self.units if unit.peak_mib > unit.estimate_mib]
        return (*found, *(f"{unit} takes more memory than is estimated" for unit in above))
