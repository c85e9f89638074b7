"""The directory that a command leaves its results in: checked before anything is computed, held by one at a time."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import re
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from synth.faults.input_error import InputError
from synth.faults.machine_fault import MACHINE_FAULTS
from tuning_tables import TableError, read_table
from tuning_tables.atomic_file import faults_naming

SUMMARY = "summary.json"


@dataclass(frozen=True)
class Layout:
    """What a command leaves in its directory: `folders`, and a `summary` of this `form`; `noun`: the command."""

    noun: str
    form: str
    folders: tuple[str, ...]
    summary: str = SUMMARY


TUNE_LAYOUT: Final = Layout("tune", "retarder-summary", ("tables", "c", "plots"))
SENSORS_LAYOUT: Final = Layout("sensors tune", "sensor-summary", ("tables", "c", "st", "plots"))
AIM_LAYOUT: Final = Layout("aim", "aim-summary", ("tables", "c", "st", "plots"))
TRAINS_LAYOUT: Final = Layout("hump simulate", "hump-trial-summary", ("batches", "inputs", "plots"))
COMPUTER_LAYOUT: Final = Layout("computer", "control-computer-summary", ("plots",))
SENSITIVITY_LAYOUT: Final = Layout("sensitivity", "sensitivity-summary", ("plots",))
REPLAY_LAYOUT: Final = Layout("replay", "replay-summary", ("plots",))
RETUNE_LAYOUT: Final = Layout("retune", "retune-summary", ("tables", "plots"))
IDENTIFY_LAYOUT: Final = Layout("identify", "identify-summary", ("types", "plots"))
SENSOR_PLAN_LAYOUT: Final = Layout("sensors plan", "sensor-plan-summary", ("plots",))
PERMISSIONS_LAYOUT: Final = Layout("permissions", "permissions-summary", ("plots",))
WATCH_LAYOUT: Final = Layout("watch", "watch-summary", (), "watch.json")
LAYOUTS: Final = (
    TUNE_LAYOUT, SENSORS_LAYOUT, AIM_LAYOUT, TRAINS_LAYOUT, COMPUTER_LAYOUT, SENSITIVITY_LAYOUT, REPLAY_LAYOUT,
    RETUNE_LAYOUT, IDENTIFY_LAYOUT, WATCH_LAYOUT, SENSOR_PLAN_LAYOUT, PERMISSIONS_LAYOUT,
)  # fmt: skip
LEFTOVER = re.compile(r"\..+\.[0-9a-f]{16}\.part")
PICTURES = re.compile(
    r"(rms-by-controller|feasibility|switchings|degree-study|(exit-density|surfaces|policy-map|sample-passes)-.+)"
    r"\.(png|svg)"
)
"""File names of the pictures that a tune draws."""

PASSAGE_PICTURES = re.compile(r"(switching-speeds|exit-density|sample-passes)-.+\.(png|svg)")
"""Those of a tune for point sensors."""

AIM_PICTURES = re.compile(r"aim-(track|gaps|commands-by-cars|commands-by-resistance|chances-.+)\.(png|svg)")
"""Those of an aim."""

TRAIN_PICTURES = re.compile(r"hump-[a-z-]+\.(png|svg)")
"""Those of humped trains."""

COMPUTER_PICTURES = re.compile(r"computer-[a-z-]+\.(png|svg)")
"""Those of a control computer."""

SENSITIVITY_PICTURES = re.compile(r"sensitivity-[a-z-]+\.(png|svg)")
"""Those of shares of variance."""

MEASURED_PICTURES = re.compile(r"(identify|replay|retune)-[a-z-]+\.(png|svg)")
"""Those of measured passes."""

SENSOR_PLAN_PICTURES = re.compile(r"sensors-[a-z-]+\.(png|svg)")
"""Those of a plan of point sensors."""

PERMISSIONS_PICTURES = re.compile(r"permissions\.(png|svg)")
"""That of permissions of the hardware."""

SWEEP_LEDGER, SWEPT_CONFIG = "sweep/ledger.jsonl", "config.toml"
"""What is in every directory of a sweep, and beside every book of one."""

CSV_MARKS = (b"record,key,", b"\r\ntext,generator.name,retarder-synth,")


@contextlib.contextmanager
def output_directory(path: Path, layout: Layout = TUNE_LAYOUT) -> Iterator[Path]:
    """Make and hold `path` for one command; `InputError` if it cannot be written or another command holds it.

    Within: no summary, which would not belong to what is written next, and no leftovers of a killed command.
    """
    require_no_sweep(path)
    require_no_other(path, layout)
    make_directory(path)
    descriptor = os.open(path, os.O_RDONLY)
    try:
        try:
            # On the directory itself: no lock file is left, and the lock ends with the process, however it ends.
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError(
                f"{path}: another {layout.noun} is writing there; wait for it, or give another one by -o"
            ) from None
        except OSError:  # a file system without locks
            pass
        for folder in layout.folders:
            make_directory(path / folder)
        remove_leftovers(path)
        (path / layout.summary).unlink(missing_ok=True)
        with faults_naming(path):
            os.fsync(descriptor)
        yield path
    finally:
        os.close(descriptor)


def require_no_sweep(path: Path) -> None:
    """`InputError` if `path` is the directory of a sweep, or that of one of its conditions."""
    above = path.resolve().parent / SWEEP_LEDGER
    if (path / SWEEP_LEDGER).exists() or (above.exists() and (path / SWEPT_CONFIG).exists()):
        raise InputError(f"{path}: it holds the results of a sweep; give another directory by -o")


def require_no_other(path: Path, layout: Layout) -> None:
    """`InputError` if a command of another layout has left its results in `path`."""
    forms = {name: form_of(path / name) for name in {each.summary for each in LAYOUTS}}
    for other in LAYOUTS:
        if forms[other.summary] == other.form != layout.form:
            raise InputError(f"{path}: it holds the results of '{other.noun}'; give another directory by -o")


def form_of(summary: Path) -> object:
    """What a summary says that it is; None for a file that says nothing."""
    try:
        document = json.loads(summary.read_bytes())
    except (OSError, ValueError, RecursionError):
        return None
    return document.get("format") if isinstance(document, dict) else None


def make_directory(path: Path) -> None:
    """Make `path` a directory that can be written, if it is not; `InputError` otherwise."""
    try:
        path.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=path).close()
    except FileExistsError:
        raise InputError(f"{path}: this is a file; give a directory by -o") from None
    except NotADirectoryError:
        raise InputError(f"{path}: a part of this path is a file; give a directory by -o") from None
    except OSError as error:
        if error.errno in MACHINE_FAULTS:
            raise
        raise InputError(f"{path}: cannot be written ({error.strerror}); give another directory by -o") from None


def remove_leftovers(path: Path) -> None:
    """Remove the unfinished files that a killed command has left; only the holder of the directory may."""
    for folder in (path, *(path / name for name in {name for layout in LAYOUTS for name in layout.folders})):
        for file in folder.glob(".*.part"):
            if LEFTOVER.fullmatch(file.name):
                file.unlink(missing_ok=True)


def maker_of_table(file: Path) -> str:
    """Name of the program that made a controller table; `TableError` or `OSError` if it is none."""
    return read_table(file).generator.name


def remove_stale(
    path: Path,
    written: set[str],
    maker: Callable[[Path], str] = maker_of_table,
    pictures: re.Pattern[str] = PICTURES,
) -> tuple[str, ...]:
    """Remove what an earlier run left in `path` and this one did not write; names of odd files that were left alone.

    `written` holds names relative to `path`, with slashes. Removed are tables that retarder-synth made by the word of
    `maker`, whole ones, in tables/, pictures called as in `pictures` in plots/, and the report.
    """
    odd = []
    for file in sorted(path.glob("tables/*.json")):
        if f"tables/{file.name}" not in written and file.is_file():
            try:
                if maker(file) == "retarder-synth":
                    file.unlink()
            except (OSError, TableError):
                odd.append(f"tables/{file.name}")
    for file in sorted(path.glob("tables/*.csv")):
        if f"tables/{file.name}" not in written and is_own_csv(file):
            file.unlink()
    for file in sorted(path.glob("plots/*")):
        if f"plots/{file.name}" not in written and pictures.fullmatch(file.name) and file.is_file():
            file.unlink()
    report = path / "report.html"
    if report.name not in written and report.is_file() and b"retarder-synth" in report.read_bytes():
        report.unlink()
    return tuple(odd)


def is_own_csv(file: Path) -> bool:
    """Whether `file` is a table of this tool as CSV."""
    if not file.is_file():
        return False
    content = file.read_bytes()
    return content.startswith(CSV_MARKS[0]) and CSV_MARKS[1] in content
