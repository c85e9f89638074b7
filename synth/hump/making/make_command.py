"""`hump make`: a hump file and its picture from a short file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from plant_models.hump import Route
from plant_models.library import SourcedValue
from plant_models.library.hump_entry import HumpEntry
from plant_models.library.sourced_value import SET_BY_USER
from synth.frame.command import Asked, Command, Head, Steps, Work
from synth.frame.exhibits import Chapter, Chart, File, Sentence
from synth.frame.settings.numbers import numbers_of
from synth.hump.checking.checked_hump import CheckedHump, checked_hump
from synth.hump.design_runners import roll_runners
from synth.hump.hump_file import parse_hump
from synth.hump.making.hump_toml import hump_toml
from synth.hump.making.make_options import MakeOptions
from synth.hump.making.short_file import read_short_hump
from synth.hump.making.short_hump import ShortHump
from synth.kernels.cache import guarded
from synth.retarder.configuration.plant_fault import in_file
from tuning_tables.canonical import canonical_json

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HUMP_FILE = "hump.toml"


@dataclass(frozen=True)
class MadeHump:
    """A `short` hump, the `text` of its hump file, and what is told of that."""

    short: ShortHump
    text: str
    checked: CheckedHump

    @property
    def head(self) -> Head:
        """What page and summary say."""
        short = self.short
        profile = SourcedValue("profile_from_crest", short.profile_from_crest, "m, permille", None, SET_BY_USER, "")
        return Head(
            title=short.title,
            canonical_json=canonical_json(short.model_dump(exclude={"title", "output"})).decode(),
            parameters=(*numbers_of(short), profile),
            output=short.output,
            warnings=tuple(each.sentence for each in self.checked.warnings),
        )


def resolve(asked: Asked[ShortHump, MakeOptions]) -> MadeHump:
    """The hump file, read again as every command reads it."""
    text = hump_toml(asked.settings, Path(asked.place).name)
    hump = parse_hump(text, "hump", HUMP_FILE)
    with in_file(asked.place):
        return MadeHump(asked.settings, text, checked_hump(hump))


def compute(made: MadeHump, work: Work) -> MadeHump:
    """It is made already, so that it could be refused."""
    work.progress.done(HUMP_FILE)
    return made


def show(made: MadeHump) -> Iterator[Chapter]:
    """File and picture, then what it holds."""
    hump = made.checked.hump
    routes = [route for lead in hump.graph.leads for route in hump.graph.routes(lead).values()]
    route = max(routes, key=lambda each: sum(bend.turn_deg for bend in each.roll_track.bends))
    title = "Plan, and profile of the way with the most turning"
    caption = f"Profile of the way to track {route.track}; energy heads of a good, a mean and a bad runner, not braked."
    yield Chapter(
        "The hump",
        (
            File(HUMP_FILE, made.text.encode(), "The hump file"),
            Chart("plan-and-profile", title, caption, partial(drawn, hump, route)),
        ),
    )
    told = f"'retarder-synth hump simulate' humps trains over {HUMP_FILE}; every line of the file may be changed."
    yield Chapter("What stands where", (*made.checked.exhibits(), Sentence(told, {}, brief=True)))


def drawn(hump: HumpEntry, route: Route) -> Figure:
    """The picture of `hump draw`."""
    from synth.hump.control.pictures.hump_picture import hump_picture

    return hump_picture(hump, route, guarded(roll_runners, route))


COMMAND = Command(
    name="hump make",
    read=read_short_hump,
    options=MakeOptions,
    resolve=resolve,
    head=lambda made: made.head,
    steps=lambda made: Steps(1, "making", "files"),
    compute=compute,
    show=show,
    limits_of_use=("A hump file tells lengths and grades; whether they can be built nobody has looked at.",),
)
