"""What figures of a hump do not say, for every command that tells some."""

from __future__ import annotations

from typing import Final

MODEL_ONLY: Final = (
    "All figures are those of a model with the parameters listed here, not of a hump. Assumed parameters are guesses."
)
CHANCE_ONLY: Final = "Intervals cover the chance of these trains only, neither the parameters nor the model."
NO_SAFETY: Final = "The tool claims no safety integrity: no figure here proves that a hump is safe."
