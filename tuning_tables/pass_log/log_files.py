"""Reading files of measured passes as one log, and writing a log."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Final

from tuning_tables.errors import InvalidLog, excerpt
from tuning_tables.pass_log.checked_log import checked_log
from tuning_tables.pass_log.csv_log import read_csv_log, write_csv_log
from tuning_tables.pass_log.hdf5_log import read_hdf5_log, write_hdf5_log
from tuning_tables.pass_log.log_columns import LONGEST_TEXT, FileFault, PassFault
from tuning_tables.pass_log.log_mapping import LogMapping
from tuning_tables.pass_log.pass_log import PassLog, join_logs

READERS: Final = {".csv": read_csv_log, ".txt": read_csv_log, ".h5": read_hdf5_log, ".hdf5": read_hdf5_log}
WRITERS: Final = {".csv": write_csv_log, ".h5": write_hdf5_log, ".hdf5": write_hdf5_log}


@dataclass(frozen=True, eq=False)
class LoadedLogs:
    """What `read_logs` read: `log`, of `files`; passes that were left out (`faults`), and files that were (`refused`).

    Examples
    --------
    See `read_logs`.
    """

    log: PassLog
    files: tuple[Path, ...]
    faults: tuple[PassFault, ...]
    refused: tuple[FileFault, ...]


def read_logs(
    paths: Sequence[str | os.PathLike[str]], mapping: LogMapping | None = None, top_stage: int | None = None
) -> LoadedLogs:
    """Read files of measured passes as one log.

    Files follow each other in time; those whose times overlap have clocks of their own and stay in the order given. A
    cut_id that two files have gets the file's name before it.

    Parameters
    ----------
    paths
        Files (.csv, .txt, .h5, .hdf5), and folders of such files.
    mapping
        How foreign columns are named and measured; None: as this project writes them.
    top_stage
        The highest stage of the position; a pass with a higher one is left out. None: any.

    Returns
    -------
    LoadedLogs
        The sound passes; files that cannot be used and passes that are not sound are named beside them.

    Raises
    ------
    InvalidLog
        No file is named, or no pass is left.

    Examples
    --------
    With `log` from the example of `PassLog`:

    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from tuning_tables.pass_log import read_logs, write_log
    >>> with TemporaryDirectory() as folder:
    ...     write_log(log, Path(folder, "evening.csv"))
    ...     loaded = read_logs([folder])
    >>> loaded.log, [file.name for file in loaded.files], loaded.faults
    (PassLog(1 passes, 6 rows), ['evening.csv'], ())
    """
    found: list[tuple[Path, PassLog]] = []
    faults: list[PassFault] = []
    refused: list[FileFault] = []
    for path in _files([Path(path) for path in paths]):
        try:
            log, told = _read(path, mapping or LogMapping(), top_stage)
        except InvalidLog as fault:
            refused.append(FileFault(os.fspath(path), str(fault)))
            continue
        except OSError as fault:
            refused.append(FileFault(os.fspath(path), f"{path}: {fault.strerror or fault}."))
            continue
        faults += told
        if log is None:
            refused.append(FileFault(os.fspath(path), f"{path}: no pass of it is sound; {told[0].sentence}"))
        else:
            found.append((path, log))
    if not found and not refused:
        raise InvalidLog("no log is named; name a file or a folder.")
    if not found:
        more = f" (and {len(refused) - 1} more files)" if len(refused) > 1 else ""
        raise InvalidLog(f"no measured pass can be used: {refused[0].sentence}{more}")
    ordered = _in_order_of_time(found)
    log = join_logs(_with_own_ids(ordered))
    return LoadedLogs(log, tuple(path for path, _ in ordered), tuple(faults), tuple(refused))


def write_log(log: PassLog, path: str | os.PathLike[str]) -> None:
    """Write a log to a file, complete or not at all; it reads back exactly.

    Parameters
    ----------
    log
        The passes.
    path
        A file whose ending says the form: .csv, .h5 or .hdf5.

    Raises
    ------
    InvalidLog
        Another ending, or a cut_id or category that a file cannot hold.
    OSError
        The disk refuses it.

    Examples
    --------
    With `log` from the example of `PassLog`:

    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from tuning_tables.pass_log import write_log
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder, "evening.csv")
    ...     write_log(log, file)
    ...     print(file.read_text().splitlines()[-2])
    17,...
    """
    path = Path(path)
    require_writable_name(path)
    twice = [cut_id for cut_id, count in Counter(log.cut_id).items() if count > 1]
    if twice:
        raise InvalidLog(f"{path}: cut_id {excerpt(twice[0])!r} stands for two passes; give each its own.")
    for text in {*log.cut_id, *log.category}:
        if text != text.strip() or not 0 < len(text) <= LONGEST_TEXT or not text.isprintable() or text == "nan":
            raise InvalidLog(
                f"{path}: {excerpt(text)!r} is no name for a cut or category; it must have 1 to {LONGEST_TEXT} "
                "printable characters, and no space around them."
            )
    WRITERS[path.suffix.lower()](log, path)


def require_writable_name(path: Path) -> None:
    """`InvalidLog` where `path` has an ending that no log is written with."""
    if path.suffix.lower() not in WRITERS:
        raise InvalidLog(f"{path}: a log is written to a file that ends in {', '.join(WRITERS)}; name it so.")


def _read(path: Path, mapping: LogMapping, top_stage: int | None) -> tuple[PassLog | None, tuple[PassFault, ...]]:
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise InvalidLog(f"{path}: a log ends in {', '.join(READERS)}; name it so.")
    return checked_log(reader(path, mapping), top_stage)


def _files(paths: Sequence[Path]) -> Iterator[Path]:
    for path in dict.fromkeys(paths):
        if not path.is_dir():
            yield path
            continue
        inside = sorted(each for each in path.iterdir() if each.suffix.lower() in READERS and each.is_file())
        if not inside:
            raise InvalidLog(f"{path}: no log in this folder; logs end in {', '.join(READERS)}.")
        yield from inside


def _in_order_of_time(found: list[tuple[Path, PassLog]]) -> list[tuple[Path, PassLog]]:
    """Sorted by their beginnings, if no two files overlap."""
    ordered = sorted(found, key=lambda each: float(each[1].time_s[0]))
    apart = all(now.time_s[0] > ahead.time_s[-1] for (_, ahead), (_, now) in pairwise(ordered))
    return ordered if apart else found


def _with_own_ids(found: list[tuple[Path, PassLog]]) -> list[PassLog]:
    """The logs, with the file's name before each cut_id that more than one file has."""
    count = Counter(cut_id for _, log in found for cut_id in log.cut_id)
    return [
        replace(log, cut_id=tuple(f"{path.stem}/{each}" if count[each] > 1 else each for each in log.cut_id))
        for path, log in found
    ]
