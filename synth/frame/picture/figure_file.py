"""A figure as the bytes of a PNG and an SVG file: the same figure gives the same bytes."""

from __future__ import annotations

import io
import threading

import matplotlib
from matplotlib.figure import Figure
from matplotlib.text import Text

from synth.frame.picture.house_style import DOTS_PER_INCH, MATHEMATICS
from synth.frame.picture.picture import Drawing, drawing_files

IDENTIFIER_SALT = "retarder-synth"
"""Makes the identifiers inside an SVG a hash of what they name instead of random."""

_drawing = threading.Lock()


def draw(figure: Figure) -> Drawing:
    """Both forms of `figure`, without dates; a `$` in its texts is a `$`, but in `mathematics`."""
    png, svg = io.BytesIO(), io.BytesIO()
    for text in figure.findobj(Text):
        text.set_parse_math(text.get_label() == MATHEMATICS)
    # Settings of matplotlib are global: one thread at a time. That of mathematics is for what is written while drawing.
    with (
        _drawing,
        matplotlib.rc_context(
            {"svg.hashsalt": IDENTIFIER_SALT, "svg.fonttype": "path", "text.parse_math": False},
        ),
    ):
        figure.savefig(
            png, format="png", dpi=DOTS_PER_INCH, metadata={"Software": None}, pil_kwargs={"compress_level": 3}
        )
        figure.savefig(svg, format="svg", dpi=DOTS_PER_INCH, metadata={"Date": None, "Creator": None})
    return Drawing(png.getvalue(), svg.getvalue())


def figure_files(figure: Figure, name: str, folder: str = "") -> dict[str, bytes]:
    """`figure`, drawn as `folder/name.png` and `.svg`: what is to be written under each name."""
    return drawing_files(draw(figure), name, folder)
