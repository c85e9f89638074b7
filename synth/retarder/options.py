"""Options of the commands on a retarder and on its tables; alone, for the help of a command needs no more.

`bench` and `validate` have theirs beside them, as they take more than these.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Final

from pydantic import BeforeValidator, Field

from synth.frame.machine import available
from synth.frame.settings.options import BY_PLACE, NEEDED, Options, flag_option, number_option, word_option
from synth.frame.workers.engine_options import EngineOptions

TUNE: Final = "tune"
"""Name of the command, with a radar and with point sensors."""


class TuneOptions(Options):
    """Options of the command line."""

    workers: int | None = number_option(
        "--workers", "N", None, 1, 256, "Cut classes solved at once; by default one a processor."
    )

    pareto: bool = flag_option("--pareto", "Also tell what less time in the position costs; takes long.")

    def workers_for(self, classes: int) -> int:
        """How many of so many classes are solved at once."""
        return self.workers or min(classes, available())


class TablesOptions(Options):
    """Options of the command line of a command on tables; `loop` and `explore` have no other."""

    source: Path = word_option(BY_PLACE, "TABLE|BOOK|DIR", NEEDED, "A table, a book, or a folder of tables.")
    config: Path | None = word_option(
        "--config", "C", None, "Configuration with the plant; that of the tables, or built-in, unless given."
    )


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


class PermissionsOptions(Options):
    """Options of the command line."""

    workers: int = number_option("--workers", "N", 2, 1, 256, "Cases compared at a time.")


class SensitivityOptions(Options):
    """Options of the command line."""

    table: Path | None = word_option("--table", "TABLE|BOOK|DIR", None, "Tables to ask; those of a tune unless given.")
    points: int = number_option("--points", "N", 1000, 200, 100_000, "Plants that are tried.")
    passes: int = number_option("--passes", "N", 200, 100, 100_000, "Passes of a table on each plant.")
    seed: int | None = number_option("--seed", "N", None, 0, 2**53, "Of plants and passes; as configured unless given.")


class SweepOptions(EngineOptions):
    """What is swept, and by whom."""

    config: Path = word_option(BY_PLACE, "CONFIG.toml", NEEDED, "Its table [sweep] says what is swept.")
