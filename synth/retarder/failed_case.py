"""One case of a book that no table can be made for, and why: it is told of, and loses none but itself."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeVar

from plant_models import PlantError

Made = TypeVar("Made")


@dataclass(frozen=True)
class FailedCase:
    """A cut class and target without a table; `reason`: why, and what to change, in one sentence without a full stop.

    Of some part of a case, as that: its table can be there.
    """

    label: str
    target_m_s: float
    reason: str

    @property
    def case(self) -> tuple[str, float]:
        """Class, and target in m/s."""
        return self.label, self.target_m_s

    @property
    def name(self) -> str:
        """Class and target in words."""
        return f"{self.label} to {self.target_m_s:g} m/s"

    @property
    def sentence(self) -> str:
        """The case, that it has no table, and why."""
        return f"{self.name}: no table: {self.reason}"


def told_together(failed: Iterable[FailedCase]) -> str:
    """All of them with their reasons; those that fail for the same one are named side by side."""
    by_reason: dict[str, list[str]] = {}
    for case in failed:
        by_reason.setdefault(case.reason, []).append(case.name)
    return "; ".join(f"{', '.join(names)}: {reason}" for reason, names in by_reason.items())


def require_none(failed: Iterable[FailedCase]) -> None:
    """`PlantError` where a case has failed, for who needs all of them."""
    told = told_together(failed)
    if told:
        raise PlantError(f"no table for {told}")


def parted(results: Iterable[Made | FailedCase]) -> tuple[tuple[Made, ...], tuple[FailedCase, ...]]:
    """What was made, and what has failed, each in the order of `results`."""
    kept, failed = [], []
    for result in results:
        if isinstance(result, FailedCase):
            failed.append(result)
        else:
            kept.append(result)
    return tuple(kept), tuple(failed)
