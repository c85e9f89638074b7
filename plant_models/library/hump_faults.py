"""What is at fault in a hump file, each fault with its place; they are collected, so that all are told at once."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from plant_models.errors import PlantError
from plant_models.library.toml_lines import Place


class HumpFileFault(PlantError):
    """What is at fault in a hump file, and at which `place` of it."""

    def __init__(self, place: Place, sentence: str) -> None:
        super().__init__(sentence)
        self.place = place


@dataclass
class FoundFaults:
    """The faults of a file so far, each once: that of a type is met in every row that names it."""

    by_place: dict[tuple[Place, str], HumpFileFault] = field(default_factory=dict)

    def add(self, place: Place, sentence: str) -> None:
        """One more."""
        self.by_place.setdefault((place, sentence), HumpFileFault(place, sentence))

    @contextmanager
    def collecting(self) -> Iterator[None]:
        """Within, a `HumpFileFault` ends the block and is kept here."""
        try:
            yield
        except HumpFileFault as fault:
            self.add(fault.place, str(fault))

    @property
    def faults(self) -> tuple[HumpFileFault, ...]:
        """All, in the order in which they were found."""
        return tuple(self.by_place.values())

    def __len__(self) -> int:
        return len(self.by_place)
