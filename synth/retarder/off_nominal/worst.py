"""Which case suffers most off nominal, and where."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from synth.retarder.case_result import CaseResult
from synth.retarder.judgement import interval_text
from synth.retarder.off_nominal.outcome import Outcome


@dataclass(frozen=True)
class Worst:
    """The largest `ratio` to the rms of the same passes on the plant of the table: `case`, and what became of it."""

    case: CaseResult
    key: str
    outcome: Outcome
    ratio: float

    @property
    def told(self) -> str:
        """In a sentence."""
        found = self.outcome
        return (
            f"Off nominal, for which there is no limit, the worst is {self.case.name} with {found.change}: rms "
            f"{found.rms_m_s:.4f} {interval_text(found.rms_ci95_m_s)} m/s, {self.ratio:.1f} times the nominal."
        )


def worst_of(cases: Sequence[CaseResult]) -> Worst | None:
    """The worst of all conditions of `cases`, None where there is no ratio."""
    return max(ratios_of(cases), key=lambda each: each.ratio, default=None)


def ratios_of(cases: Sequence[CaseResult]) -> Iterator[Worst]:
    """Every ratio that there is."""
    for case in cases:
        for each in case.off_nominal:
            if each.outcome is not None and each.outcome.ratio is not None:
                yield Worst(case, each.key, each.outcome, each.outcome.ratio)
