"""The ledger of a sweep: a line an event, only ever appended, forced to the disk, each under its own checksum.

A line is the canonical JSON of an object with a CRC-32 (see `tuning_tables.canonical`). A process that is killed can
leave a torn last line: the next writer ends it, every reader passes over it. What was computed is told by the files of
the units; the ledger tells when, how long, and why something failed.
"""

from __future__ import annotations

import errno
import json
import os
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

from tuning_tables.atomic_file import faults_naming
from tuning_tables.canonical import CHECKSUM_KEY, canonical_json, document_checksum

PLAN, STARTED, DONE, FAILED, ENDED = "plan", "started", "done", "failed", "ended"

Event = dict[str, Any]


@dataclass(frozen=True)
class Ledger:
    """The sound events in their order, and how many lines were not."""

    events: tuple[Event, ...]
    bad_lines: int

    @property
    def created(self) -> str | None:
        """The date that the first run gave the tables, None before there was one."""
        return next((str(event["created"]) for event in self.of(PLAN)), None)

    @property
    def plan(self) -> Event | None:
        """The last plan, None before there was one."""
        return next(reversed(self.of(PLAN)), None)

    def of(self, kind: str) -> list[Event]:
        """All events of a kind."""
        return [event for event in self.events if event["event"] == kind]

    def since_plan(self) -> list[Event]:
        """What happened since the last run began."""
        starts = [place for place, event in enumerate(self.events) if event["event"] == PLAN]
        return list(self.events[starts[-1] + 1 :]) if starts else []


def read_ledger(path: Path) -> Ledger:
    """Every sound line of the ledger at `path`; nothing where there is no file."""
    try:
        lines = path.read_bytes().split(b"\n")
    except FileNotFoundError:
        return Ledger((), 0)
    events = [event_in(line) for line in lines if line]
    sound = tuple(event for event in events if event is not None)
    return Ledger(sound, len(events) - len(sound))


def event_in(line: bytes) -> Event | None:
    """The event in a line, None where it is torn or changed."""
    try:
        event = json.loads(line)
        if isinstance(event, dict) and event.get(CHECKSUM_KEY) == document_checksum(event):
            return event if isinstance(event.get("event"), str) else None
    except (ValueError, RecursionError):
        pass
    return None


class LedgerWriter:
    """Appends to the ledger at a path; a context manager. Only the holder of the directory may write."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._file = path.open("ab+", buffering=0)
        with faults_naming(path):
            if self._file.tell():
                self._file.seek(-1, os.SEEK_END)
                if self._file.read(1) != b"\n":
                    self._file.write(b"\n")

    def __enter__(self) -> LedgerWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()

    def write(self, kind: str, facts: Mapping[str, Any]) -> None:
        """Append one event with the time; on the disk when this returns. Raises `OSError` that names the ledger."""
        event = {"event": kind, "time_s": round(time.time(), 3), **facts}
        line = canonical_json({**event, CHECKSUM_KEY: document_checksum(event)}) + b"\n"
        with faults_naming(self._path):
            if self._file.write(line) != len(line):
                raise OSError(errno.ENOSPC, "the disk took only a part of a line")
            os.fsync(self._file.fileno())
