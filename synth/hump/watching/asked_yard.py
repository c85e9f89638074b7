"""What a watch on a yard is asked: the positions with their plants and logs, and the hump that prices drifts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

from plant_models.library import SourcedValue
from synth.frame.command import Asked, Head
from synth.frame.faults import InputError
from synth.frame.settings.numbers import numbers_of
from synth.hump.configuration.trial_file import read_trial_file
from synth.hump.options import YardWatchOptions
from synth.hump.trial.asked_trial import AskedTrial, files_read
from synth.hump.trial.position_choice import retarders_at
from synth.hump.trial.resolved_trial import ResolvedTrial, resolve_trial
from synth.hump.watching.settings import WatchedPositionSettings, YardWatchSettings
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from tuning_tables.errors import InvalidLog
from tuning_tables.json_text import canonical_json
from tuning_tables.pass_log.log_mapping import LogMapping, read_mapping

FEWEST_SHIFTS: Final = 10
"""Of trains: the interval of a cost needs some that are independent."""


@dataclass(frozen=True)
class AskedPosition:
    """A position `name` with the plant of `config`, which messages call `place`, and its `logs`, to be read by
    `mapping`; `reads`: all files and folders of it.

    `hump_position`: place of the position that its `retarder` is of, from 0 at the crest; None without a retarder.
    """

    name: str
    config: ResolvedConfig
    place: str
    logs: Path
    mapping: LogMapping | None
    reads: tuple[Path, ...]
    retarder: int | None
    hump_position: int | None
    is_repaired: bool


@dataclass(frozen=True)
class AskedYard:
    """All positions, and the trial that tells what a drift costs, if there is one."""

    settings: YardWatchSettings
    positions: tuple[AskedPosition, ...]
    trial: AskedTrial | None

    @property
    def head(self) -> Head:
        """What page and summary say."""
        told = {
            "format": "yard-watch",
            "settings": self.settings.model_dump(mode="json", exclude={"title", "output"}),
            "positions": [[each.name, each.config.sha256] for each in self.positions],
            "trial": None if self.trial is None else self.trial.config.trains_sha256,
        }
        return Head(
            title=self.settings.title or "Watch on a yard",
            canonical_json=canonical_json(told).decode("utf-8"),
            parameters=tuple(self._parameters()),
            output=self.settings.output,
            warnings=tuple(dict.fromkeys(warning for each in self.positions for warning in each.config.warnings)),
            reads=tuple(self._reads()),
        )

    def _parameters(self) -> Iterator[SourcedValue]:
        yield from numbers_of(self.settings)
        if self.trial is not None:
            yield from self.trial.config.parameters

    def _reads(self) -> Iterator[Path]:
        for each in self.positions:
            yield from each.reads
        yield from () if self.trial is None else files_read(self.trial.file, self.trial.config)


def asked_yard(asked: Asked[YardWatchSettings, YardWatchOptions]) -> AskedYard:
    """The yard; `InputError` with a sentence for what does not fit, but logs, which may be missing for a night."""
    settings = asked.settings
    names = [each.name for each in settings.position]
    for name in asked.options.repaired:
        if name not in names:
            raise InputError(f"--repaired is {name!r}; {asked.place} has no such position: {', '.join(names[:20])}")
    trial = None if settings.trial is None else priced_on(asked)
    places = {} if trial is None else hump_positions(trial.config)
    config_at, mapping_at = cache(load_config), cache(mapping_in)
    found = []
    for each in settings.position:
        config, mapping = (
            None if name is None else asked.folder / name
            for name in (each.config or settings.config, each.mapping or settings.mapping)
        )
        logs = asked.folder / (each.logs or settings.logs.replace("{name}", each.name))
        found.append(
            AskedPosition(
                name=each.name,
                config=config_at(config),
                place="the built-in configuration" if config is None else str(config),
                logs=logs,
                mapping=mapping_at(mapping),
                reads=tuple(filter(None, (logs, config, mapping))),
                retarder=each.retarder,
                hump_position=hump_position(each, places, trial, asked.place),
                is_repaired=each.name in asked.options.repaired,
            )
        )
    return AskedYard(settings, tuple(found), trial)


def mapping_in(path: Path | None) -> LogMapping | None:
    """The mapping in a file; `InputError`."""
    try:
        return None if path is None else read_mapping(path)
    except InvalidLog as fault:
        raise InputError(str(fault)) from None


def priced_on(asked: Asked[YardWatchSettings, YardWatchOptions]) -> AskedTrial:
    """The trial, with the trains that drifts are priced on."""
    assert asked.settings.trial is not None
    cost = asked.settings.cost
    file = read_trial_file(asked.folder / asked.settings.trial).with_trains(cost.number, cost.seed, None)
    config = resolve_trial(file)
    of_shift = config.settings.tracks.shift_trains
    if cost.number < FEWEST_SHIFTS * of_shift:
        raise InputError(
            f"{asked.place}: cost.number is {cost.number}, but a shift of {file.place} has {of_shift} trains; give "
            f"{FEWEST_SHIFTS * of_shift} or more"
        )
    return AskedTrial(file, config)


def hump_positions(config: ResolvedTrial) -> dict[int, int]:
    """Of each retarder the position that it is of, from 0 at the crest."""
    places = enumerate(retarders_at(config.routes.routes))
    return {each.number: place for place, held in places for each in held}


def hump_position(
    each: WatchedPositionSettings, places: dict[int, int], trial: AskedTrial | None, place: str
) -> int | None:
    """The position of its retarder; `InputError` where the hump has no such retarder."""
    if each.retarder is None or trial is None:
        return None
    if each.retarder not in places:
        raise InputError(
            f"{place}: position {each.name}: retarder is {each.retarder}; on the hump of the trial stand "
            f"{', '.join(map(str, sorted(places)))}"
        )
    return places[each.retarder]
