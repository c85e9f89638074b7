"""The estimator in the C99 export: its constants, its part of a table, and the golden tracks, also as CSV."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import accumulate

import numpy as np

from tuning_tables.c_literals import hex_float
from tuning_tables.estimator import (
    FACTOR_RANGE,
    FEW_READINGS,
    GATE,
    HEAVIER_ALARM,
    LARGEST_EXCESS_M_S2,
    LARGEST_OVERPRESSURE_KPA,
    LARGEST_SPEED_M_S,
    LARGEST_STEP_M,
    LEAST_SPEED_M_S,
    LEAST_STEP_M,
    LIGHTER_ALARM,
    LOST_ALARM,
    SENSOR_ALARM,
)
from tuning_tables.golden_tracks import GoldenTrack
from tuning_tables.held_numbers import HELD_NUMBERS
from tuning_tables.table_block import ESTIMATOR_HEAD, BlockSize, TableBlock
from tuning_tables.table_book import TableBook


def estimator_limits() -> Mapping[str, float]:
    """The numbers that are the same in every estimator, by their names in the templates."""
    return {
        "LEAST_SPEED": LEAST_SPEED_M_S,
        "LEAST_STEP": LEAST_STEP_M,
        "LEAST_FACTOR": FACTOR_RANGE[0],
        "LARGEST_FACTOR": FACTOR_RANGE[1],
        "LARGEST_SPEED": LARGEST_SPEED_M_S,
        "LARGEST_OVERPRESSURE": LARGEST_OVERPRESSURE_KPA,
        "LARGEST_STEP": LARGEST_STEP_M,
        "LARGEST_EXCESS": LARGEST_EXCESS_M_S2,
        "GATE_SQUARED": GATE**2,
        "FEW_READINGS": FEW_READINGS,
    }


def alarm_bits() -> Mapping[str, int]:
    """The bits of the alarm word, by their names in the templates."""
    return {
        "LOST_ALARM": LOST_ALARM,
        "SENSOR_ALARM": SENSOR_ALARM,
        "LIGHTER_ALARM": LIGHTER_ALARM,
        "HEAVIER_ALARM": HEAVIER_ALARM,
    }


def estimator_blanks() -> Mapping[str, str]:
    """The limits by their blanks in the templates: exact, and for the eye."""
    limits = estimator_limits()
    exact = {f"{name}_HEX": hex_float(np.float32(value)) for name, value in limits.items()}
    members = (f"    float {each.c}; /* {each.meaning} */" for each in HELD_NUMBERS)
    differ = (f"differ(slower->{each.c}, faster->{each.c})" for each in HELD_NUMBERS)
    return {
        **exact,
        **{name: f"{value:g}" for name, value in limits.items()},
        **{name: f"{value}" for name, value in alarm_bits().items()},
        "ESTIMATOR_HEAD": str(ESTIMATOR_HEAD),
        "ESTIMATOR_NUMBERS": "\n".join(members),
        "NUMBERS_DIFFER": "\n        || ".join(differ),
    }


def estimator_text(block: TableBlock, size: BlockSize) -> list[str]:
    """The lines of a table's initialiser about its estimator; none if no table of the book has one."""
    words = block.words[size.estimator]
    if not len(words):
        return []
    head = words[1:ESTIMATOR_HEAD].view(np.float32)
    rows = words[ESTIMATOR_HEAD:].view(np.float32).reshape(3, size.breaks)
    return [
        f"        {words[0]}u, /* breaks of the estimator */",
        *(
            f"        {hex_float(value)}, /* {each.meaning}: {value:g} */"
            for each, value in zip(HELD_NUMBERS, head, strict=True)
        ),
        "        {",
        ",\n".join(f"            {{{', '.join(map(hex_float, row))}}}" for row in rows),
        "        },",
    ]


def track_blanks(book: TableBook, tracks: Sequence[GoldenTrack]) -> Mapping[str, str]:
    """The golden tracks, by their blanks in the self-test."""
    ends = list(accumulate(map(len, tracks)))
    heads = []
    for track, end in zip(tracks, ends, strict=True):
        estimator = book.tables[track.number].estimator
        touch_kpa = np.float32(0.0 if estimator is None else estimator.touch_pressure_kpa)
        heads.append(f"    {{{track.number}u, 0x{int(touch_kpa.view(np.uint32)):08x}u, {end}u}}")
    samples = [
        f"    {{{', '.join(f'0x{bits:08x}u' for bits in row)}, {alarms:.0f}u}}"
        for track in tracks
        for *row, alarms in zip(*(v.view(np.uint32).tolist() for v in track.samples[:-1]), track.alarms, strict=True)
    ]
    return {
        "TRACKS": f"{len(tracks)}",
        "SAMPLES": f"{len(samples)}",
        "GOLDEN_TRACKS": ",\n".join(heads),
        "GOLDEN_SAMPLES": ",\n".join(samples),
    }


def tracks_csv(book: TableBook, tracks: Sequence[GoldenTrack]) -> bytes:
    """All golden tracks, CR LF: track, table number and id, readings and estimate as bits and as numbers.

    Path in m, speeds in m/s, overpressure in kPa; then the number of samples since the last reading that was believed,
    and the alarm word. A track begins with a cut of which nothing is known.
    """
    columns = ("s", "v", "overpressure", "estimate")
    units = ("s_m", "v_m_s", "overpressure_kpa", "estimate_m_s", "unseen_samples", "alarms")
    rows = [",".join(("track", "table", "id", *(f"{name}_bits" for name in columns), *units))]
    for number, track in enumerate(tracks):
        name = '"' + book.tables[track.number].id.replace('"', '""') + '"'
        bits = zip(*(values.view(np.uint32).tolist() for values in track.samples[: len(columns)]), strict=True)
        for words, values in zip(bits, zip(*track.samples, strict=True), strict=True):
            fields = [*(f"{word:08x}" for word in words), *(f"{value:.9g}" for value in values)]
            rows.append(f"{number},{track.number},{name},{','.join(fields)}")
    return ("\r\n".join(rows) + "\r\n").encode("utf-8")
