"""What a table would have commanded at every logged reading, beside what was commanded."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.logs.fitting_passes import FittingPasses
from synth.logs.replay.drive_states import DriveStates, drive_states
from synth.logs.replay.logged_tables import NO_TABLE, LoggedTables
from tuning_tables.active_table import ActiveTable
from tuning_tables.estimator import begin
from tuning_tables.pass_log.pass_log import PassLog
from tuning_tables.rule import decide_many, speed_for

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
