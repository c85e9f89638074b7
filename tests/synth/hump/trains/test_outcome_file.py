"""trains.npz: numpy reads it, and what is damaged or forged is refused before it takes memory."""

from __future__ import annotations

import io
import tracemalloc
import zipfile
from collections.abc import Callable
from dataclasses import fields
from functools import cache

import numpy as np
import pytest

from synth.hump.trains.outcome_file import TrialTrains, from_npz, to_npz
from synth.hump.trains.outcomes import TrainOutcomes
from tests.synth.hump.trains.made_trials import CATEGORIES, Day
from tuning_tables import DamagedTable
from tuning_tables.seal import seal_of

TRAINS = 3
LARGEST = 2_000_000
"""Bytes that a file may take, however it was made; these trains take a hundredth of it."""


@cache
def stored() -> tuple[TrialTrains, TrainOutcomes, bytes]:
    """Some trains and their file."""
    trial = Day(cuts=4, constant_m_s=1.5).on("medium")
    found = trial.batch(0, TRAINS)
    of = TrialTrains(trial.routes, "a" * 64, len(CATEGORIES.members))
    return of, found, to_npz(found, of)


def sealed(body: bytes) -> bytes:
    """A forger knows how to seal."""
    return body + seal_of(body)


def members() -> dict[str, bytes]:
    """The members of the archive."""
    with zipfile.ZipFile(io.BytesIO(stored()[2])) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def packed(contents: dict[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    """An archive of `contents`."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", method) as archive:
        for name, content in contents.items():
            archive.writestr(name, content)
    return file.getvalue()


def npy(array: np.ndarray) -> bytes:
    """An array as numpy stores it."""
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


def test_numpy_alone_reads_every_field_and_so_do_we() -> None:
    trial, found, content = stored()
    again = from_npz(content, "trains.npz", trial, TRAINS)
    with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
        for field in fields(TrainOutcomes):
            np.testing.assert_array_equal(getattr(found, field.name), arrays[field.name])
            np.testing.assert_array_equal(getattr(found, field.name), getattr(again, field.name))
            assert getattr(again, field.name).dtype == getattr(found, field.name).dtype
    assert from_npz(sealed(packed(members())), "trains.npz", trial, TRAINS).cuts.tolist() == found.cuts.tolist()


def longer(contents: dict[str, bytes]) -> bytes:
    """One field is far longer than the others, as its own head says."""
    return packed(contents | {"cuts.npy": npy(np.zeros(4_000_000, dtype=np.int64))})


def all_longer(contents: dict[str, bytes]) -> bytes:
    """All fields agree on far more trains than the trial has."""
    many = {
        name: npy(np.zeros((500_000, *np.load(io.BytesIO(content)).shape[1:]), dtype=np.int64))
        for name, content in contents.items()
        if name in ("train.npy", "cuts.npy", "cars.npy")
    }
    return packed(contents | many)


def lying_size(contents: dict[str, bytes]) -> bytes:
    """The directory tells the right size of a member that expands to more."""
    right = len(contents["cuts.npy"])
    body = bytearray(packed(contents | {"cuts.npy": contents["cuts.npy"] + bytes(40_000_000)}))
    entry = body.index(b"cuts.npy", body.index(b"PK\x01\x02")) - 46
    body[entry + 24 : entry + 28] = right.to_bytes(4, "little")
    return bytes(body)


def other_type(contents: dict[str, bytes]) -> bytes:
    """As many bytes of another type."""
    array = np.load(io.BytesIO(contents["cuts.npy"]))
    return packed(contents | {"cuts.npy": npy(array.view(np.float64))})


def one_missing(contents: dict[str, bytes]) -> bytes:
    """A field is not there."""
    return packed({name: content for name, content in contents.items() if name != "gap_m.npy"})


def packed_otherwise(contents: dict[str, bytes]) -> bytes:
    """By a method that Python has no word for."""
    body = bytearray(packed(contents))
    entry = body.index(b"PK\x01\x02")
    body[entry + 10 : entry + 12] = (97).to_bytes(2, "little")
    return bytes(body)


def of_another_trial(contents: dict[str, bytes]) -> bytes:
    """The trial is another one."""
    return packed(contents | {"trains_sha256.npy": npy(np.array("b" * 64))})


@pytest.mark.parametrize(
    "forged", [longer, all_longer, lying_size, other_type, one_missing, packed_otherwise, of_another_trial]
)
def test_a_forged_archive_is_refused_before_it_takes_memory(forged: Callable[[dict[str, bytes]], bytes]) -> None:
    content = sealed(forged(members()))
    tracemalloc.start()
    try:
        with pytest.raises(DamagedTable, match="these are not the outcomes of 3 trains of this trial"):
            from_npz(content, "trains.npz", stored()[0], TRAINS)
        assert tracemalloc.get_traced_memory()[1] < LARGEST
    finally:
        tracemalloc.stop()


def test_another_number_of_trains_is_refused() -> None:
    trial, _, content = stored()
    with pytest.raises(DamagedTable, match="not the outcomes of 4 trains"):
        from_npz(content, "trains.npz", trial, 4)
