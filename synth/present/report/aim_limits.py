"""What the numbers of an aim's report do not say."""

from __future__ import annotations

from synth.frame.page.markup import Markup, element
from synth.yard.aim.aim_book import AimBook


def aim_limits(book: AimBook) -> Markup:
    """The list."""
    return element("ul", *(element("li", sentence) for sentence in sentences(book)))


def sentences(book: AimBook) -> list[str]:
    """One limit each."""
    above = max(made.speeds.above_m_s for made in book.tables)
    below = max(made.speeds.below_m_s for made in book.tables)
    return [
        *book.config.notes,
        "All figures are those of a model with the parameters listed here, not of a yard. Assumed parameters are "
        "guesses; replace them by those of your yard, then aim again.",
        "Intervals (95 %) cover the chance of the simulated cuts only, neither the parameters nor the model.",
        "Resistance, wind and bends are drawn once for each cut and stay for its whole way; the wind is one along the "
        "track, and a gust or a lee is not modelled.",
        f"Between two nodes a controller takes a straight line. Midway it was found to be at most {above:.3f} m/s "
        f"above and {below:.3f} m/s below what is right there.",
        "Standing cars are taken not to move, and the free distance to be known. A cut that stops short shortens the "
        "free distance of all that follow it: gaps are told, their consequences are not.",
        "The tool is not certified and claims no safety integrity. Before a table commands a position, check it with "
        "an independent program against the hashes below, and on the track.",
    ]
