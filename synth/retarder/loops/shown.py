"""What is shown of tables as control loops: a row for each, their pictures, and all figures for programs."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Final, TypeAlias

from matplotlib.figure import Figure

from synth.frame.command import Limit
from synth.frame.exhibits import Chapter, Chart, Column, Exhibit, File, Row, Sentence, Table, Tile, Tiles
from synth.frame.printed_numbers import counted, decimals
from synth.frame.told import plain
from synth.retarder.comparison.limit_cycle import Hunting
from synth.retarder.forms.tables_at import file_stem
from synth.retarder.loops.block_diagram import loop_structure
from synth.retarder.loops.control_loop import TOLERANCE_M_S, LineControlLoop, PassageControlLoop
from synth.retarder.loops.pictures import loop_cycle, loop_portrait, loop_response
from synth.simulation.nominal_response import commands_of

AnyLoop: TypeAlias = LineControlLoop | PassageControlLoop

DOCUMENT: Final = "loops.json"
LOOPS: Final = (
    Column("id", "table", words=True),
    Column("python_control_m_s", "exit by python-control", "m/s", decimals(4)),
    Column("simulator_m_s", "exit by the simulator", "m/s", decimals(4)),
    Column("difference_mm_s", "largest difference", "mm/s", decimals(3)),
    Column("parted_s", "parted at", "s", decimals(2), spare=4),
    Column("commands", "commands in a pass", spare=1),
    Column("forecast", "commands in the mean", form=decimals(1), spare=3),
    Column("by_noise", "of them by noise", form=decimals(1), spare=3),
    Column("cycles", "predicted limit cycle, stages: path, amplitude, period", words=True, spare=2),
)

RESPONSE: Final = "The nominal pass by python-control and by the simulator: speed, their difference, pressure, stage."
PORTRAIT: Final = "Passes from several entry speeds, coloured by the stage in force, with the lines of the table."
CYCLE: Final = (
    "Left: speed over time, in closed form and by the first harmonic. Right: where the describing function balances."
)
STRUCTURE: Final = "The regulator of named parts, signal by signal."


def chapters(title: str, loops: Sequence[AnyLoop]) -> Iterator[Chapter]:
    """The table, then the pictures of each loop."""
    yield Chapter("Loops", tuple(overview(title, loops)))
    for loop, stem in zip(loops, stems(loops), strict=True):
        yield Chapter(loop.table.id, tuple(charts(loop, stem)))
    content = json.dumps(plain({"loops": [loop.document for loop in loops]}), indent=1, ensure_ascii=False)
    yield Chapter("Figures", (File(DOCUMENT, f"{content}\n".encode(), "All commands, differences and limit cycles"),))


def stems(loops: Sequence[AnyLoop]) -> list[str]:
    """The ids of the tables as names of files; the second and later ones of a name are counted."""
    names: list[str] = []
    for loop in loops:
        stem = file_stem(loop.table)
        count = sum(name == stem or name.startswith(f"{stem}~") for name in names)
        names.append(f"{stem}~{count + 1}" if count else stem)
    return names


def overview(title: str, loops: Sequence[AnyLoop]) -> Iterator[Exhibit]:
    """A row for each loop, and what the columns mean."""
    yield tiles(loops)
    if not all(loop.agrees for loop in loops):
        yield Sentence("Do not believe these figures: tell the maintainers which table it was.", to_do=True)
    yield Table("loops", title, LOOPS, [row_of(loop) for loop in loops], True, lambda row: not row["agrees"])
    yield Sentence(
        "Nominal pass: mean friction and resistance, median entry speed, no noise. Python-control and the simulator "
        f"agree where the largest difference is {1e3 * TOLERANCE_M_S:g} mm/s or less. Parted at: from a "
        "decision at a speed on a line on, where rounding decides, these are two passes; they are compared up to "
        "there. Commands in the mean: of passes with all that is random, and how many of them the noise of the radar "
        "makes.",
        brief=True,
    )


def tiles(loops: Sequence[AnyLoop]) -> Tiles:
    """Whether the two computations agree, and how many tables can hunt."""
    largest = max(1e3 * abs(loop.difference.largest_m_s) for loop in loops)
    agree, hunting = sum(loop.agrees for loop in loops), sum(bool(hunting_of(loop)) for loop in loops)
    return Tiles(
        (
            Tile(f"{agree} of {len(loops)}", "loops are the same to both computations", agree == len(loops)),
            Tile(f"{largest:.2f} mm/s", "is the largest difference between python-control and the simulator"),
            Tile(f"{hunting} of {len(loops)}", "tables have room for a limit cycle between two stages"),
        )
    )


def limits_of(loops: Sequence[AnyLoop]) -> Iterator[Limit]:
    """A limit for each loop on which the two do not agree, or one for all."""
    for loop in loops:
        if not loop.agrees:
            yield Limit(f"{loop.table.id}: {sentence(loop)}", False)
    if all(loop.agrees for loop in loops):
        yield Limit(f"python-control and the simulator agree on {counted(len(loops), 'loop')}", True)


def sentence(loop: AnyLoop) -> str:
    """How far response and trace are apart, in words."""
    found = loop.difference
    parted = "" if found.parted_s is None else f" until {found.parted_s:.2f} s, when a speed on a line parts them"
    word = "agree" if loop.agrees else "do not agree"
    return f"python-control and the simulator {word}: at most {1e3 * abs(found.largest_m_s):.3f} mm/s apart{parted}"


def row_of(loop: AnyLoop) -> Row:
    """One loop."""
    forecast = None if isinstance(loop, PassageControlLoop) else loop.forecast
    return {
        "id": loop.table.id,
        "python_control_m_s": loop.response.exit_speed_m_s,
        "simulator_m_s": loop.trace.exit_speed_m_s,
        "difference_mm_s": 1e3 * abs(loop.difference.largest_m_s),
        "parted_s": loop.difference.parted_s,
        "commands": len(commands_of(loop.response)),
        "forecast": None if forecast is None else forecast.commands,
        "by_noise": None if forecast is None else forecast.by_noise,
        "cycles": cycles(loop),
        "agrees": loop.agrees,
    }


def hunting_of(loop: AnyLoop) -> tuple[Hunting, ...]:
    """Where it can hunt; a regulator that decides at passages has no period to hunt with."""
    return () if isinstance(loop, PassageControlLoop) else loop.hunting


def cycles(loop: AnyLoop) -> str | None:
    """The predicted limit cycles in one line."""
    if isinstance(loop, PassageControlLoop):
        return None
    if loop.pressure:
        stages = ", ".join(str(stage) for stage, _ in loop.pressure)
        return f"the pressure regulator itself hunts at stage {stages}"
    found = [
        f"{each.cycle.lower_stage}–{each.cycle.lower_stage + 1}: {each.from_m:.0f} to {each.to_m:.0f} m, "
        f"±{100.0 * each.cycle.amplitude_m_s:.1f} cm/s, {each.cycle.period_s:.1f} s"
        for each in loop.hunting
    ]
    return "; ".join(found) or "none"


def charts(loop: AnyLoop, stem: str) -> Iterator[Chart]:
    """The pictures of a loop; `stem`: the beginning of their names."""
    named = partial(chart, loop, stem)
    yield named("response", "Nominal response", RESPONSE, partial(loop_response, loop))
    structure = named("structure", "Block diagram", STRUCTURE, partial(loop_structure, loop))
    if isinstance(loop, PassageControlLoop):
        yield structure
        return
    yield named("portrait", "Phase portrait", PORTRAIT, partial(loop_portrait, loop))
    for i, hunting in enumerate(loop.hunting):
        name = "cycle" if i == 0 else f"cycle-{i + 1}"
        yield named(name, f"Limit cycle {i + 1}", CYCLE, partial(loop_cycle, loop, hunting))
    if loop.table.estimator is None:
        yield structure


def chart(loop: AnyLoop, stem: str, name: str, title: str, caption: str, draw: Callable[[], Figure]) -> Chart:
    """One picture of a loop."""
    return Chart(f"{stem}-{name}", f"{title}, {loop.table.id}", caption, draw)
