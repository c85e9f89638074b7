"""What a table would have commanded at every logged reading, beside what was commanded: where the drive rests, so
that the regulator may command, and which table of a book a controller regulates each pass with.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from plant_models.stage_regulator import Actuator, stage_locked_actuator
from synth.logs.fitting_passes import FittingPasses
from synth.simulation.closed_loop import SUBSTEP_S
from tuning_tables import ControllerTable
from tuning_tables.active_table import ActiveTable
from tuning_tables.estimator import begin
from tuning_tables.pass_log.pass_log import PassLog
from tuning_tables.rule import decide_many, speed_for
from tuning_tables.table_book import Choice, Status, TableBook


@frozen_arrays
class DriveStates:
    """Of n rows: `resting`: the command before has come to rest, by the model; `stage_before` in force until the row;
    `overpressure_kpa`: mean of max(0, P − P0) since the sample before, 0 at the first."""

    resting: Bools
    stage_before: Ints
    overpressure_kpa: Floats


def drive_states(passes: FittingPasses) -> DriveStates:
    """The drive along the passes. Rows are samples of the regulator; where some are missing, the clock counts on."""
    log, plant = passes.log, passes.plant
    period = plant.sensor.sample_period_s
    substeps = math.ceil(period / SUBSTEP_S)
    actuator = stage_locked_actuator(plant.position, plant.sensor, plant.position.top_stage, substeps)
    n = len(log.time_s)
    found = Columns(np.zeros(n, dtype=np.bool_), np.zeros(n, dtype=np.int64), np.zeros(n))
    for number in range(len(log)):
        fill_in(log, number, actuator, (period, plant.approach.initial_stage), found)
    return DriveStates(*found)


class Columns(NamedTuple):
    """Memory for `DriveStates`, while it is filled."""

    resting: Bools
    stage_before: Ints
    overpressure_kpa: Floats


def fill_in(log: PassLog, number: int, actuator: Actuator, begin: tuple[float, int], found: Columns) -> None:
    """The rows of pass `number`; `begin`: sampling period, and the stage in which the drive rests before."""
    period, stage = begin
    rows = log.rows(number)
    sample = np.rint((log.time_s[rows] - log.time_s[rows.start]) / period).astype(np.int64).tolist()
    parts = actuator.chain_overpressure_kpa.reshape(len(actuator.chain_mode), -1, actuator.substeps).mean(axis=2)
    mode, chain, since = actuator.mode_of(stage), -1, 0
    for row, at, told in zip(range(rows.start, rows.stop), sample, log.stage[rows].tolist(), strict=True):
        played = at - since
        if row > rows.start:
            found.overpressure_kpa[row] = (
                parts[chain, played - 1]
                if chain >= 0 and 0 < played <= actuator.chain_samples[chain]
                else actuator.mode_overpressure_kpa[mode]
            )
        found.stage_before[row] = stage
        found.resting[row] = chain < 0 or played >= actuator.chain_samples[chain]
        if told != stage:
            # A command that did not wait for rest is taken as if it had: the model has no other.
            chain, since, stage = int(actuator.command[mode, told]), at, told
            mode = int(actuator.chain_mode[chain])


NO_TABLE = -1


@frozen_arrays
class LoggedTables:
    """`tables` that passes are regulated with; `of_pass` (m,): number of that of each pass, `NO_TABLE` for none, and
    then `reason` (m of them) says why; '' otherwise."""

    tables: tuple[ActiveTable, ...]
    of_pass: Ints
    reason: tuple[str, ...]


def logged_tables(passes: FittingPasses, tables: Sequence[ControllerTable]) -> LoggedTables:
    """The lines that a book of `tables` chooses for category, axles and target of each pass (`table_book`).

    A single table stands for its own target only. Without a category in the log, that of the class counts.
    """
    log, book = passes.log, TableBook(tuple(tables))
    chosen: dict[tuple[str, int, float], tuple[int, str]] = {}
    found: list[ActiveTable] = []
    of_pass, reasons = np.full(len(log), NO_TABLE, dtype=np.int64), []
    for number in range(len(log)):
        category = log.category[number] or passes.plants[passes.class_of[number]][1].cut.category
        key = (category, int(log.axles[number]), float(log.target_m_s[number]))
        if np.isnan(key[2]):
            reasons.append("no target is logged")
            continue
        if key not in chosen:
            choice = book.choose(*key)
            why = refusal(choice, key, alone=len(tables) == 1)
            if not why and choice.table is not None:
                found.append(choice.table)
            chosen[key] = (NO_TABLE if why else len(found) - 1, why)
        of_pass[number], why = chosen[key]
        reasons.append(why)
    return LoggedTables(tuple(found), of_pass, tuple(reasons))


def refusal(choice: Choice, key: tuple[str, int, float], alone: bool) -> str:
    """Why the choice for (category, axles, target) is not used; '' where it is."""
    category, axles, target = key
    if choice.status is Status.NO_CLASS:
        return f"no table is for {category} on {axles} axles"
    if choice.table is None or (alone and choice.status is not Status.TUNED):
        return f"no table of {category} on {axles} axles is for {target:g} m/s"
    return ""


NOT_ASKED = -1


@frozen_arrays
class RuleAgreement:
    """`wanted` (n,): the stage that the table of the pass commands at each row, `NOT_ASKED` where it is not asked or
    there is no table; `commanded` (n,) as logged; `stage_before` (n,); `first_differing` (m,): the row where each pass
    first differs, −1 where it nowhere does. After that row the logged pass is no longer that of the table."""

    wanted: Ints
    commanded: Ints
    stage_before: Ints
    first_differing: Ints

    @property
    def asked(self) -> Bools:
        """Rows at which the table is asked, (n,)."""
        return np.asarray(self.wanted != NOT_ASKED)

    @property
    def rows(self) -> tuple[int, int]:
        """(same, asked) rows."""
        asked = self.asked
        return int((asked & (self.wanted == self.commanded)).sum()), int(asked.sum())

    @property
    def commands(self) -> tuple[int, int]:
        """(same, all) of the rows at which the log or the table changes the stage."""
        change = self.asked & ((self.wanted != self.stage_before) | (self.commanded != self.stage_before))
        return int((change & (self.wanted == self.commanded)).sum()), int(change.sum())


def rule_agreement(passes: FittingPasses, tables: LoggedTables) -> RuleAgreement:
    """Ask the table of each pass at every row where its regulator does: from the beginning of its approach on, wherever
    the drive rests by the model. A log may begin before."""
    log, states = passes.log, drive_states(passes)
    wanted = np.full(len(log.time_s), NOT_ASKED, dtype=np.int64)
    of_row = np.repeat(tables.of_pass, np.diff(log.first_row))
    for number, table in enumerate(tables.tables):
        rows = np.flatnonzero((of_row == number) & (log.path_m >= begin_m(table)))
        speed = log.speed_m_s[rows] if table.estimator is None else estimated(log, table, states, rows)
        at, before = log.path_m[rows], states.stage_before[rows]
        wanted[rows] = np.where(states.resting[rows], decide_many(table, before, at, speed), NOT_ASKED)
    return RuleAgreement(wanted, log.stage, states.stage_before, first_differing(log, wanted))


def begin_m(table: ActiveTable) -> float:
    """Path from which on the regulator asks `table`, metres; 0 or negative."""
    return 0.0 if table.approach is None else -table.approach.length_m


def estimated(log: PassLog, table: ActiveTable, states: DriveStates, rows: Ints) -> Floats:
    """The estimated speed at `rows`, those of some passes at which their regulator looks at `table`, in their order."""
    found: list[float] = []
    columns = (log.pass_of_row, log.path_m, log.speed_m_s, states.overpressure_kpa)
    number = -1
    for one, *readings in zip(*(column[rows].tolist() for column in columns), strict=True):
        if one != number:
            number, state = one, begin()
        found.append(speed_for(table, state, *readings))
    return np.array(found)


def first_differing(log: PassLog, wanted: Ints) -> Ints:
    """The first row of each pass that differs, (m,), −1 for none."""
    differs = np.flatnonzero((wanted != NOT_ASKED) & (wanted != log.stage))
    passes, first = np.unique(log.pass_of_row[differs], return_index=True)
    found = np.full(len(log), NO_TABLE, dtype=np.int64)
    found[passes] = differs[first]
    return found
