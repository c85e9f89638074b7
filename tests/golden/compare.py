"""How two golden runs differ, a line each."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping
from typing import Any

from tests.golden.record import Record

Renamed = Mapping[str, str]
"""How places and files of the run before begin → how they begin now."""


def differences(before: Mapping[str, Record], now: Mapping[str, Record], renamed: Renamed) -> Iterator[str]:
    """Every difference: orders, exit codes, files by name and hash, leaves by place and value, printed lines."""
    for line in sorted({*before, *now}):
        if line not in now or line not in before:
            yield f"{line}: {'only before' if line in before else 'only now'}"
        else:
            yield from (f"{line}: {found}" for found in between(before[line], now[line], renamed))


def between(before: Record, now: Record, renamed: Renamed) -> Iterator[str]:
    """Of one order."""
    if before.code != now.code:
        yield f"exit code {before.code} → {now.code}"
    yield from changed(moved(before.files, renamed), now.files)
    yield from changed(moved(before.leaves, renamed), now.leaves)
    lines = difflib.unified_diff(before.printed.splitlines(), now.printed.splitlines(), n=0, lineterm="")
    yield from (each for each in lines if each[:3] not in ("---", "+++"))


def moved(entries: Mapping[str, Any], renamed: Renamed) -> dict[str, Any]:
    """`entries` with their names of now; of several beginnings that fit the longest counts."""
    found = {}
    for name, value in entries.items():
        beginning = max((each for each in renamed if name.startswith(each)), key=len, default="")
        found[renamed.get(beginning, "") + name[len(beginning) :]] = value
    return found


def changed(before: Mapping[str, Any], now: Mapping[str, Any]) -> Iterator[str]:
    """Entries that came, went, or have another value; of two numbers, by how much."""
    for name in sorted({*before, *now}):
        if name not in now or name not in before:
            yield f"{name} {'is gone' if name in before else 'is new'}"
        elif before[name] != now[name] or type(before[name]) is not type(now[name]):
            yield f"{name}: {before[name]!r} → {now[name]!r}"
