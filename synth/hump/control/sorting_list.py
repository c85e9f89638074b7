"""The sorting list of a train: its cuts in the order in which they come over the hump."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from plant_models.errors import require
from synth.hump.control.cut_record import CutRecord


@dataclass(frozen=True)
class SortingList:
    """Cuts with rising serial numbers; `PlantError` for none, and for numbers that do not rise."""

    cuts: tuple[CutRecord, ...]

    def __post_init__(self) -> None:
        require(len(self.cuts) > 0, "sorting list: it holds no cut")
        for ahead, behind in pairwise(self.cuts):
            require(
                ahead.serial < behind.serial,
                f"sorting list: cut {behind.serial} stands behind cut {ahead.serial}; the numbers must rise",
            )

    def __len__(self) -> int:
        return len(self.cuts)

    @property
    def humped(self) -> tuple[CutRecord, ...]:
        """The cuts that go over the hump."""
        return tuple(cut for cut in self.cuts if cut.goes_over_the_hump)
