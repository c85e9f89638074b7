"""All pictures of humped trains: what is drawn, and what is said under it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from plant_models.library.hump_entry import HumpEntry
from synth.frame.picture.figure_file import draw
from synth.frame.picture.picture import Picture
from synth.present.plots.humping.catch_ups import catch_ups
from synth.present.plots.humping.couplings import couplings
from synth.present.plots.humping.hump_speed_program import PushedTrain, hump_speed_program, pushed_train
from synth.present.plots.humping.speed_path import speed_path
from synth.present.plots.humping.time_path import time_path
from synth.yard.humping.hump_routes import HumpRoutes
from synth.yard.humping.outcomes import TrainOutcomes
from synth.yard.humping.train_trace import TrainTrace


def outcome_pictures(hump: HumpEntry, routes: HumpRoutes, found: TrainOutcomes) -> Iterator[Picture]:
    """What many trains came to; `routes` are those of `hump` on which they were humped."""
    cuts = int(found.cuts.sum())
    yield picture(
        catch_ups(hump, by_element(routes, found.misrouted), cuts, "misroutes"),
        "hump-misroutes",
        "Catch-ups",
        "Misroutes by switch",
        "Cuts that came to a switch before it could be thrown behind the cut ahead of them. They follow that cut, and "
        "each counts once, at the first such switch.",
    )
    yield picture(
        catch_ups(hump, by_element(routes, found.contact), cuts, "contacts"),
        "hump-contacts",
        "Catch-ups",
        "Contacts by element",
        "Cuts that ran into the cut ahead of them on an element that both use. Misrouted cuts may be among them.",
    )
    yield picture(
        couplings(found),
        "hump-couplings",
        "Couplings and gaps",
        "Coupling speeds and gaps",
        "Cuts that reached a track undisturbed: the speed with which they met the standing cars, and what those that "
        "stopped before left free. Shares are of all these cuts.",
    )


def by_element(routes: HumpRoutes, counts: NDArray[np.int64]) -> dict[int, int]:
    """`counts` (trains, numbers) of all trains, by the number of the element."""
    return {number: int(count) for number, count in zip(routes.numbers, counts.sum(axis=0), strict=True)}


def train_pictures(trace: TrainTrace, categories: Sequence[str]) -> Iterator[Picture]:
    """What one train did; `categories`: names of the weight categories."""
    yield picture(
        time_path(trace),
        "hump-time-path",
        "One train",
        f"Time–path diagram of train {trace.number + 1}",
        "Each band is a cut from its tail to its head; the figures at the crest are its number and its track. Boxes: "
        "an element is occupied, from the first axle in to the last axle out. Elements of different routes at the same "
        "distance from the crest lie on one another.",
    )
    yield picture(
        speed_path(trace, categories),
        "hump-speed-path",
        "One train",
        f"Speed over path of train {trace.number + 1}",
        "Speed of each cut over the place of its head. Within a pass v² is drawn as falling evenly, whatever the "
        "position does. Vertical strokes: from the commanded exit speed to the actual one.",
    )
    yield program_picture(pushed_train(trace))


def program_picture(program: PushedTrain) -> Picture:
    """The program of hump speeds of a train."""
    return picture(
        hump_speed_program(program),
        "hump-speed-program",
        "Hump speed",
        f"Hump speed program of train {program.number + 1}",
        "Speed at which the train is pushed when the middle of each cut is at the crest; in between it changes evenly.",
    )


def picture(figure: Figure, name: str, section: str, title: str, caption: str) -> Picture:
    """Draw `figure` as a picture."""
    return Picture(name, section, title, caption, draw(figure))
