"""Outcomes of trains as a file of numpy: an array a field, rows by train, as `TrainOutcomes` describes them."""

from __future__ import annotations

import io
import zipfile
from dataclasses import fields
from typing import Any

import numpy as np

from synth.yard.humping.outcomes import GAP_BINS_M, SPEED_BINS_M_S, TrainOutcomes
from tuning_tables import DamagedTable

NUMBERS, TRIAL = "element_number", "trains_sha256"
EDGES = {"speed_bin_edges_m_s": SPEED_BINS_M_S, "gap_bin_edges_m": GAP_BINS_M}
"""What stands besides: the numbers of the elements by column, of which trial the trains are, edges of histograms."""


def to_npz(found: TrainOutcomes, numbers: tuple[int, ...], trains_sha256: str) -> bytes:
    """The content of the file; `numbers` of the elements in columns. Equal outcomes give equal bytes."""
    arrays: dict[str, Any] = {field.name: getattr(found, field.name) for field in fields(found)}
    arrays |= {**EDGES, NUMBERS: np.array(numbers), TRIAL: np.array(trains_sha256)}
    content = io.BytesIO()
    np.savez_compressed(content, **arrays)
    return content.getvalue()


def from_npz(content: bytes | memoryview, source: str, trains_sha256: str | None) -> TrainOutcomes:
    """The outcomes in a file; `DamagedTable` for what is none, or none of this trial (None: of any)."""
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
            if trains_sha256 is not None and str(arrays[TRIAL]) != trains_sha256:
                raise ValueError("they are of another trial")
            return TrainOutcomes(**{field.name: arrays[field.name] for field in fields(TrainOutcomes)})
    except (KeyError, ValueError, OSError, EOFError, zipfile.BadZipFile) as fault:
        raise DamagedTable(f"{source}: these are no outcomes of trains ({fault}); run 'hump simulate' again.") from None
