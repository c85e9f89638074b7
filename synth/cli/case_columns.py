"""Columns of printed tables of cases, from what a summary says of a case; a case without a figure shows that."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from synth.book.permissions.overview import SHORT
from synth.book.permissions.permission import Permission
from synth.frame.printed_numbers import plus_minus, ten_thousand
from synth.frame.terminal.printed_table import Column
from synth.frame.terminal.printed_words import NO_BREAK

Case = dict[str, Any]
"""An entry of `cases` of a summary.json. Figures of a case that has no table are missing or None."""

WITHIN: Final = {
    "p95": f"95{NO_BREAK}of{NO_BREAK}100 within{NO_BREAK}±, m/s",
    "p99": f"99{NO_BREAK}of{NO_BREAK}100 within{NO_BREAK}±, m/s",
}
OUT_OF_BRAKE_IN: Final = f"out{NO_BREAK}of{NO_BREAK}brake in{NO_BREAK}10{NO_BREAK}000"
PREDICTED: Final = f"predicted{NO_BREAK}/ simulated"


def error(figure: str) -> Callable[[Case], str | None]:
    """What tells a simulated error in m/s with its interval, for a column."""

    def cell(case: Case) -> str | None:
        found = case.get("simulated")
        return None if found is None else plus_minus(found[f"{figure}_m_s"], found[f"{figure}_ci95_m_s"], 4)

    return cell


def ratio(figure: str) -> Callable[[Case], str | None]:
    """What tells a ratio with its interval, for a column."""
    return lambda case: plus_minus(case.get(figure), case.get(f"{figure}_ci95"))


def out_of_brake(case: Case) -> str | None:
    """Cuts that no table could brake enough, in 10 000."""
    power = case.get("brake_power")
    return None if power is None else ten_thousand(power["out_of_brake"], power["out_of_brake_ci95"])


def best_baseline(case: Case) -> str | None:
    """The rms of the best of the baselines, and its name."""
    name = case.get("best_baseline")
    if name is None:
        return None
    found = case["comparison"][name]
    return f"{plus_minus(found['rms_m_s'], found['rms_ci95_m_s'], 4)} {name}"


def switchings(case: Case) -> str | None:
    """Changes of the stage in a pass."""
    found = case.get("simulated")
    return None if found is None else f"{found['switchings']:.1f}"


def time(case: Case) -> str | None:
    """Mean time in the position."""
    found = case.get("simulated")
    return None if found is None else plus_minus(found["time_s"], found["time_ci95_s"])


def permission_column(permission: Permission) -> Column[Case]:
    """The rms that a permission gives, over that of the table as configured."""

    def cell(case: Case) -> str | None:
        found = (case.get("permissions") or {}).get(permission.value)
        return None if found is None else f"{found['ratio']:.2f}"

    return Column(f"rms × if {SHORT[permission].replace(' ', NO_BREAK)}", cell, spare=2)


def without_table(failed: dict[str, Any]) -> Case:
    """The row of an entry of `failed` of a summary.json."""
    return {"label": failed["label"], "target_speed_m_s": failed["target_m_s"], "verdict": "no table"}


CASE: Final = Column[Case]("case", lambda case: case["label"], words=True, once=True)
TARGET: Final = Column[Case]("target, m/s", lambda case: f"{case['target_speed_m_s']:g}")
RMS: Final = Column[Case]("rms, m/s", error("rms"))
UNAVOIDABLE: Final = Column[Case](
    "unavoidable, m/s",
    lambda case: plus_minus(case.get("unavoidable_rms_m_s"), case.get("unavoidable_ci95_m_s"), 4),
    spare=2,
)
WITHIN_95: Final = Column[Case](WITHIN["p95"], error("p95"), spare=3)
WITHIN_99: Final = Column[Case](WITHIN["p99"], error("p99"), spare=4)
OUT_OF_BRAKE: Final = Column[Case](OUT_OF_BRAKE_IN, out_of_brake, spare=1)
HONESTY: Final = Column[Case](PREDICTED, ratio("honesty"))
AT_REST: Final = Column[Case](f"rms{NO_BREAK}/ at{NO_BREAK}rest", ratio("at_rest_ratio"), spare=7)
REGRET: Final = Column[Case]("regret", ratio("regret"), spare=5)
BEST_BASELINE: Final = Column[Case]("best baseline, m/s", best_baseline, spare=6)
SWITCHINGS: Final = Column[Case]("switchings", switchings, spare=8)
TIME: Final = Column[Case]("time, s", time, spare=9)
VERDICT: Final = Column[Case]("verdict", lambda case: case["verdict"], words=True)
