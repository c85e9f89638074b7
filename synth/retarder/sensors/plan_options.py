"""Options of the command `sensors`."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, Field

from synth.frame.settings.options import Options, number_option

FEWEST, MOST = 2, 24


def numbers_in(word: object) -> tuple[int, ...]:
    """'2-12' or '4,6,8' as rising numbers of sensors; `ValueError` for anything else."""
    text = str(word)
    try:
        ends = [int(part) for part in text.split("-")] if "-" in text else []
        numbers = list(range(ends[0], ends[1] + 1)) if len(ends) == 2 else [int(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if not numbers or any(not FEWEST <= number <= MOST for number in numbers):
        raise ValueError(
            f"numbers of sensors from {FEWEST} to {MOST}, as 2-12 or 4,6,8: the one behind the exit counts"
        )
    return tuple(sorted(set(numbers)))


class PlanOptions(Options):
    """Options of the command line."""

    sensors: Annotated[tuple[int, ...], BeforeValidator(numbers_in)] = Field(
        "2-12",
        validate_default=True,
        description="Numbers of sensors; the one behind the exit counts.",
        json_schema_extra={"flag": "--sensors", "metavar": "N-M|N,M"},
    )
    rms_m_s: float | None = number_option(
        "--rms", "M_S", None, 1e-4, 10.0, "Wanted rms, m/s; 1.1 times the radar's unless given."
    )
    passes: int = number_option(
        "--passes", "N", 4000, 1000, 50_000, "Passes of every table that figures are told from."
    )
    workers: int = number_option("--workers", "N", 2, 1, 256, "Layouts tried at a time.")
