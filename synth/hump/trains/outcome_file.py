"""Outcomes of trains as a file of numpy: an array a field, rows by train, as `TrainOutcomes` describes them; and such a
file with its configuration, as `hump simulate` has left both in a directory.

A zip archive may expand to a thousand times its size, and numpy believes the shapes that stand in it. So a file is
under a seal, its directory must name exactly what belongs there, in the size that it has, and no more is expanded.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from synth.frame.damaged_archive import NO_ARCHIVE
from synth.frame.faults import InputError
from synth.hump.configuration.trial_file import INPUTS
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.outcomes import GAP_BINS_M, SPEED_BINS_M_S, USUAL_COUPLINGS, TrainOutcomes
from synth.hump.trial.resolved_trial import ResolvedTrial, load_trial
from tuning_tables import DamagedTable
from tuning_tables.whole_file import seal_of, unsealed

TRAINS = "trains.npz"
"""The file of all trains of a trial, in its directory."""

NUMBERS, TRIAL = "element_number", "trains_sha256"
EDGES = {"speed_bin_edges_m_s": SPEED_BINS_M_S, "gap_bin_edges_m": GAP_BINS_M}
"""What stands besides: the numbers of the elements by column, of which trial the trains are, edges of histograms."""

FLOATS = ("occupied", "span_s", "span_m", "span_cars", "gap_m", "error2_m2_s2", "commands_m_s", "tightest_s")
"""Fields of numbers that are not whole."""


@dataclass(frozen=True)
class TrialTrains:
    """Of which trial trains are, by the hash of what each of them depends on, over which routes, and of how many
    weight categories their cuts can be."""

    routes: HumpRoutes
    trains_sha256: str
    categories: int

    def beside(self) -> dict[str, NDArray[Any]]:
        """What stands in the file besides the outcomes."""
        return {**EDGES, NUMBERS: np.array(self.routes.numbers), TRIAL: np.array(self.trains_sha256)}

    def shapes(self, count: int) -> dict[str, tuple[int, ...]]:
        """The shape of each field of the outcomes of `count` trains."""
        elements, positions = (count, len(self.routes.numbers)), (count, self.routes.positions)
        wide = {
            **dict.fromkeys(("misrouted", "contact", "unseparated", "foul"), elements),
            **dict.fromkeys(("passes", "strokes", "error2_m2_s2", "short", "at_lowest"), positions),
            **dict.fromkeys(("commanded", "commands_m_s"), (*positions, self.categories)),
            "overspeed": (count, len(USUAL_COUPLINGS.classes_m_s)),
            "speed_bins": (count, len(SPEED_BINS_M_S) - 1),
            "gap_bins": (count, len(GAP_BINS_M) - 1),
        }
        return {field.name: wide.get(field.name, (count,)) for field in fields(TrainOutcomes)}


def trains_of(config: ResolvedTrial) -> TrialTrains:
    """Those of a trial."""
    return TrialTrains(config.routes, config.trains_sha256, len(config.categories.members))


def to_npz(found: TrainOutcomes, trial: TrialTrains) -> bytes:
    """The content of the file, under its seal; numpy reads over that. Equal outcomes give equal bytes."""
    arrays: dict[str, Any] = {field.name: getattr(found, field.name) for field in fields(found)} | trial.beside()
    content = io.BytesIO()
    np.savez_compressed(content, **arrays)
    body = content.getvalue()
    return body + seal_of(body)


def from_npz(content: bytes, source: str, trial: TrialTrains, count: int) -> TrainOutcomes:
    """The outcomes of `count` trains of `trial` in a file; `DamagedTable` for what is none, before it takes memory."""
    body = io.BytesIO(unsealed(content, source))
    try:
        with zipfile.ZipFile(body) as archive:
            return outcomes_in(archive, trial, count)
    except NO_ARCHIVE as fault:
        said = str(fault)[:200] or type(fault).__name__
        raise DamagedTable(
            f"{source}: these are not the outcomes of {count} trains of this trial ({said}); run 'hump simulate' again."
        ) from None


def outcomes_in(archive: zipfile.ZipFile, trial: TrialTrains, count: int) -> TrainOutcomes:
    """The outcomes in `archive`; `ValueError` for anything in it that is not as it must be."""
    beside = {f"{name}.npy": npy_head(array) + array.tobytes() for name, array in trial.beside().items()}
    fields_of = {f"{name}.npy": empty(name, shape) for name, shape in trial.shapes(count).items()}
    members = archive.infolist()
    if [member.filename for member in members] != [*fields_of, *beside]:
        raise ValueError("other arrays are in it")
    sizes = {name: len(npy_head(array)) + array.nbytes for name, array in fields_of.items()}
    sizes |= {name: len(content) for name, content in beside.items()}
    for member in members:
        if member.file_size != sizes[member.filename]:
            raise ValueError(f"{member.filename} has {member.file_size} bytes, not {sizes[member.filename]}")
    for name, content in beside.items():
        if expanded(archive, name, len(content)) != content:
            raise ValueError(f"{name} is another one")
    return TrainOutcomes(**read_arrays(archive, fields_of))


def read_arrays(archive: zipfile.ZipFile, like: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """The arrays in `archive` by field, each of the shape and type of that in `like`, by member."""
    found = {}
    for name, array in like.items():
        head = npy_head(array)
        content = expanded(archive, name, len(head) + array.nbytes)
        if not content.startswith(head):
            raise ValueError(f"{name} has another shape or type")
        found[name.removesuffix(".npy")] = np.frombuffer(content, array.dtype, offset=len(head)).reshape(array.shape)
    return found


def expanded(archive: zipfile.ZipFile, name: str, size: int) -> bytes:
    """The first `size` bytes of a member; where that is its end, its checksum is right."""
    with archive.open(name) as stream:
        return stream.read(size)


def empty(name: str, shape: tuple[int, ...]) -> NDArray[Any]:
    """An array of a field with that shape, which takes no memory."""
    return np.broadcast_to(np.float64(0.0) if name in FLOATS else np.int64(0), shape)


def npy_head(array: NDArray[Any]) -> bytes:
    """What numpy writes before the numbers of an array of this shape and type, in C order."""
    head = io.BytesIO()
    told = {"descr": np.lib.format.dtype_to_descr(array.dtype), "fortran_order": False, "shape": array.shape}
    np.lib.format.write_array_header_1_0(head, told)
    return head.getvalue()


CONFIG: Final = f"{INPUTS}/config.toml"


@dataclass(frozen=True)
class StoredTrains:
    """Trains, their configuration, and the bytes of their file."""

    config: ResolvedTrial
    found: TrainOutcomes
    content: bytes


def stored_trains(directory: Path, said: str) -> StoredTrains:
    """The trains in `directory`, which messages call `said`; `InputError` for a file that is not there, or a
    configuration that does not fit, `DamagedTable` for trains that are damaged or of another trial."""
    for name in (CONFIG, TRAINS):
        if not (directory / name).is_file():
            raise InputError(f"{said}: there is no {name} in it; give what 'hump simulate' left")
    config = load_trial(directory / CONFIG)
    content = (directory / TRAINS).read_bytes()
    found = from_npz(content, str(directory / TRAINS), trains_of(config), config.settings.trains.number)
    return StoredTrains(config, found, content)
