"""What the numbers of a report do not say."""

from __future__ import annotations

from synth.frame.page.markup import Markup, element
from synth.frame.printed_numbers import percent
from synth.present.report.book_report import BookReport


def limits_of_use(book: BookReport) -> Markup:
    """The list."""
    return element("ul", *(element("li", sentence) for sentence in sentences(book)))


def sentences(book: BookReport) -> list[str]:
    """One limit each."""
    return [
        "All errors are those of a model with the parameters listed here, not of a retarder. Assumed parameters are "
        "guesses; calibrate them, then tune again.",
        "Intervals (95 %) cover the chance of the simulated passes only, neither the parameters nor the model.",
        rare_events(book),
        "A table holds for its cut class, target speed, path and speed range, for the entry speeds named in the "
        "parameters and for a regulator that gives no new command until the transient of the last one has ended.",
        *interlock(book),
        "Predictions come from a grid; they carry its error beside that of the model.",
        "An infeasible case has a table too. It does what brake power allows; it does not meet the limit.",
        "The tool is not certified and claims no safety integrity. Before a table drives a retarder, check it with an "
        "independent program against the hashes below, and on the track.",
    ]


def interlock(book: BookReport) -> list[str]:
    """What tables that act before the entrance take for granted."""
    farthest = max((-case.plant.start_m for case in book.cases), default=0.0)
    if farthest == 0.0:
        return []
    return [
        f"The regulator acts from {farthest:g} m before the entrance. The cut ahead must have left the position by "
        "then: this interlock, and a sensor that sees the cut there, are the yard's."
    ]


def rare_events(book: BookReport) -> str:
    """What none in n passes means, in this book's numbers."""
    found = [case.comparison.table.statistics for case in book.cases]
    fewest = min((each.passes for each in found), default=0)
    without = [each.overspeed_ci95[1] for each in found if each.overspeed == 0.0]
    if not without:
        return f"Rare events are counted in {fewest} or more passes a case: see the interval beside each probability."
    return (
        f"No over-speed in {fewest} passes does not mean none ever: it shows a probability below "
        f"{percent(max(without))} %, no more."
    )
