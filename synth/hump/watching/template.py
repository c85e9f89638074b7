"""A commented file of a yard that is watched, to start from."""

from __future__ import annotations

from synth.frame.settings.template import NOTHING, template
from synth.hump.watching.settings import EXAMPLE

LINES = "Two positions as an example:\n# put those of your yard in their place. A name is all that a position needs."


def example_yard_toml() -> str:
    """Two positions with the built-in plant."""
    return template(EXAMPLE, "Yard that is watched", "hump watch", NOTHING, (), LINES)
