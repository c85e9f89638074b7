"""The trains that `hump simulate` leaves as an archive: damaged at random, and forged by one who knows how."""

from __future__ import annotations

import hashlib
import io
import random
import zipfile
from collections.abc import Iterator
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.trains.made_trial import made_trial
from synth.hump.trains.outcome_file import to_npz, trains_of
from synth.hump.trains.outcomes import TrainOutcomes
from synth.hump.trains.resolved_trial import resolve_trial
from synth.hump.trains.stored_trains import stored_trains
from tests.attack.attempt import Changed, Kind, Reading
from tests.attack.mutants import mutant
from tuning_tables.seal import seal_of

NUMBER: Final = 4
DAMAGED: Final = 500
"""Archives that are damaged at random and then sealed: nothing else comes to what is behind a seal."""
CONFIG: Final = f"""\
hump = "medium"
[trains]
number = {NUMBER}
cuts = 3
[hump_speed]
constant_m_s = 1.5
[aim]
design_cuts = 200
"""


def read_trains(folder: Path) -> str:
    """As `computer`: the hash of all outcomes."""
    found = stored_trains(folder, str(folder)).found
    arrays = [np.asarray(getattr(found, field.name)) for field in fields(TrainOutcomes)]
    return hashlib.sha256(b"".join(f"{a.dtype} {a.shape}".encode() + a.tobytes() for a in arrays)).hexdigest()


def trains_kind() -> Kind:
    """Trains of a small trial; a changed file is refused with 3, or has the same trains."""
    config = resolve_trial(parse_trial_file(CONFIG, "trial.toml"))
    content = to_npz(
        made_trial(config).batch(0, NUMBER),
        trains_of(config),
    )
    return Kind(
        name="trains",
        files={"inputs/config.toml": CONFIG.encode(), "trains.npz": content},
        attacked="trains.npz",
        read=read_trains,
        change=partial(mutant, text=False),
        code=3,
        allowed=Reading.SAME,
        first=tuple(forged(content)),
    )


def forged(content: bytes) -> Iterator[Changed]:
    """Archives that are sound but for one of their arrays; each without and with a seal that fits."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    cuts = np.load(io.BytesIO(members["cuts.npy"]))
    arrays = {
        "zip bomb": npy(np.zeros(8_000_000, dtype=np.int64)),
        "terabytes promised": npy(cuts).replace(b"(4,), }            ", b"(4000000000000,), }"),
        "longer": npy(np.append(cuts, cuts)),
        "empty": npy(cuts[:0]),
        "another shape": npy(cuts.reshape(2, 2)),
        "another type": npy(cuts.astype(np.float32)),
        "texts": npy(cuts.astype(np.str_)),
        "objects": npy(cuts.astype(object)),
        "no array": b"PK",
    }
    for how, array in arrays.items():
        body = packed({**members, "cuts.npy": array})
        yield Changed(body, how, Reading.SAME)
        yield Changed(body + seal_of(body), f"{how}, sealed", Reading.SAME)
    yield Changed(packed({**members, "cuts.npy": npy(cuts + 1)}), "other numbers", Reading.SAME)
    sound = packed(members)
    for number in range(DAMAGED):
        body = mutant(sound, random.Random(number), text=False)
        yield Changed(body + seal_of(body), "damaged, sealed", Reading.SAME)


def npy(array: np.ndarray[Any, Any]) -> bytes:
    """An array as numpy stores it."""
    file = io.BytesIO()
    np.save(file, array)
    return file.getvalue()


def packed(members: dict[str, bytes]) -> bytes:
    """An archive."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return file.getvalue()
