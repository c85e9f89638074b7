"""How all pictures look: colours of Okabe and Ito, sizes, axes; nothing is set globally. Lines that follow an order
(cars, distances, resistances) go from dark to light, each with a marker.

A figure becomes the bytes of an SVG file, the same figure the same bytes. One form, so that nothing is drawn twice: it
is sharp at every size, browsers and word processors take it, and the page of a command holds the same drawing. Text
stays text: it can be found and copied, and takes a tenth of the bytes.
"""

from __future__ import annotations

import io
import math
import threading
from collections.abc import Iterable, Sequence
from typing import Final

import matplotlib
from matplotlib import colormaps
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator
from matplotlib.typing import LineStyleType

from synth.frame.picture.picture import DARKENED

BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILLION, PURPLE = "#0072B2", "#D55E00", "#CC79A7"
GREY, PALE_GREY, INK = "#767676", "#e6e6e6", "#222222"

DOTS_PER_INCH = 110

FONTS: Final = ("DejaVu Sans", "Verdana", "sans-serif")
"""matplotlib measures with the first, which it brings along; the second is as wide, and most computers have it."""

MATHEMATICS: Final = "mathematics"
"""Label of a text whose `$…$` is set as mathematics; in all others a `$` is one, as users write it in titles."""

LINE_COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, BLACK)
LINE_STYLES: Final[tuple[LineStyleType, ...]] = ("-", "--", "-.", ":", (0, (5, 1, 1, 1)), (0, (8, 2)), (0, (1, 1)))
ENTRANCE_STYLE: Final[LineStyleType] = (0, (1, 2))
LINE_MARKERS = ("o", "s", "^", "D", "v", "P", "X")


def new_figure(width_in: float, height_in: float, title: str, subject: str = "") -> Figure:
    """An empty figure with its title and, in a second line, what it is about, at the top left."""
    figure = Figure(figsize=(width_in, height_in), dpi=DOTS_PER_INCH)
    figure.text(0.12 / width_in, 1.0 - 0.1 / height_in, title, ha="left", va="top", fontsize=12, weight="bold")
    if subject:
        figure.text(0.12 / width_in, 1.0 - 0.33 / height_in, subject, ha="left", va="top", fontsize=10, color=INK)
    return figure


def place(figure: Figure, left: float, right: float, bottom: float, top: float, w: float = 0.2, h: float = 0.2) -> None:
    """Margins of the panels in inches; `w`, `h` their distances as fractions of a panel."""
    width, height = figure.get_size_inches()
    figure.subplots_adjust(left / width, bottom / height, 1.0 - right / width, 1.0 - top / height, w, h)


def dress(axes: Axes, title: str = "", x: str = "", y: str = "") -> None:
    """Title on the left, labels, few small ticks, a light grid behind the data, no frame above and on the right.

    For linear axes; call it before `logarithmic_x` and `logarithmic_y`.
    """
    if title:
        axes.set_title(title, loc="left", fontsize=9.5, y=1.0)  # y given: nobody measures the ticks to place it
    axes.set_xlabel(x, fontsize=9)
    axes.set_ylabel(y, fontsize=9)
    axes.tick_params(labelsize=8, length=3, color=GREY)
    axes.locator_params(nbins=6)
    axes.grid(True, color=PALE_GREY, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(GREY)


def logarithmic_x(axes: Axes, values: Iterable[float]) -> None:
    """See `logarithmic_y`."""
    low, high = room_for(values)
    axes.set(xscale="log", xlim=(low, high))
    mark_plainly(axes.xaxis, low, high)


def logarithmic_y(axes: Axes, values: Iterable[float]) -> None:
    """A logarithmic axis with room for the positive ones of `values`, marked in plain figures."""
    low, high = room_for(values)
    axes.set(yscale="log", ylim=(low, high))
    mark_plainly(axes.yaxis, low, high)


def room_for(values: Iterable[float]) -> tuple[float, float]:
    """Limits around the finite positive values; (0.1, 1) if there is none."""
    known = [value for value in values if math.isfinite(value) and value > 0.0]
    return (0.8 * min(known), 1.25 * max(known)) if known else (0.1, 1.0)


def mark_plainly(axis: Axis, low: float, high: float) -> None:
    """Marks at 0.01, 0.02, 0.05, 0.1 …; where they would crowd, at the decades; where they would be few, more."""
    fine = (1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0, 7.0, 8.0)
    decades = [10.0**decade for decade in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)]
    within = [
        [step * decade for decade in decades for step in steps if low <= step * decade <= high]
        for steps in ((1.0, 2.0, 5.0) if high < 300.0 * low else (1.0,), fine)
    ]
    marks = within[1] if high < 3.0 * low or len(within[0]) < 2 else within[0]
    axis.set_major_locator(FixedLocator(marks))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def mark_zones(axes: Axes, zones_m: Sequence[tuple[float, float]], start_m: float) -> None:
    """The retarders as dark bars along the bottom of a panel over path; `start_m`: where the regulator acts from."""
    axes.broken_barh(
        [(start, end - start) for start, end in zones_m], (0.0, 0.025), transform=axes.get_xaxis_transform(),
        facecolor=INK, zorder=4,
    )  # fmt: skip
    mark_entrance(axes, start_m)


def mark_entrance(axes: Axes, start_m: float) -> None:
    """The entrance as a thin line in a panel over path, where the regulator acts from before it."""
    if start_m < 0.0:
        axes.axvline(0.0, color=INK, linewidth=0.8, linestyle=ENTRANCE_STYLE, zorder=4)


def legend_below(figure: Figure, handles: Sequence[Artist], columns: int, bottom_in: float = 0.08) -> Legend:
    """One legend for the whole figure, in the strip under the panels."""
    return figure.legend(
        handles=list(handles), loc="lower center", ncols=columns, frameon=False, fontsize=8.5,
        bbox_to_anchor=(0.5, bottom_in / figure.get_size_inches()[1]), borderaxespad=0.0,
    )  # fmt: skip


def graded(count: int) -> tuple[str, ...]:
    """`count` colours in an order that is one in grey, too: dark blue over red to yellow, its palest end left out; they
    are none of those of the weight categories."""
    scale = colormaps["plasma"]
    return tuple(to_hex(scale(0.9 * place / max(count - 1, 1))) for place in range(count))


def markers(count: int) -> tuple[str, ...]:
    """`count` markers."""
    return tuple(LINE_MARKERS[place % len(LINE_MARKERS)] for place in range(count))


def named_lines(names: Sequence[str]) -> list[Line2D]:
    """Entries of a legend for lines in this order."""
    looks = zip(names, graded(len(names)), markers(len(names)), strict=True)
    return [Line2D([], [], color=colour, marker=marker, markersize=4, label=name) for name, colour, marker in looks]


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
