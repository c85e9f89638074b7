"""The hump: its elements, the graph that they form, and the routes of it; metres, per mille, degrees, seconds."""

from plant_models.hump.edge import Curve, Edge, PointSensor, Radar
from plant_models.hump.element_number import (
    GROUPS,
    RETARDERS,
    SECTIONS,
    SIGNALS,
    SWITCHES,
    HumpError,
    HumpErrors,
    NumberGroup,
    element_name,
)
from plant_models.hump.hump_graph import HumpGraph
from plant_models.hump.retarder import Retarder
from plant_models.hump.route import Route, RouteElement, Vertex
from plant_models.hump.signal import Signal
from plant_models.hump.switch import LEFT, RIGHT, Branch, Switch
from plant_models.hump.track_section import TrackSection

__all__ = [
    "GROUPS",
    "LEFT",
    "RETARDERS",
    "RIGHT",
    "SECTIONS",
    "SIGNALS",
    "SWITCHES",
    "Branch",
    "Curve",
    "Edge",
    "HumpError",
    "HumpErrors",
    "HumpGraph",
    "NumberGroup",
    "PointSensor",
    "Radar",
    "Retarder",
    "Route",
    "RouteElement",
    "Signal",
    "Switch",
    "TrackSection",
    "Vertex",
    "element_name",
]
