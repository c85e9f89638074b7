"""`hump make`: the text of the hump file that a short file describes, and its picture."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

from plant_models.hump import Route
from plant_models.library import SourcedValue
from plant_models.library.hump_elements import zones_of
from plant_models.library.hump_entry import FORMAT, VERSION, HumpEntry
from plant_models.library.sourced_value import SET_BY_USER
from synth.frame.command import Asked, Command, Head, Steps, Work
from synth.frame.exhibits import Chapter, Chart, File, Sentence
from synth.frame.settings.numbers import numbers_of
from synth.frame.settings.section import Section, setting_source
from synth.frame.settings.template import value_text
from synth.hump.checked_hump import CheckedHump, checked_hump
from synth.hump.design_runners import roll_runners
from synth.hump.hump_file import parse_hump
from synth.hump.making.hump_plan import DIGITS, HumpPlan, Planned, PlannedEdge
from synth.hump.making.short_file import end_m, read_short_hump
from synth.hump.making.short_hump import ShortHump, ShortPosition
from synth.hump.options import MakeOptions
from synth.kernels.cache import guarded
from synth.retarder.configuration.plant_fault import in_file
from tuning_tables.json_text import canonical_json

if TYPE_CHECKING:
    from matplotlib.figure import Figure

KINDS: Final = ("signal", "switch", "retarder", "section")
TURNOUT: Final = {
    "entry_joint_m": "section_ahead_m",
    "exit_joint_m": "section_behind_m",
    "throw_s": "throw_s",
    "relay_s": "relay_s",
}
"""Keys of a switch in a hump file, and in a short one."""


def hump_toml(short: ShortHump, name: str) -> str:
    """The file; `name`: what it calls the short file."""
    return "\n".join((*head_lines(short, name), *type_lines(short), *hump_lines(HumpPlan(short)))) + "\n"


def head_lines(short: ShortHump, name: str) -> Iterator[str]:
    """What the file is."""
    yield f"# Made by 'retarder-synth hump make' from {name}; docs/reference/hump-file.md tells every key."
    yield f'format = "{FORMAT}"'
    yield f"version = {VERSION}"
    yield f"title = {value_text(short.title)}"
    yield f"source = {value_text(f'the short hump file {name}')}"


def type_lines(short: ShortHump) -> Iterator[str]:
    """The switches, the retarders of each position, and the tracks."""
    if short.switches_m:
        branch = f"{{ turn_deg = {told(short, 'turn_deg')}, fouling_m = {told(short, 'fouling_m')} }}"
        yield from ("", "[type.turnout]")
        yield from (f"{key} = {told(short, of_short)}" for key, of_short in TURNOUT.items())
        yield from (f"left = {branch}", f"right = {branch}")
    plan = HumpPlan(short)
    for number, place in enumerate(plan.order, start=1):
        yield from ("", f"[type.position-{number}]", *position_lines(short.position[place]))
    yield from ("", "[type.track]", f"next = {{ length_m = {metres(short.track_length_m)} }}", "")


def position_lines(position: ShortPosition) -> Iterator[str]:
    """The retarders of a position."""
    length, zones = end_m(position) - position.from_m, zones_of(position.type)
    yield f"position = {value_text(position.type)}"
    if abs(length - zones[-1][1]) > 10.0**-DIGITS:
        yield f"zones_m = [[0, {metres(length)}]]"
    yield f"entry_joint_m = {told(position, 'margin_m')}"
    yield f"exit_joint_m = {metres(length + position.margin_m)}"
    yield f"exit_std_m_s = {told(position, 'exit_std_m_s')}"


def told(section: Section, key: str) -> str:
    """The number under `key`; where it is that of the tool, with its source."""
    field, number = type(section).model_fields[key], getattr(section, key)
    value = metres(number)
    return f"{{ value = {value}, source = {value_text(setting_source(field))} }}" if number == field.default else value


def metres(value: float) -> str:
    """A number without a point that it does not need."""
    rounded = round(float(value), DIGITS)
    return str(int(rounded)) if rounded == int(rounded) else repr(rounded)


def hump_lines(plan: HumpPlan) -> Iterator[str]:
    """The profile and the elements."""
    profile = ", ".join(f"[{metres(start)}, {metres(grade)}]" for start, grade in plan.short.profile_from_crest)
    yield from ("[hump]", "leads = [201]", f"profile_from_crest = [{profile}]")
    elements = sorted(plan.elements(), key=lambda element: element.number)
    for kind in KINDS:
        rows = [row_of(each) for each in elements if each.kind == kind]
        if rows:
            yield from (f"{kind} = [", *(f"    {row}," for row in rows), "]")


def row_of(element: Planned) -> str:
    """A row of the file."""
    named = f"number = {element.number}"
    edges = [edge_of(edge) for edge in element.edges]
    match element.kind:
        case "signal":
            return f"{{ {named}, next = {edges[0]} }}"
        case "switch":
            return f'{{ {named}, type = "turnout", left = {edges[0]}, right = {edges[1]} }}'
        case "retarder":
            return f'{{ {named}, type = "position-{element.of}", next = {edges[0]} }}'
    return f'{{ {named}, type = "track", track = {element.of} }}'


def edge_of(edge: PlannedEdge) -> str:
    """The table of an edge."""
    turn = edge.turn_back_deg
    ends = f"{metres(edge.curve_m[0])}, {metres(edge.curve_m[1])}, {metres(turn)}"
    curve = f", curves = [[{ends}]]" if turn else ""
    return f"{{ to = {edge.to}, length_m = {metres(edge.length_m)}{curve} }}"


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
    from synth.hump.hump_picture import hump_picture

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
