"""One case of a book that cannot be computed, named."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from plant_models import PlantError


class CaseError(Exception):
    """One case of a book cannot be computed; `case`: its class and target. The message says why."""

    def __init__(self, case: str, reason: str) -> None:
        super().__init__(reason)
        self.case = case


@contextmanager
def naming(label: str, target_m_s: float) -> Iterator[None]:
    """Within, a `PlantError` becomes a `CaseError` that names the case."""
    try:
        yield
    except PlantError as fault:
        raise CaseError(f"{label} to {target_m_s:g} m/s", str(fault)) from None
