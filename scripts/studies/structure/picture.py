"""The pictures of the study `structure`: both block diagrams."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from synth.retarder.pictures.block_diagram import block_diagram
from synth.retarder.pictures.block_layout import POINT_SENSOR_ROUTES, RADAR_ROUTES

if TYPE_CHECKING:
    from scripts.studies.structure.study import Structure


def figures(found: Structure) -> Mapping[str, Figure]:
    """A diagram for each measuring system."""
    return {
        "radar": block_diagram(found.radar_sketch, RADAR_ROUTES),
        "point-sensors": block_diagram(found.point_sensor_sketch, POINT_SENSOR_ROUTES),
    }
