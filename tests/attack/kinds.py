"""The kinds of input: a small sound file of each, and what the commands read it with before they compute anything."""

from __future__ import annotations

import hashlib
import io
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from functools import partial
from pathlib import Path
from typing import Final

import h5py
import numpy as np

from synth.aim.configuration.aim_file import default_aim_toml
from synth.cli.hump import check_command
from synth.computer.command import COMMAND as COMPUTER
from synth.computer.settings import default_computer_toml
from synth.frame.perform import asked_of
from synth.frame.terminal.manner import Manner
from synth.frame.terminal.telling import say
from synth.hump.aiming import COMMAND as AIM
from synth.hump.configuration.trial_file import default_trial_toml
from synth.hump.hump_file import parse_hump
from synth.hump.hump_forms import to_csv
from synth.hump.making.make_command import COMMAND as MAKE
from synth.hump.railml.write import to_railml
from synth.hump.trains.simulate_command import COMMAND as SIMULATE
from synth.logs.fitting_passes import loaded_passes
from synth.retarder.configuration.config_file import default_sensors_toml, load_config
from synth.retarder.options import TuneOptions
from synth.retarder.sensors.tune_command import COMMAND as SENSORS_TUNE
from synth.retarder.sweep.command import COMMAND as SWEEP_RUN
from tests.attack.forged import forged
from tests.attack.mutants import mutant
from tests.attack.processes import Changed, Kind, Reading
from tests.attack.railml_attributes import attribute_kind
from tests.attack.stored import STORED, trains_kind
from tests.plant_models.hump.random_humps import SMALL
from tests.synth.hump.making.test_hump_make import SHORT
from tests.tuning_tables.pass_log.sample_logs import sample_log
from tuning_tables.pass_log.log_files import write_log

CONFIGURATION: Final = "the configuration"
"""What messages call the configuration that logs are read for; it may be what a log does not fit."""

TRIAL: Final = 'hump = "medium"\n[trains]\nlist = "list.csv"\n'
LIST: Final = """\
cut,cars,axles,mass_t,category,track,length_m,rolling,lead,hump_speed_m_s,marks
1,2,8,151.5,T,11,27.84,mean,0,1.7,
2,1,4,23,L,3,13.92,bad,0,1.7,do-not-hump long-base
3,3,12,150.0,S,8,41.76,good,0,1.5,
"""
SWEPT: Final = """\
position.name = "rnz-2m-park"
[sweep]
exit_speeds_m_s = { from = 1.5, to = 2.5, step = 0.5 }
[[sweep.cut]]
car = "gondola-4"
cars = [1, 2]
mass_per_car_t = [22, 85]
[[sweep.condition]]
name = "wet"
friction.common_cv = 0.2
"""
MAPPING: Final = """\
delimiter = ";"
decimal = ","
path = "from speed"
[columns]
cut_id = "Wagen"
time_s = "Zeit"
path_m = "Weg"
speed_m_s = "v"
stage = "Stufe"
mass_t = "Masse"
[units]
speed_m_s = "km/h"
time_s = "ms"
[constant]
axles = 4
category = "T"
target_m_s = 2.0
stopped_by_hand = 0
"""
OF_THE_LOG: Final = r".*foreign\.csv: .*(no column|column (cut_id|time_s|path_m|speed_m_s|stage|mass_t)\b)"
"""What may be said of a log that a mapping does not fit: of its own columns, not of what the mapping adds."""


def read_hump_file(folder: Path, name: str) -> str:
    """As `hump check`, which prints what it has read."""
    check_command(folder / name, Manner())
    return ""


def read_trial(folder: Path) -> str:
    """As `hump simulate`."""
    SIMULATE.resolve(asked_of(SIMULATE, SIMULATE.options(config=folder / "trial.toml"), "init trial"))
    return ""


def read_short_hump(folder: Path) -> str:
    """As `hump make`."""
    MAKE.resolve(asked_of(MAKE, MAKE.options(config=folder / "short.toml"), "init short-hump"))
    return ""


def read_aim(folder: Path) -> str:
    """As `aim`."""
    AIM.resolve(asked_of(AIM, AIM.options(config=folder / "aim.toml"), "init aim"))
    return ""


def read_computer(folder: Path) -> str:
    """As `computer`."""
    COMPUTER.resolve(asked_of(COMPUTER, COMPUTER.options(config=folder / "computer.toml"), "init computer"))
    return ""


def read_sweep(folder: Path) -> str:
    """As `sweep run`."""
    SWEEP_RUN.resolve(asked_of(SWEEP_RUN, SWEEP_RUN.options(config=folder / "sweep.toml"), "init sweep"))
    return ""


def read_sensors(folder: Path) -> str:
    """As `tune` with point sensors."""
    typed = TuneOptions(config=folder / "sensors.toml", workers=1)
    SENSORS_TUNE.resolve(asked_of(SENSORS_TUNE, typed, "init point-sensors"))
    return ""


