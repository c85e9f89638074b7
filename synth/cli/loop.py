"""`retarder-synth loop`: exported tables in the loop as python-control sees it; nothing is solved."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from synth.frame.input_error import InputError
from synth.frame.terminal.telling import LIMITS_MISSED, OK, say

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from synth.retarder.configuration.resolved_config import ResolvedConfig
    from synth.retarder.line_control_loop import LineControlLoop
    from synth.retarder.passage_control_loop import PassageControlLoop
    from tuning_tables.table_kinds import StageTable

    AnyLoop: TypeAlias = LineControlLoop | PassageControlLoop

DOCUMENT = "loops.json"


def loop_command(source: Path, output: Path, config_path: Path | None, as_json: bool) -> int:
    """Draw and tell the loops of the tables in `source`; 1 if python-control and the simulator do not agree on one."""
    from synth.frame.results_directory import results_directory
    from synth.frame.settings.settings_file import BUILT_IN
    from synth.frame.terminal.interrupt import interruptible
    from synth.kernels.cache import guarded
    from synth.retarder.configuration.config_file import load_config
    from synth.retarder.forms.table_file import file_stem, files_at

    config = load_config(config_path)
    closings = [closing(table, config, str(config_path or BUILT_IN)) for table in any_tables(source)]
    from synth.frame.picture.figure_file import figure_files
    from synth.frame.summary import plain

    loops: list[AnyLoop] = []
    files: list[str] = []
    reads = [*files_at(source), *filter(None, [config_path])]
    with results_directory(output, "loop", reads) as directory, interruptible(directory, DOCUMENT):
        for close in closings:
            loop = guarded(close)
            for name, figure in pictures(loop).items():
                files += map(str, directory.write_all(figure_files(figure, f"{file_stem(loop.table)}-{name}")))
            loops.append(loop)
            say(f"{loop.table.id}: {sentence(loop)}")
        document = plain({"loops": [loop.document for loop in loops], "files": files})
        text = json.dumps(document, indent=1, ensure_ascii=False)
        directory.write(DOCUMENT, f"{text}\n".encode())
    if as_json:
        print(text)
    else:
        print_loops(loops, f"{len(files)} pictures and {DOCUMENT} in {output}")
    return OK if all(loop.agrees for loop in loops) else LIMITS_MISSED


def any_tables(source: Path) -> list[StageTable]:
    """The tables at `source`, of both kinds of decision; faults as `read_tables` has them."""
    from synth.retarder.forms.passage_file import read_passages
    from synth.retarder.forms.table_file import holds_tables, read_tables

    passages = read_passages(source)
    if passages and not holds_tables(source):
        return list(passages)
    return [*passages, *(table for file in read_tables(source, directory_allowed=True) for table in file.tables)]


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


def sentence(loop: AnyLoop) -> str:
    """How far response and trace are apart, in words."""
    found = loop.difference
    parted = "" if found.parted_s is None else f" until {found.parted_s:.2f} s, when a speed on a line parts them"
    word = "agree" if loop.agrees else "DO NOT agree"
    return f"python-control and the simulator {word}: at most {1e3 * abs(found.largest_m_s):.3f} mm/s apart{parted}"


def print_loops(loops: Sequence[AnyLoop], files: str) -> None:
    """A table with one row for each loop, what its columns mean, and where the `files` are."""
    from synth.frame.terminal.printed_page import Exhibit, print_page
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
    print_page(*page, files)


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
