"""Options of the command `validate`."""

from __future__ import annotations

import math
from pathlib import PurePath
from typing import Final

from pydantic import field_validator

from plant_models.pressure_regulator import USUAL_NOISE_KPA
from synth.frame.settings.options import number_option, word_option
from synth.retarder.options import TablesOptions

LARGEST_STD_KPA: Final = 100.0
LOG_FORMS: Final = (".csv", ".h5")


class ValidateOptions(TablesOptions):
    """Options of the command line. `gauge_std_kpa` None: there is no gauge."""

    passes: int | None = number_option(
        "--passes", "N", None, 1000, 100_000_000, "Passes of each table; as configured unless given."
    )
    seed: int | None = number_option(
        "--seed", "N", None, 0, 2**63 - 1, "Of the random numbers; as configured unless given."
    )
    log: str | None = word_option(
        "--log", "NAME.csv|.h5", None, "Also log passes as a controller would, in a file of this name in DIR."
    )
    log_passes: int = number_option("--log-passes", "N", 200, 1, 100_000, "Logged of each table.")
    gauge_std_kpa: float | None = word_option(
        "--gauge-std", "KPA|none", USUAL_NOISE_KPA, "Noise of the logged pressure; none: there is no gauge."
    )

    @field_validator("log")
    @classmethod
    def _is_a_name(cls, word: str | None) -> str | None:
        """No folder, and an ending of a log."""
        if word is not None and (PurePath(word).name != word or PurePath(word).suffix not in LOG_FORMS):
            raise ValueError(f"the name of a file in DIR that ends in {' or '.join(LOG_FORMS)}")
        return word

    @field_validator("gauge_std_kpa", mode="before")
    @classmethod
    def _is_a_deviation(cls, word: str) -> float | None:
        """A number of kPa, or none."""
        if word == "none":
            return None
        try:
            value = float(word)
        except ValueError:
            value = math.nan
        if not 0.0 <= value <= LARGEST_STD_KPA:
            raise ValueError(f"0 to {LARGEST_STD_KPA:g} kPa, or none")
        return value
