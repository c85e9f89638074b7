"""Everything that a report says, as one value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from plant_models.library import SourcedValue
from synth.book.case_result import CaseResult
from synth.book.failed_case import FailedCase
from synth.book.pareto.pareto_front import ParetoFront
from synth.book.permissions.overview import Overview, overview_of
from synth.frame.picture.picture import Picture


@dataclass(frozen=True)
class BookReport:
    """A tune's results and where they come from.

    `created`: UTC instant, given by the caller; `failed`: cases without a table, not among `cases`; `verdict`: one
    sentence, `accepted`: the same as a bit;
    `acceptance_rms_m_s`: the limit that the tables had to keep; `parameters`: every number the results depend on;
    `permissions_line`: what those of the hardware would give, or how to ask for it, empty for neither;
    `file_hashes`: SHA-256 by file name; `pictures` in the order of the page.
    """

    title: str
    tool_version: str
    config_sha256: str
    created: str
    cases: tuple[CaseResult, ...]
    failed: tuple[FailedCase, ...]
    parameters: tuple[SourcedValue, ...]
    accepted: bool
    verdict: str
    acceptance_rms_m_s: float
    permissions_line: str
    file_hashes: Mapping[str, str]
    pictures: tuple[Picture, ...]

    @property
    def feasible(self) -> tuple[CaseResult, ...]:
        """Cases that a controller knowing the friction would serve within the limit."""
        return tuple(case for case in self.cases if case.feasibility.feasible)

    @property
    def infeasible(self) -> tuple[CaseResult, ...]:
        """The other cases."""
        return tuple(case for case in self.cases if not case.feasibility.feasible)

    @property
    def fronts(self) -> tuple[ParetoFront, ...]:
        """What less time in the position costs, where that was asked for."""
        return tuple(case.front for case in self.cases if case.front is not None)

    @property
    def permissions(self) -> Overview | None:
        """What permissions of the hardware would give, where that was asked for."""
        return overview_of(case.permissions for case in self.cases)
