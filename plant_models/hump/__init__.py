"""The hump: its elements, the graph that they form, and the routes of it; metres, per mille, degrees, seconds."""

from plant_models.hump.edge import Curve, Edge, PointSensor, Radar
from plant_models.hump.elements import LEFT, RIGHT, Branch, Retarder, Signal, Switch, TrackSection
from plant_models.hump.hump_graph import HumpGraph
from plant_models.hump.ranges import (
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
from plant_models.hump.route import Route, RouteElement, Vertex

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
