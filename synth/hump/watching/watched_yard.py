"""What a run of the watch finds in a yard: each position with its new passes, and the drifts in order of their cost."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Final

import numpy as np

from synth.frame.faults import InputError
from synth.frame.machine import available
from synth.frame.results_directory import ResultsDirectory
from synth.frame.terminal.progress import Progress
from synth.hump.trial.made_trial import brake_of, made_trial
from synth.hump.trial.resolved_trial import ResolvedTrial
from synth.hump.trial.trial import HumpTrial
from synth.hump.watching.asked_yard import AskedPosition, AskedYard
from synth.hump.watching.drift_cost import Difference, DriftCost, Retarder, drift_cost
from synth.logs.drift.kept_watch import KeptWatch, WatchedNight, from_npz, to_npz, watched_night
from synth.logs.drift.watch import Drift, Watch
from tuning_tables.errors import InvalidLog
from tuning_tables.pass_log.log_files import read_logs
from tuning_tables.pass_log.pass_log import PassLog

FOLDER: Final = "state"

NO_TRIAL: Final = "the file of the yard names no hump trial"
NO_RETARDER: Final = "the position has no number in the hump"
NO_PASS: Final = "no position has a pass that was not stopped by hand; give logs of some"
FEW_PASSES: Final = "too few exits with a target are known on both sides of its beginning"


@dataclass(frozen=True, eq=False)
class WatchedPosition:
    """A position and its `night`; `not_read`: why some or all passes of now were not read."""

    asked: AskedPosition
    night: WatchedNight
    not_read: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Repair:
    """A drift, with what it costs; `weight` of all that, in cars an hour; without: why it is not told."""

    position: WatchedPosition
    watch: Watch
    drift: Drift
    cost: DriftCost | None
    weight: Difference | None
    why: str

    @property
    def order(self) -> tuple[bool, float]:
        """The most costly first; those of which that is not told behind, by how much worse exits have become."""
        if self.weight is not None:
            return False, -self.weight.value
        worse = self.drift.after.rms_m_s - self.drift.before.rms_m_s
        return True, -worse if np.isfinite(worse) else np.inf


@dataclass(frozen=True, eq=False)
class WatchedYard:
    """All positions in the order of the file, and `repairs`, the first one first."""

    asked: AskedYard
    positions: tuple[WatchedPosition, ...]
    repairs: tuple[Repair, ...]

    @property
    def new(self) -> int:
        """New passes of all positions."""
        return sum(each.night.new for each in self.positions)

    @cached_property
    def silent(self) -> tuple[WatchedPosition, ...]:
        """Positions of which nothing new came, though it did of others: their watch stands still."""
        return tuple(each for each in self.positions if each.night.new == 0 and self.new > 0)

    def is_ahead(self, place: int) -> bool | None:
        """Whether a repair is ahead of the next one for sure; None for the last, and where costs are not told."""
        weights = [each.weight for each in self.repairs[place : place + 2]]
        first, second = (*weights, None, None)[:2]
        return None if first is None or second is None else first.above(second)


def watched_yard(asked: AskedYard, directory: ResultsDirectory, progress: Progress) -> WatchedYard:
    """Watch all positions; each is stored as soon as it has been, so that a run that is killed counts nothing twice.

    `InputError` where no position has any passes, neither now nor from earlier runs; `DamagedTable`.
    """
    kept = [kept_of(each, directory) for each in asked.positions]
    positions = []
    with ThreadPoolExecutor(available()) as pool:
        watch = partial(watched_position, asked.settings.run_length)
        for each in pool.map(watch, asked.positions, kept):
            directory.store(state_file(each.asked), to_npz(each.night.kept, each.asked.config.sha256))
            positions.append(each)
            progress.done(f"{each.asked.name}: {each.night.new} new passes")
    directory.retain(*directory.names_below(FOLDER))  # of positions that the file left out this time
    if not any(each.night.kept.watched for each in positions):
        raise InputError(*([sentence for each in positions for sentence in each.not_read[:1]] or [NO_PASS]))
    repairs = sorted(repairs_in(asked, positions, progress), key=lambda each: each.order)
    return WatchedYard(asked, tuple(positions), tuple(repairs))


def state_file(asked: AskedPosition) -> str:
    """Where a position is kept from run to run."""
    return f"{FOLDER}/{asked.name}.npz"


def kept_of(asked: AskedPosition, directory: ResultsDirectory) -> KeptWatch:
    """What earlier runs have kept of a position."""
    path = directory.path / state_file(asked)
    kept = from_npz(path.read_bytes(), str(path), asked.config.sha256) if path.is_file() else KeptWatch()
    return kept.in_run(directory.run, asked.is_repaired)


def watched_position(run_length: float, asked: AskedPosition, kept: KeptWatch) -> WatchedPosition:
    """A position with the passes that are new."""
    log, not_read = passes_of(asked)
    try:
        night = watched_night(kept, log, asked.config, asked.place, run_length)
    except InputError as fault:  # cuts that no class of the configuration fits
        not_read = (*not_read, *fault.sentences)
        night = watched_night(kept, None, asked.config, asked.place, run_length)
    return WatchedPosition(asked, night, not_read)


def passes_of(asked: AskedPosition) -> tuple[PassLog | None, tuple[str, ...]]:
    """The sound passes in the logs of a position, and a sentence for each file and pass that is left out."""
    if not asked.logs.exists():
        return None, (f"{asked.logs}: there is no such file or folder",)
    try:
        loaded = read_logs([asked.logs], asked.mapping, asked.config.retarder.position.top_stage)
    except InvalidLog as fault:
        return None, (str(fault),)
    return loaded.log, (*(each.sentence for each in loaded.refused), *(each.sentence for each in loaded.faults))


def repairs_in(asked: AskedYard, positions: Sequence[WatchedPosition], progress: Progress) -> Iterator[Repair]:
    """The drifts of all positions, each priced where that can be done."""
    cost = asked.settings.cost
    pricing = None if asked.trial is None else Pricing(asked.trial.config)
    for each, watch in ((each, each.night.found) for each in positions):
        if watch is None or watch.drift is None:
            continue
        begin = watch.drift.diagnosis.first.begin
        retarder, why = retarder_of(pricing, each.asked)
        found = None
        if retarder is not None:
            found = drift_cost(retarder, watch.errors_m_s[:begin], watch.errors_m_s[begin:], cost.number)
            why = FEW_PASSES if found is None else ""
            progress.note(f"{each.asked.name}: drift priced on {cost.number} trains")
        weight = None if found is None else found.weight_per_hour(cost)
        yield Repair(each, watch, watch.drift, found, weight, why)


@dataclass(frozen=True)
class Pricing:
    """The trial that drifts are priced on, made once, and only where something has drifted."""

    config: ResolvedTrial

    @cached_property
    def trial(self) -> HumpTrial:
        """The trial."""
        return made_trial(self.config)

    def retarder(self, number: int, position: int) -> Retarder:
        """One of its retarders, which is of this position from 0 at the crest."""
        return Retarder(self.trial, number, position, brake_of(self.config.positions[position], self.config))


def retarder_of(pricing: Pricing | None, position: AskedPosition) -> tuple[Retarder | None, str]:
    """The retarder in the hump of the trial, or why there is none."""
    if pricing is None:
        return None, NO_TRIAL
    if position.retarder is None or position.hump_position is None:
        return None, NO_RETARDER
    return pricing.retarder(position.retarder, position.hump_position), ""
