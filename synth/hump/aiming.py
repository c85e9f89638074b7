"""The command `aim`, for the track that the configuration tells, or for one of a hump: its falls and bends, the last
position, and the stretch ahead of it, as aim tables need them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from plant_models.hump import Route, Switch
from plant_models.library import SourcedValue, TrackEntry, load_track
from plant_models.library.hump_entry import HumpEntry
from plant_models.library.sourced_value import JUDGEMENT, SourcedTable, Value
from plant_models.library.track_entry import BENDS, END, GRADES, POSITION, PROFILE, STRETCH, entry_of
from synth.aim.aiming import LIMITS_OF_USE, compute, head, limits, resolved, show, steps
from synth.aim.configuration.aim_file import AimFile, parse_aim_file
from synth.aim.configuration.settings import DEFAULT_TRACK
from synth.aim.resolved_aim import ResolvedAim
from synth.frame.command import Asked, Command
from synth.frame.faults import InputError
from synth.frame.printed_numbers import ranges
from synth.hump.hump_file import load_hump, route_to
from synth.hump.options import AimOptions
from synth.hump.planning.aim_design import positions_m
from synth.hump.trial.table_aim import last_retarder

NAME: Final = "track of a hump"

CAR_M: Final = 15.0
"""Behind the position before it a first axle is measured when the last one of a single car has left that."""

AHEAD_M: Final = 6.0
"""So far ahead of the last position it is measured again."""

ON_A_HUMP: Final = f"{JUDGEMENT}: {CAR_M:g} m behind the position before it, where one car has left that"
BEFORE_IT: Final = f"{JUDGEMENT}: {AHEAD_M:g} m before the position"


def hump_track(hump: HumpEntry, route: Route) -> TrackEntry:
    """The track of `route`, which has a position. Numbers are assumed where any number of the hump is; how fast cuts
    come on the stretch no hump file tells, so that is as on the track of the library."""
    told = f"hump {hump.name}, track {route.track}"
    confidence = "L" if any(value.assumed for value in hump.provenance) else ""
    units = {**PROFILE, **BENDS, **POSITION, **STRETCH}
    of_hump = (SourcedValue(key, value, units[key].unit, None, told, confidence) for key, value in values_of(route))
    values = (*of_hump, *stretch_values(route))
    title = f"track {route.track} of: {hump.title}"
    return entry_of(NAME, title, hump.notes, last_retarder(route).position, SourcedTable(values))


def values_of(route: Route) -> Iterator[tuple[str, Value]]:
    """What the hump file tells, by the keys of a track."""
    track, (entrance, leave) = route.roll_track, positions_m(route)[-1]
    yield GRADES, tuple(zip(track.profile.starts_m, track.profile.grades_permille, strict=True))
    yield END, track.end_m
    if track.bends:
        zones, switches, turns = BENDS
        yield zones, tuple((bend.from_m, bend.to_m) for bend in track.bends)
        yield switches, tuple(float(bend.switches) for bend in track.bends)
        yield turns, tuple(bend.turn_deg for bend in track.bends)
    begins, ends = POSITION
    yield begins, entrance
    yield ends, leave


def stretch_values(route: Route) -> Iterator[SourcedValue]:
    """Where cuts are measured, and how fast they come."""
    places = positions_m(route)
    before = places[-2][1] if len(places) > 1 else 0.0
    begins, ends, *_ = STRETCH
    yield SourcedValue(begins, before + CAR_M, "m", None, ON_A_HUMP, "L")
    yield SourcedValue(ends, places[-1][0] - AHEAD_M, "m", None, BEFORE_IT, "L")
    of_library = {value.key: value for value in load_track(DEFAULT_TRACK).provenance}
    yield from (value for key, value in of_library.items() if key.startswith("stretch.speed_"))


ACCURACY: Final = "aim.exit_std_m_s"


def resolve(asked: Asked[AimFile, AimOptions]) -> ResolvedAim:
    """As any aim; with `--hump` the track is that of the hump file, and so is how exactly its last position works,
    unless the configuration says that."""
    options, file = asked.options, asked.settings
    simulation = options.passes, options.seed
    if options.hump is None:
        if options.track is not None:
            raise InputError("--track is that of a hump; name the hump by --hump FILE, or leave --track out")
        return resolved(file.with_simulation(*simulation))

    require_no_track(file, f"--hump {options.hump}")
    hump = load_hump(options.hump)
    route = aimed_route(hump, options)
    file, told = with_accuracy(file.with_simulation(*simulation), route)
    config = resolved(file, hump_track(hump, route))
    source = f"hump {hump.name}: the last position of track {route.track}"
    parameters = tuple(replace(v, source=source) if told and v.key == ACCURACY else v for v in config.parameters)
    return replace(config, parameters=parameters, warnings=(*config.warnings, *switch_warnings(route)))


def require_no_track(file: AimFile, option: str) -> None:
    """`InputError` where the configuration tells of a track, too."""
    said = [name for name in ("track", "position") if getattr(file.settings, name).model_fields_set]
    if said:
        raise InputError(
            f"{file.place} has [{'] and ['.join(said)}], and {option} tells the track and its position, too: leave out "
            "one of the two"
        )


def aimed_route(hump: HumpEntry, options: AimOptions) -> Route:
    """The way to the track that is asked for; `InputError` where none is, or nothing brakes on it."""
    if options.track is None:
        raise InputError(f"--track is missing; the hump {options.hump} has the tracks {ranges(hump.graph.tracks)}")
    route = route_to(hump.graph, options.track)
    if not positions_m(route):
        raise InputError(f"--track is {options.track}; on the way to it there is no position that could aim")
    return route


def with_accuracy(file: AimFile, route: Route) -> tuple[AimFile, bool]:
    """`file` with the accuracy of the last position of `route`, unless the file says how exactly it works, or the hump
    file does not; whether it was taken from there."""
    aim, std = file.settings.aim, last_retarder(route).exit_std_m_s
    if std is None or aim.tables is not None or "exit_std_m_s" in aim.model_fields_set:
        return file, False
    settings = file.settings.model_copy(update={"aim": aim.model_copy(update={"exit_std_m_s": std})})
    return replace(file, settings=settings), True


def switch_warnings(route: Route) -> Iterator[str]:
    """A sentence where switches are behind the position that aims."""
    behind = [e.number for e in route.elements if isinstance(e.vertex, Switch) and e.at_m > route.yard_from_m]
    if behind:
        yield (
            f"switches {ranges(behind)} are behind the last position on the way to track {route.track}: cuts that are "
            "aimed leave it slowly and block them"
        )


COMMAND = Command(
    name="aim",
    read=parse_aim_file,
    options=AimOptions,
    resolve=resolve,
    head=head,
    steps=steps,
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
