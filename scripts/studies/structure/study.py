"""Do the named parts of the loop, run one by one as they are wired, give the simulator's pass?

The radar runs the table of the middle class of the default book to its middle target, as a tune makes it. The point
sensors run an energy rule made by hand, with the tracker: the loop is compared, not the accuracy of a rule. Passes have
mean friction and resistance and no noise; speeds are compared at every event of the simulator's pass.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from plant_models import Approach, Plant, PointSensors
from plant_models.point_sensors import deciding_passages
from scripts.studies.cases import tuned_table
from scripts.studies.structure.signals import SIGNALS
from scripts.studies.structure.wired_passages import wired_passage_pass
from scripts.studies.structure.wired_radar import wired_radar_pass
from scripts.studies.study import ABSENT, Findings, MarkdownTable, Method, Tell, option, table
from synth.retarder.configuration.config_file import load_config
from synth.retarder.sensors.passage_table import plausible_motion
from synth.simulation.controllers import TableController
from synth.simulation.nominal_response import (
    SAME_PASSAGE_S,
    NominalResponse,
    commands_of,
    nominal_entry_m_s,
    nominal_pass,
    nominal_plant,
    nominal_response,
    one_pass,
    response_difference,
)
from synth.simulation.passage_controller import PassageController, of_speeds
from synth.simulation.passage_loop import PassageLoop, close_passage_loop
from synth.simulation.passage_response import passage_response
from synth.simulation.passes import PassTrace
from synth.simulation.structure.diagram import Diagram, Sketch
from synth.simulation.structure.regulators import passage_diagram, radar_diagram

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SENSORS = PointSensors((-5.0, 4.0, 10.0, 17.0, 24.0, 30.0))
BRAKING_STEP_M_S2 = 0.22
"""Of the energy rule made by hand: what a stage more is worth."""

HALF_A_PERIOD = 0.5
WIRED_TOLERANCE_M_S, CONTROL_TOLERANCE_M_S = 1e-9, 1e-3


@dataclass(frozen=True)
class Options:
    """Which passes."""

    entries: tuple[float, ...] = option((0.1, 0.5, 0.9), "shares of all cuts that enter slower", (0.0, 1.0))


@dataclass(frozen=True)
class PartRow:
    """A part: name, symbol in the source, block, what it does, its signals, the function, its constants."""

    name: str
    symbol: str
    block: str
    does: str
    takes: tuple[str, ...]
    gives: tuple[str, ...]
    law: str
    numbers: tuple[str, ...]


@dataclass(frozen=True)
class Run:
    """One pass: commands, exit speeds, and the largest differences of speed from the simulator; inf if they part."""

    measuring: str
    entry_m_s: float
    commands: int
    simulated_m_s: float
    wired_m_s: float
    wired_apart_m_s: float
    control_m_s: float
    control_apart_m_s: float
    same_commands: bool


@dataclass(frozen=True)
class Structure(Findings):
    """The parts of both loops, what is drawn of them, and the passes."""

    config_sha256: str
    case: str
    sensors_m: tuple[float, ...]
    radar: tuple[PartRow, ...]
    point_sensors: tuple[PartRow, ...]
    radar_sketch: Sketch
    point_sensor_sketch: Sketch
    runs: tuple[Run, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`radar`: all its parts; `point-sensors`: those that differ from the radar's; `signals`; `passes`."""
        known = {(row.name, row.law) for row in self.radar}
        other = [row for row in self.point_sensors if (row.name, row.law) not in known]
        return {
            "radar": parts_table("Parts of the loop with a radar", self.radar),
            "point-sensors": parts_table("Parts of the loop with point sensors that differ", other),
            "signals": table(
                "Signals", ("signal", "meaning", "unit"),
                [(code(symbol), *SIGNALS[symbol]) for symbol in self.signals()],
            ),
            "passes": self.passes_table(),
        }  # fmt: skip

    def signals(self) -> tuple[str, ...]:
        """All signals on wires, in the order of `SIGNALS`."""
        there = {wire.signal for sketch in (self.radar_sketch, self.point_sensor_sketch) for wire in sketch.wires}
        return tuple(symbol for symbol in SIGNALS if symbol in there)

    def passes_table(self) -> MarkdownTable:
        """A row a pass."""
        heads = (
            "measured by", "enters with, m/s", "commands", "leaves with, m/s: simulator", "parts as wired",
            "python-control", "largest difference, mm/s: parts", "python-control",
        )  # fmt: skip
        rows = [
            (
                run.measuring, f"{run.entry_m_s:.3f}", str(run.commands), f"{run.simulated_m_s:.6f}",
                f"{run.wired_m_s:.6f}", f"{run.control_m_s:.6f}", f"{1e3 * run.wired_apart_m_s:.0e}",
                f"{1e3 * run.control_apart_m_s:.2f}",
            )
            for run in self.runs
        ]  # fmt: skip
        return table("The same passes three times", heads, rows)

    def sentences(self) -> tuple[str, ...]:
        """What was run."""
        places = ", ".join(f"{place:g}" for place in self.sensors_m)
        return (f"{self.case}; point sensors at {places} m",)

    def faults(self) -> tuple[str, ...]:
        """Passes that are not the simulator's."""
        return tuple(
            f"{run.measuring}, entry {run.entry_m_s:.3f} m/s: the {name} differ from the simulator's pass by "
            f"{1e3 * apart:.3g} mm/s"
            for run in self.runs
            for name, apart, allowed in (
                ("parts as wired", run.wired_apart_m_s, WIRED_TOLERANCE_M_S),
                ("responses by python-control", run.control_apart_m_s, CONTROL_TOLERANCE_M_S),
            )
            if not (run.same_commands and apart <= allowed)
        )


