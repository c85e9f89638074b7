"""A figure as the bytes of an SVG file: the same figure gives the same bytes.

One form, so that nothing is drawn twice: it is sharp at every size, browsers and word processors take it, and the page
of a command holds the same drawing. Text stays text: it can be found and copied, and takes a tenth of the bytes.
"""

from __future__ import annotations

import io
import threading

import matplotlib
from matplotlib.figure import Figure
from matplotlib.text import Text

from synth.frame.picture.house_style import DOTS_PER_INCH, FONTS, MATHEMATICS
from synth.frame.picture.picture import DARKENED

IDENTIFIER_SALT = "retarder-synth"
"""Makes the identifiers inside an SVG a hash of what they name instead of random."""

STYLE = b"*{stroke-linejoin: round; stroke-linecap: butt}"
"""What matplotlib begins the style sheet of a drawing with."""

NIGHT = f"@media (prefers-color-scheme: dark) {{svg{{filter: {DARKENED}}}}}".encode()
"""A drawing is dark where its reader has all dark."""

_drawing = threading.Lock()


def draw(figure: Figure) -> bytes:
    """The SVG of `figure`, without dates; a `$` in its texts is a `$`, but in `mathematics`."""
    svg = io.BytesIO()
    for text in figure.findobj(Text):
        text.set_parse_math(text.get_label() == MATHEMATICS)
    # Settings of matplotlib are global: one thread at a time. That of mathematics is for what is written while drawing.
    with (
        _drawing,
        matplotlib.rc_context(
            {
                "svg.hashsalt": IDENTIFIER_SALT,
                "svg.fonttype": "none",
                "font.sans-serif": FONTS,
                "text.parse_math": False,
            },
        ),
    ):
        figure.savefig(svg, format="svg", dpi=DOTS_PER_INCH, metadata={"Date": None, "Creator": None})
    return svg.getvalue().replace(STYLE, STYLE + NIGHT, 1)


def figure_files(figure: Figure, name: str) -> dict[str, bytes]:
    """`figure`, drawn: what is to be written under `name.svg`."""
    return {f"{name}.svg": draw(figure)}
