"""The command `aim`, for the track that the configuration tells, or for one of a hump file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from plant_models.hump import Route, Switch
from plant_models.library.hump_entry import HumpEntry
from synth.aim.aiming import LIMITS_OF_USE, compute, head, limits, resolved, show, steps
from synth.aim.configuration.aim_file import AimFile, parse_aim_file
from synth.aim.resolved_aim import ResolvedAim
from synth.frame.command import Asked, Command
from synth.frame.input_error import InputError
from synth.frame.printed_numbers import ranges
from synth.hump.aiming.hump_track import hump_track
from synth.hump.aiming.options import AimOptions
from synth.hump.hump_file import load_hump
from synth.hump.route_to import route_to
from synth.hump.trains.aim_choice import last_retarder
from synth.hump.trains.aim_design import positions_m

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
