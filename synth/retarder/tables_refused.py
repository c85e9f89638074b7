"""Faults that show only while tables are made, as sentences about the file that asks for them."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from synth.frame.input_error import InputError

if TYPE_CHECKING:
    from synth.retarder.configuration.resolved_config import ResolvedConfig
    from synth.retarder.failed_case import FailedCase


@contextlib.contextmanager
def tables_refused(source: str, config: ResolvedConfig) -> Iterator[None]:
    """Within, a `PlantError` and an `InvalidTable` become an `InputError` of `source`, which says `config`."""
    from plant_models import PlantError
    from synth.retarder.attempted_case import reason_of
    from tuning_tables import InvalidTable

    try:
        yield
    except (PlantError, InvalidTable) as fault:
        raise InputError(f"{source}: {reason_of(fault, config)}") from None


def require_a_table(cases: Sequence[object], failed: Sequence[FailedCase]) -> None:
    """`PlantError` where all cases have failed; it tells the first."""
    from plant_models import PlantError

    if cases or not failed:
        return
    first, others = failed[0], len(failed) - 1
    more = f" (nor for the {others} other case{'s' * (others > 1)})" if others else ""
    raise PlantError(f"no table for {first.name}{more}: {first.reason}")