def parts_table(title: str, rows: tuple[PartRow, ...] | list[PartRow]) -> MarkdownTable:
    """A row a part."""
    heads = ("part", "in the source", "what it does", "takes", "gives", "computed by", "constants")
    return table(
        title, heads,
        [
            (
                row.name, row.symbol or ABSENT, row.does, codes(row.takes), codes(row.gives), code(row.law),
                ", ".join(row.numbers) or ABSENT,
            )
            for row in rows
        ],
    )  # fmt: skip


def code(word: str) -> str:
    """A word as code."""
    return f"`{word}`"


def codes(words: tuple[str, ...]) -> str:
    """Words as code, with commas."""
    return ", ".join(map(code, words)) or ABSENT


def part_rows(diagram: Diagram) -> tuple[PartRow, ...]:
    """The parts of a diagram as plain values."""
    drawn = {wire.signal for wire in diagram.wires}
    return tuple(
        PartRow(
            part.name, part.symbol, part.block.value, part.does, part.inputs,
            tuple(signal for signal in part.outputs if signal in drawn), part.law_name,
            tuple(number.text for number in part.numbers),
        )
        for part in diagram.parts
    )  # fmt: skip


def run(options: Options, tell: Tell) -> Structure:
    """Declare both loops, and run each pass three times."""
    config = load_config(None)
    label, plant = config.plants()[len(config.plants()) // 2]
    target = config.targets_m_s[len(config.targets_m_s) // 2]
    controller = TableController(tuned_table(config, plant, target))
    tell(f"the table of {label} to {target:g} m/s is tuned")
    ahead = replace(plant, approach=Approach(-SENSORS.path_m[0], plant.approach.entrance_stage))
    rule = energy_rule(ahead, SENSORS, target)
    radar = radar_diagram(plant, controller, HALF_A_PERIOD * plant.sensor.sample_period_s)
    points = passage_diagram(close_passage_loop(ahead, SENSORS, rule.stages), rule)
    return Structure(
        config_sha256=config.sha256,
        case=f"{label} to {target:g} m/s",
        sensors_m=SENSORS.path_m,
        radar=part_rows(radar),
        point_sensors=part_rows(points),
        radar_sketch=radar.sketch,
        point_sensor_sketch=points.sketch,
        runs=tuple(runs(plant, controller, ahead, rule, options.entries, tell)),
    )


def runs(
    plant: Plant, controller: TableController, ahead: Plant, rule: PassageController, entries: tuple[float, ...],
    tell: Tell,
) -> Iterator[Run]:  # fmt: skip
    """Every pass of both loops."""
    plant, ahead = nominal_plant(plant), nominal_plant(ahead)
    phase_s = HALF_A_PERIOD * plant.sensor.sample_period_s
    diagram = radar_diagram(plant, controller, phase_s)
    for u in entries:
        entry = nominal_entry_m_s(plant, u)
        wired = wired_radar_pass(diagram, plant, controller, entry)
        control = nominal_response(plant, controller, entry, phase_s)
        yield compared("radar", nominal_pass(plant, controller, u, HALF_A_PERIOD), wired, control)
        tell(f"radar: the pass that enters with {entry:.2f} m/s is compared")
    loop = close_passage_loop(ahead, replace(SENSORS, timer_noise_s=0.0, base_tolerance=0.0), rule.stages)
    for u in entries:
        yield passage_run(loop, rule, u)
        tell(f"point sensors: the pass that enters slower than all but {100.0 * (1.0 - u):.0f} per cent is compared")


def passage_run(loop: PassageLoop, rule: PassageController, entry_u: float) -> Run:
    """A pass with point sensors."""
    entry = nominal_entry_m_s(loop.plant, entry_u)
    wired = wired_passage_pass(passage_diagram(loop, rule), loop, rule, entry)
    trace = loop.follow(rule, loop.draws(one_pass(entry_u, 0.0)))
    return compared("point sensors", trace, wired, passage_response(loop, rule, entry))


def compared(measuring: str, trace: PassTrace, wired: NominalResponse, control: NominalResponse) -> Run:
    """How far the two responses are from the simulator's pass."""
    by_parts, by_control = (response_difference(each, trace, SAME_PASSAGE_S) for each in (wired, control))
    return Run(
        measuring=measuring,
        entry_m_s=float(wired.speed_m_s[0]),
        commands=len(commands_of(wired)),
        simulated_m_s=trace.exit_speed_m_s,
        wired_m_s=wired.exit_speed_m_s,
        wired_apart_m_s=abs(by_parts.largest_m_s),
        control_m_s=control.exit_speed_m_s,
        control_apart_m_s=abs(by_control.largest_m_s),
        same_commands=by_parts.parted_s is None and by_control.parted_s is None,
    )


def energy_rule(plant: Plant, sensors: PointSensors, target_m_s: float) -> PassageController:
    """Stage j + 1 where v² > v_t² + 2·a_j·(S_exit − s), a_j in equal steps; with the tracker."""
    met = deciding_passages(sensors, plant.cut, plant.exit_m)
    left_m = plant.exit_m - np.array([max(each.path_m, 0.0) for each in met])
    rates = BRAKING_STEP_M_S2 * (np.arange(plant.top_stage) + 0.4)
    speeds = np.sqrt(target_m_s**2 + 2.0 * rates * left_m[:, None])
    of_each_stage = np.repeat(speeds[:, None, :], plant.top_stage + 1, axis=1)
    return of_speeds(plant, sensors, of_each_stage, plausible_motion(plant, sensors).numbers)


METHOD = Method(Options, Options(entries=(0.5,)), Structure, run)


def figures(found: Structure) -> Mapping[str, Figure]:
    """A diagram for each measuring system."""
    from synth.retarder.loops.block_diagram import block_diagram
    from synth.retarder.loops.block_layout import POINT_SENSOR_ROUTES, RADAR_ROUTES

    return {
        "radar": block_diagram(found.radar_sketch, RADAR_ROUTES),
        "point-sensors": block_diagram(found.point_sensor_sketch, POINT_SENSOR_ROUTES),
    }
