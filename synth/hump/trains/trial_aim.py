"""What positions aim with: exported aim tables where some are named, else speeds that are chosen for the trial."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Ints
from synth.aim.knowledge import ByCategory, Requirement
from synth.aim.position_models import NormalPosition
from synth.hump.trains.aim_design import AimDesign, MeasuredAhead, hump_aim
from synth.hump.trains.hump_aim import HumpAim, joined_aims, no_aim
from synth.hump.trains.position_choice import PositionChoice
from synth.hump.trains.resolved_trial import ResolvedTrial
from synth.hump.trains.table_aim import table_aim
from synth.hump.trains.trial_aim_range import aim_range_m_s
from synth.retarder.forms.tables_at import tables_at


def trial_aim(config: ResolvedTrial, threads: int) -> HumpAim:
    """The exit speeds of the position that aims on each route; `threads` choose them."""
    parts: list[tuple[Ints, HumpAim]] = []
    for choice in config.aims:
        design = design_of(config, threads, config.positions[-1])
        parts.append((np.array(choice.rows), table_aim(choice, config.routes, config.kinds, design)))
    for number in np.unique(config.routes.positions_of[list(config.designed_rows)]):
        rows = np.array([row for row in config.designed_rows if config.routes.positions_of[row] == number])
        design = design_of(config, threads, config.positions[number - 1])
        parts.append((rows, hump_aim(config.routes, design, rows)))
    if not parts:
        return no_aim(len(config.routes.routes), len(config.categories.members), config.settings.aim.lowest_m_s)
    return joined_aims(parts, len(config.routes.routes))


def design_of(config: ResolvedTrial, threads: int, last: PositionChoice) -> AimDesign:
    """How the exit speeds of the position `last` are chosen: for the error of its controller."""
    aim = config.settings.aim
    measured = aim.knowledge == "measured"
    return AimDesign(
        population=config.people,
        position=NormalPosition(stated_exit_std_m_s(last)),
        requirement=Requirement(aim.p_overspeed, aim_range_m_s(aim, last)),
        knowledge=MeasuredAhead(config.settings.sensors.speed_std_m_s) if measured else ByCategory(),
        design_cuts=aim.design_cuts,
        seed=config.settings.trains.seed,
        threads=threads,
        coupling_speed_m_s=config.settings.couplings.allowed_m_s,
    )


def stated_exit_std_m_s(choice: PositionChoice) -> float:
    """What an aim takes for the error of a position: of a book, the root mean square of what its tables predict."""
    if choice.book is None:
        return choice.exit_std_m_s or 0.0
    tables = tables_at(choice.book).only_lines("a position of a trial")
    return float(np.sqrt(np.mean([table.predicted.rms_m_s**2 for table in tables])))
