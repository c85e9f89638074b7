"""What is typed behind the commands of the hump, and behind `aim`, which knows humps; apart from the commands and from
all that needs numpy, for their help loads nothing else. How many trains are humped, and which, is declared here.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator

from synth.aim.configuration.simulation_settings import SimulationSettings
from synth.frame.settings.options import BY_PLACE, NEEDED, Options, configured, number_option, word_option, words_option
from synth.frame.settings.section import Section, setting
from synth.frame.workers.engine_options import EngineOptions


class CountedTrains(Section):
    """Trains of a seed."""

    number: int = setting(200, "1", 1, 10_000_000, "trains that are humped")
    seed: int = setting(20261122, "1", 0, 2**53, "seed of the random streams; train k of a seed is always the same")


class TrialOptions(Options):
    """Which trains over which hump."""

    config: Path | None = word_option(
        BY_PLACE, "CONFIG.toml|HUMP", None, "A hump trial, or a hump for the built-in trial."
    )
    sorting_list: Path | None = word_option("--list", "CSV", None, "A sorting list, that of every train.")
    seed: int | None = configured("--seed", "N", CountedTrains, "seed", "Of the random numbers")


class SimulateOptions(TrialOptions, EngineOptions):
    """How many trains, and where they are humped."""

    trains: int | None = configured("--trains", "N", CountedTrains, "number", "Trains")


class SpeedOptions(TrialOptions):
    """One of these trains."""

    train: int = number_option("--train", "K", 1, 1, 10_000_000, "Which train of the trial.")


class AimOptions(Options):
    """Cuts and random numbers, and the track where a hump file has it."""

    hump: Path | None = word_option("--hump", "FILE|HUMP", None, "A hump, of which --track is aimed at.")
    track: int | None = number_option("--track", "N", None, 1, 199, "Which track of the hump, by its number.")
    passes: int | None = configured(
        "--passes", "N", SimulationSettings, "passes", "Cuts of each number of cars that speeds are chosen on"
    )
    seed: int | None = configured("--seed", "N", SimulationSettings, "seed", "Of the random numbers")


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


class CompareOptions(Options):
    """The directories of runs; the first is what others are compared with."""

    config: Path | None = word_option(BY_PLACE, "DIR", NEEDED, "A directory of 'hump simulate': the first run.")
    others: tuple[Path, ...] = words_option(BY_PLACE, "DIR...", NEEDED, "Others, which are compared with the first.")


class MakeOptions(Options):
    """The short file, which has no default."""

    config: Path | None = word_option(BY_PLACE, "SHORT.toml", NEEDED, "The short hump file.")


class YardWatchOptions(Options):
    """The file of the yard, which has no default, and what was repaired since the last run."""

    config: Path | None = word_option(BY_PLACE, "YARD.toml", NEEDED, "The positions that are watched.")
    repaired: tuple[str, ...] = words_option(
        "--repaired", "POSITION", (), "A position that is in order again: its watch begins anew with the passes of now."
    )
