"""A commented short hump file to start from."""

from __future__ import annotations

from synth.frame.settings.template import NOTHING, template
from synth.hump.making.short_file import NEEDED
from synth.hump.making.short_hump import EXAMPLE

LINES = (
    "An example: put the numbers of your hump in place of its own.\n"
    f"# What may not be left out: tracks or bunches, {', '.join(NEEDED)}; of a position type and from_m."
)


def example_short_toml() -> str:
    """The hump `medium` of the library as a short file."""
    return template(EXAMPLE, "Short hump file", "hump make", NOTHING, (), LINES)
