"""The block diagram of the loop of one table."""

from __future__ import annotations

from matplotlib.figure import Figure

from synth.retarder.line_control_loop import LineControlLoop
from synth.retarder.passage_control_loop import PassageControlLoop
from synth.retarder.pictures.block_diagram import block_diagram
from synth.retarder.pictures.block_layout import POINT_SENSOR_ROUTES, RADAR_ROUTES
from synth.retarder.pictures.table_picture import subject
from synth.simulation.controllers import TableController
from synth.simulation.structure.passage_diagram import passage_diagram
from synth.simulation.structure.radar_diagram import radar_diagram


def loop_structure(loop: LineControlLoop | PassageControlLoop) -> Figure:
    """The parts of the loop and their wires. `ValueError` for a table with an estimator."""
    if isinstance(loop, PassageControlLoop):
        return block_diagram(
            passage_diagram(loop.loop, loop.controller).sketch, POINT_SENSOR_ROUTES, subject(loop.table)
        )
    diagram = radar_diagram(loop.plant, TableController(loop.table), 0.5 * loop.plant.sensor.sample_period_s)
    return block_diagram(diagram.sketch, RADAR_ROUTES, subject(loop.table))
