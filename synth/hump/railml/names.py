"""Names of railML 3 and of the namespace for what it has no word for; nothing of railML's schema is here."""

from __future__ import annotations

from typing import Final

from plant_models.hump import Switch, Vertex

RAILML: Final = "https://www.railml.org/schemas/3.1"
OWN: Final = "urn:retarder-synth:hump:1"

LIBRARY, OWN_ZONES = "library", "own"
"""Where the zones of a retarder come from: its position in the library, or one that the library does not have."""

SIDES: Final = ("left", "right")


def railml(name: str) -> str:
    """A name of railML, as ElementTree has it."""
    return f"{{{RAILML}}}{name}"


def own(name: str) -> str:
    """A name of the namespace of ours."""
    return f"{{{OWN}}}{name}"


def net_element(vertex: Vertex, branch: int) -> str:
    """The identifier of an edge: that of a branch of a switch tells the side."""
    return f"ne_{vertex.number}_{SIDES[branch]}" if isinstance(vertex, Switch) else f"ne_{vertex.number}"


def net_relation(ahead: str, behind: str) -> str:
    """The identifier of the way from one edge to the next."""
    return f"nr_{ahead}_{behind}"


CONTAINERS: Final = (
    *("railML", "infrastructure", "topology", "netElements", "netRelations", "networks", "geometry", "gradientCurves"),
    *("horizontalCurves", "functionalInfrastructure", "signalsIS", "switchesIS", "trainDetectionElements", "tracks"),
)
READ: Final = (
    *("netElement", "relation", "netRelation", "elementA", "elementB", "network", "level", "networkResource", "name"),
    *("gradientCurve", "horizontalCurve", "spotLocation", "linearLocation", "associatedNetElement", "signalIS"),
    *("switchIS", "leftBranch", "rightBranch", "trainDetectionElement", "track"),
)
"""Elements of railML that are written, and read again; any other is read over and told."""
