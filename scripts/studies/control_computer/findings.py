"""What the study `control-computer` has found, and its tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from scripts.studies.control_computer.benefit import BenefitOfControl
from scripts.studies.control_computer.controllers import Controllers
from scripts.studies.control_computer.failures import Failures
from scripts.studies.control_computer.published import Published
from scripts.studies.markdown_table import MarkdownTable
from scripts.studies.study import Findings


@dataclass(frozen=True)
class ControlComputer(Findings):
    """All parts."""

    published: Published
    failures: Failures
    benefit: BenefitOfControl
    controllers: Controllers

    def tables(self) -> Mapping[str, MarkdownTable]:
        """Those of all parts; see the titles."""
        parts = (self.published, self.failures, self.benefit, self.controllers)
        return {name: each for part in parts for name, each in part.tables().items()}

    def faults(self) -> tuple[str, ...]:
        """Every claim of the parts that does not hold."""
        return (
            *self.published.speeds.faults(),
            *self.failures.faults(),
            *self.benefit.faults(),
            *self.controllers.faults(),
        )