def read_log(folder: Path, name: str, mapping: str | None = None) -> str:
    """As `identify`, `watch`, `replay` and `retune`: the hash of all passes."""
    foreign = None if mapping is None else folder / mapping
    log = loaded_passes([folder / name], foreign, load_config(None), CONFIGURATION, say).log
    kept = [getattr(log, field.name) for field in fields(log)]
    parts = (each.tobytes() if isinstance(each, np.ndarray) else repr(each).encode() for each in kept)
    return hashlib.sha256(b"".join(parts)).hexdigest()


def plain(text: str) -> bytes:
    """A template without its comments: to change those shows nothing."""
    return "".join(f"{line}\n" for line in text.splitlines() if line and not line.startswith("#")).encode()


def railml() -> bytes:
    """The same hump as railML: grades, curves and a radar."""
    return to_railml(parse_hump(SMALL, "small", "small.toml"))


def small_csv() -> bytes:
    """The same hump as a table."""
    return to_csv(parse_hump(SMALL, "small", "small.toml")).encode()


def log_as(name: str) -> bytes:
    """A small log, as the commands write it to a file called `name`."""
    with tempfile.TemporaryDirectory() as folder:
        write_log(sample_log(4, 30), Path(folder) / name)
        return (Path(folder) / name).read_bytes()


def foreign_hdf5() -> bytes:
    """The same log as another program writes it: no seal, no checksums, texts of any length."""
    with h5py.File(io.BytesIO(log_as("log.h5"))) as own, h5py.File(io.BytesIO(), "w") as foreign:
        foreign.attrs.update(own.attrs)
        for name, column in own.items():
            foreign[name] = column[()]
        foreign.flush()
        image: bytes = foreign.id.get_file_image()
        return image


def foreign_csv() -> bytes:
    """A log with the columns of `MAPPING`."""
    log = sample_log(4, 30)
    passes = np.repeat(np.arange(4), 30)
    cuts = [log.cut_id[number] for number in passes]
    columns = cuts, 1e3 * log.time_s, log.path_m, 3.6 * log.speed_m_s, log.stage, log.mass_t[passes]
    rows = (";".join(map(str, row)).replace(".", ",") for row in zip(*columns, strict=True))
    return "\n".join(("Wagen;Zeit;Weg;v;Stufe;Masse", *rows, "")).encode()


def file_kind(name: str, content: bytes, read: Callable[[Path], str]) -> Kind:
    """A text by itself."""
    return Kind(name, {name: content}, name, read)


def log_kind(name: str, content: bytes, allowed: Reading) -> Kind:
    """A log by itself."""
    change, read = partial(mutant, text=name.endswith(".csv")), partial(read_log, name=name)
    return Kind(name, {name: content}, name, read, change, allowed=allowed, elsewhere=CONFIGURATION)


def list_kind() -> Kind:
    """A sorting list, which a trial names."""
    files = {"list.csv": LIST.encode(), "trial.toml": TRIAL.encode()}
    return Kind("list.csv", files, "list.csv", read_trial)


def mapping_kind() -> Kind:
    """A mapping, with a log that it fits."""
    files = {"mapping.toml": MAPPING.encode(), "foreign.csv": foreign_csv()}
    read = partial(read_log, name="foreign.csv", mapping="mapping.toml")
    return Kind("mapping.toml", files, "mapping.toml", read, elsewhere=f"{CONFIGURATION}|{OF_THE_LOG}")


EMPTY: Final = (Changed(b"", "it is empty", Reading.NONE),)
"""Where half of all random changes make another sound file, one that makes none."""

KINDS: Final[Mapping[str, Callable[[], Kind]]] = {
    "hump": lambda: file_kind("hump.toml", SMALL.encode(), partial(read_hump_file, name="hump.toml")),
    "railml": lambda: file_kind("hump.railml", railml(), partial(read_hump_file, name="hump.railml")),
    "hump-csv": lambda: file_kind("hump.csv", small_csv(), partial(read_hump_file, name="hump.csv")),
    "short-hump": lambda: file_kind("short.toml", SHORT.encode(), read_short_hump),
    "trial": lambda: file_kind("trial.toml", plain(default_trial_toml()), read_trial),
    "aim": lambda: file_kind("aim.toml", plain(default_aim_toml()), read_aim),
    "computer": lambda: file_kind("computer.toml", plain(default_computer_toml()), read_computer),
    "sensors": lambda: file_kind("sensors.toml", plain(default_sensors_toml()), read_sensors),
    "sweep": lambda: file_kind("sweep.toml", SWEPT.encode(), read_sweep),
    "mapping": mapping_kind,
    "list": list_kind,
    "csv-log": lambda: log_kind("log.csv", log_as("log.csv"), Reading.ANY),
    "hdf5-log": lambda: log_kind("log.h5", log_as("log.h5"), Reading.SAME),
    "foreign-hdf5": lambda: log_kind("log.h5", foreign_hdf5(), Reading.ANY),
    "trains": trains_kind,
    "railml-attributes": lambda: attribute_kind(railml()),
    "forged-log": lambda: replace(log_kind("log.h5", log_as("log.h5"), Reading.ANY), change=forged, first=EMPTY),
    "forged-foreign": lambda: replace(log_kind("log.h5", foreign_hdf5(), Reading.ANY), change=forged, first=EMPTY),
    **STORED,
}
