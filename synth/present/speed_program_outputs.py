"""What `hump speed` leaves: the program of a train for the locomotive, the uncoupler's sheet, and a picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from synth.frame.picture.picture import drawing_files
from synth.frame.results_directory import ResultsDirectory
from synth.frame.summary import plain
from synth.yard.humping.speed_program import SpeedProgram, locomotive_csv, uncoupler_csv


def write_program(program: SpeedProgram, directory: ResultsDirectory) -> list[Path]:
    """Write the files of `program`; raises `OSError`."""
    from synth.present.plots.humping.hump_speed_program import PushedTrain
    from synth.present.plots.humping.humping_pictures import program_picture

    stem = f"train-{program.number + 1}"
    contents = {f"{stem}-locomotive.csv": locomotive_csv(program), f"{stem}-uncoupler.csv": uncoupler_csv(program)}
    time, speed, length = (
        np.array([getattr(row, key) for row in program.rows]) for key in ("time_s", "hump_speed_m_s", "length_m")
    )
    picture = program_picture(PushedTrain(program.number, time, speed, length))
    contents |= drawing_files(picture.drawing, f"{stem}-hump-speed")
    return directory.write_all(contents)


def program_document(program: SpeedProgram, files: Sequence[Path]) -> dict[str, Any]:
    """The program for programs."""
    document: dict[str, Any] = plain(
        {
            "train": program.number + 1,
            "mean_hump_speed_m_s": program.mean_m_s,
            "cars_per_hour": program.cars_per_hour,
            "cuts": [asdict(row) for row in program.rows],
            "files": [str(file) for file in files],
        }
    )
    return document
