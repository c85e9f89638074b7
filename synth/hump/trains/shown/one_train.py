"""The train that is shown of a trial: drawn, played on the plan, logged by the hump control; and its program."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Final

from synth.frame.exhibits import Chart, Exhibit, File, Sentence
from synth.hump.control.events import to_log_csv
from synth.hump.trains.hump_page.hump_page import PLAYER, PlayedRun, hump_page
from synth.hump.trains.humped_trial import HumpedTrial
from synth.hump.trains.traced_train import OneTrain, chosen_trains, some_trains
from synth.hump.trains.train_trace import TrainTrace

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LOG: Final = "events.csv"

TIME_PATH: Final = (
    "Each band is a cut from its tail to its head; the figures at the crest are its number and its track. Boxes: an "
    "element is occupied, from the first axle in to the last axle out. Elements of different routes at the same "
    "distance from the crest lie on one another."
)
SPEED_PATH: Final = (
    "Speed of each cut over the place of its head. Within a pass v² is drawn as falling evenly, whatever the position "
    "does. Vertical strokes: from the commanded exit speed to the actual one."
)


def one_train_exhibits(result: HumpedTrial, shown: OneTrain, traced: Callable[[], TrainTrace]) -> Iterator[Exhibit]:
    """What happened to it: the page that plays it and others, its log, and pictures; `traced`: its trace, made once."""
    members = result.config.categories.members
    yield from standing_cuts(result, shown)
    if result.config.settings.output.report:
        chosen = chosen_trains(result.found)
        others = some_trains(result.trial, [each.number for each in chosen[1:]])
        traces = (traced(), *(each.traced() for each in others))
        titles = [each.title for each in chosen]
        played = PlayedRun("", result.config.hump, traces, members, result.config.settings.couplings)
        page = hump_page("Trains over the hump", (played,), titles)
        yield File(PLAYER, page.encode(), f"Play on the plan: {'; '.join(titles)}")
    control = shown.controlled()
    otherwise = len(control.disagreements)
    yield File(LOG, to_log_csv(control.events).encode(), "Event log of the hump control for this train")
    yield Sentence(
        f"The hump control was run on the times of this train: its points lay otherwise than cuts went {otherwise} "
        "times.",
        {"points_lay_otherwise": otherwise},
    )

    def times() -> Figure:
        from synth.hump.trains.pictures.time_path import time_path

        return time_path(traced())

    def speeds() -> Figure:
        from synth.hump.trains.pictures.train_speeds import speed_path

        return speed_path(traced(), members)

    number = shown.number + 1
    yield Chart("hump-time-path", f"Time–path diagram of train {number}", TIME_PATH, times)
    yield Chart("hump-speed-path", f"Speed over path of train {number}", SPEED_PATH, speeds)


def standing_cuts(result: HumpedTrial, shown: OneTrain) -> Iterator[Sentence]:
    """A warning of cuts that stand behind the crest, where there are any."""
    standing = shown.standing()
    if standing:
        first, fall_m = result.trial.routes.first_element
        yield Sentence(
            f"Warning: {standing} of the {len(shown.trains)} cuts of train {shown.number + 1} stand before "
            f"element {first}; the track falls by {fall_m:.2f} m up to there.",
            {"standing_cuts": standing},
            brief=True,
        )
