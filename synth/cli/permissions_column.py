"""The one column of a tune's printed table that tells what permissions of the hardware would give."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from synth.book.permissions.overview import Overview
from synth.book.permissions.permission import CasePermissions, Permission

HEADS: Final[Mapping[Permission, tuple[str, str]]] = {
    Permission.ANY_TIME: ("any", "time"),
    Permission.ESTIMATOR: ("esti-", "mator"),
    Permission.ANY_TIME_ESTIMATOR: ("", "both"),
    Permission.JUMPS: ("", "jumps"),
    Permission.APPROACH: ("4 m ap-", "proach"),
    Permission.NO_APPROACH: ("no ap-", "proach"),
}
"""What stands above the figures, on two lines; the widest word gives each its width."""


def head(overview: Overview) -> str:
    """The head of the column, over three lines."""
    names = [HEADS[each] for each in overview.in_column]
    lines = (" ".join(f"{name[place]:>{max(map(len, name))}}" for name in names) for place in (0, 1))
    return "\n".join(("rms × if permitted", *lines))


def cell(case: CasePermissions, overview: Overview) -> str:
    """The figures of a case below their names."""
    found = ((case.of(each), max(map(len, HEADS[each]))) for each in overview.in_column)
    return " ".join(f"{each.ratio:{width}.2f}" if each else f"{'–':>{width}}" for each, width in found)
