"""Tables as control loops, for `retarder-synth inspect`: python-control beside the simulator; nothing is solved."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, TypeAlias

from synth.frame.input_error import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from synth.frame.terminal.printed_page import Exhibit
    from synth.retarder.configuration.resolved_config import ResolvedConfig
    from synth.retarder.line_control_loop import LineControlLoop
    from synth.retarder.passage_control_loop import PassageControlLoop
    from tuning_tables.table_kinds import StageTable

    AnyLoop: TypeAlias = LineControlLoop | PassageControlLoop

DOCUMENT = "loops.json"


def closing(table: StageTable, config: ResolvedConfig, source: str) -> Callable[[], AnyLoop]:
    """What closes the loop of `table` with the plant of `config` that it is for; `InputError` if there is none."""
    from synth.retarder.line_control_loop import line_control_loop
    from synth.retarder.passage_control_loop import passage_control_loop
    from synth.retarder.served_class import served_class
    from tuning_tables.decisions import Decisions
    from tuning_tables.passages.passage_table import PassageTable

    if isinstance(table, PassageTable):
        return partial(passage_control_loop, table, served_class(table, config, source))
    if table.decisions is Decisions.AT_ANY_TIME:
        raise InputError(
            f"{table.id}: the table decides at any time; the loop of python-control is built for tables that decide at "
            "rest and for point sensors: give one of those"
        )
    return partial(line_control_loop, table, served_class(table, config, source))


def pictures(loop: AnyLoop) -> dict[str, Figure]:
    """The pictures of a loop by the end of their name."""
    from synth.retarder.passage_control_loop import PassageControlLoop
    from synth.retarder.pictures.loop_cycle import loop_cycle
    from synth.retarder.pictures.loop_portrait import loop_portrait
    from synth.retarder.pictures.loop_response import loop_response
    from synth.retarder.pictures.loop_structure import loop_structure

    if isinstance(loop, PassageControlLoop):
        return {"response": loop_response(loop), "structure": loop_structure(loop)}
    figures = {"response": loop_response(loop), "portrait": loop_portrait(loop)}
    if loop.table.estimator is None:
        figures["structure"] = loop_structure(loop)
    for i, hunting in enumerate(loop.hunting):
        figures["cycle" if i == 0 else f"cycle-{i + 1}"] = loop_cycle(loop, hunting)
    return figures


def agreement(loops: Sequence[AnyLoop]) -> str:
    """Whether response and trace agree: how far the farthest are apart, or each that is too far, in words."""
    apart = [loop for loop in loops if not loop.agrees]
    if apart:
        each = "; ".join(f"{loop.table.id}: {distance(loop)} apart" for loop in apart)
        return f"python-control and the simulator DO NOT agree: {each}"
    farthest = max(loops, key=lambda loop: abs(loop.difference.largest_m_s))
    return f"python-control and the simulator agree: at most {distance(farthest)} apart"


def distance(loop: AnyLoop) -> str:
    """How far response and trace are apart."""
    found = loop.difference
    parted = "" if found.parted_s is None else f" until {found.parted_s:.2f} s, when a speed on a line parts them"
    return f"{1e3 * abs(found.largest_m_s):.3f} mm/s{parted}"


def loops_page(loops: Sequence[AnyLoop]) -> list[Exhibit]:
    """A table with one row for each loop, and what its columns mean."""
    from synth.frame.terminal.printed_table import Column, PrintedTable
    from synth.retarder.control_loop import TOLERANCE_M_S

    def difference(loop: AnyLoop) -> str:
        found = loop.difference
        return f"{1e3 * abs(found.largest_m_s):.3f}{'' if found.parted_s is None else ' *'}"

    columns: tuple[Column[AnyLoop], ...] = (
        Column("table", lambda loop: loop.table.id, words=True),
        Column("exit by python-control, m/s", lambda loop: f"{loop.response.exit_speed_m_s:.4f}"),
        Column("exit by the simulator, m/s", lambda loop: f"{loop.trace.exit_speed_m_s:.4f}"),
        Column("largest difference, mm/s", difference),
        Column("commands in a pass", lambda loop: str(len(loop.response.commands)), spare=1),
        Column("commands in the mean, by noise", forecast, spare=3),
        Column("predicted limit cycle, stages: path, amplitude, period", cycles, words=True, spare=2),
    )
    page: list[Exhibit] = [
        PrintedTable(columns, loops, DOCUMENT),
        "Nominal pass: mean friction and resistance, median entry speed, no noise. Python-control and the simulator "
        f"agree where the largest difference is {1e3 * TOLERANCE_M_S:g} mm/s or less. "
        "Commands in the mean: of passes with all that is random, and how many of them the noise of the radar makes.",
    ]
    if any(loop.difference.parted_s is not None for loop in loops):
        page.append(
            "*: up to a decision at a speed on a line. Rounding decides there; from then on these are two passes."
        )
    return page


def forecast(loop: AnyLoop) -> str | None:
    """Mean commands of real passes, and how many of them the noise of the radar makes."""
    from synth.retarder.passage_control_loop import PassageControlLoop

    if isinstance(loop, PassageControlLoop) or loop.forecast is None:
        return None
    return f"{loop.forecast.commands:.1f}, {loop.forecast.by_noise:.1f}"


def cycles(loop: AnyLoop) -> str:
    """The predicted limit cycles in one line; a regulator that decides at passages has no period to hunt with."""
    from synth.retarder.passage_control_loop import PassageControlLoop

    if isinstance(loop, PassageControlLoop):
        return "–"
    if loop.pressure:
        stages = ", ".join(str(stage) for stage, _ in loop.pressure)
        return f"the pressure regulator itself hunts at stage {stages}"
    found = [
        f"{each.cycle.lower_stage}–{each.cycle.lower_stage + 1}: {each.from_m:.0f} to {each.to_m:.0f} m, "
        f"±{100.0 * each.cycle.amplitude_m_s:.1f} cm/s, {each.cycle.period_s:.1f} s"
        for each in loop.hunting
    ]
    return "; ".join(found) or "none"
