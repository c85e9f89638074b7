"""Options of the command `hump capacity`."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator

from synth.frame.settings.options import configured, number_option, word_option, words_option
from synth.frame.workers.engine_options import EngineOptions
from synth.hump.configuration.counted_trains import CountedTrains
from synth.hump.trains.trial_options import TrialOptions

USUAL_LEAST_S = (2.0, 1.0, 0.5, 0.0, -0.5)
"""Least intervals of the programs of a curve: 0.5 s is that of a trial; below 0 cuts are expected to meet, and some of
100 catch up."""

MOST_POINTS = 20


def numbers_in(words: Any) -> Any:
    """The numbers of a list in words; `ValueError` tells what they must be."""
    if not isinstance(words, str):
        return words
    try:
        return tuple(float(word) for word in words.split(","))
    except ValueError:
        raise ValueError("numbers with commas between them, as in 0.35,0.2,0.05") from None


Numbers = Annotated[tuple[float, ...], BeforeValidator(numbers_in)]


class CapacityOptions(TrialOptions, EngineOptions):
    """What is humped for each curve, and what the curves differ in."""

    catch_ups: float = number_option("--catch-ups", "SHARE", 0.002, 1e-5, 0.5, "Share of the cuts that may catch up.")
    trains: int | None = configured("--trains", "N", CountedTrains, "number", "Trains of each point of a curve")
    exit_std: Numbers | None = word_option(
        "--exit-std", "A,B,...", None, "Accuracies of all positions without tables, m/s, a curve each."
    )
    set: tuple[str, ...] = words_option(
        "--set", "KEY=A,B,...", (), "Values of a key of the trial, a curve each; again for another key."
    )
    speeds: Numbers | None = word_option(
        "--speeds", "A,B,...", None, "Constant hump speeds of the curves, m/s, in place of programs."
    )
    least: Numbers = word_option(
        "--least", "A,B,...", USUAL_LEAST_S, "Least intervals of the programs of the curves, s, the safest first."
    )
