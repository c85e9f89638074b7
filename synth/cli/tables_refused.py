"""Faults that show only while tables are made, as sentences about the file that asks for them."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from synth.faults.input_error import InputError


@contextlib.contextmanager
def tables_refused(source: str) -> Iterator[None]:
    """Within, a `PlantError` and an `InvalidTable` become an `InputError` of `source`."""
    from synth.configuration.plant_fault import in_file
    from tuning_tables import InvalidTable

    try:
        with in_file(source):
            yield
    except InvalidTable as fault:
        raise InputError(
            f"{source}: the lines that were found make no table ({fault}) make grid.path_step_m or "
            "grid.speed_step_m_s smaller, or lower fit.degree"
        ) from None
