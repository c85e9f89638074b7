"""The on-line correction as code for controllers: one table without a choice, and a state kept from pass to pass."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tuning_tables.controller_code.code import ControllerCode, HeldTable, Questions, Rule
from tuning_tables.correction import Correction, golden_exits, golden_passes, golden_speeds
from tuning_tables.programs.correct import (
    CORRECTION,
    SETTING,
    begin_correction,
    corrected_speed,
    learn_exit,
    usable_exit,
)

BEGIN: Final = Rule(begin_correction, "begin_correction")
USABLE: Final = Rule(usable_exit, "usable_exit")
LEARN: Final = Rule(learn_exit, "learn_exit")
SPEED: Final = Rule(corrected_speed, "corrected_speed", "v_m_s")

HEAD: Final = (
    "What a table's exits are off by on average is learnt from the last passes, and added to the speed that the table "
    "is asked with. Each position has a state of its own, which is kept from pass to pass, also while power is off.",
)


def correction_code(correction: Correction) -> ControllerCode:
    """The export of a correction."""
    setting = HeldTable("as exported", correction.setting._asdict())
    return ControllerCode(
        stem="correction",
        title="On-line correction of the commanded speed of a car retarder from its last exits.",
        head=HEAD,
        origin=tuple(origin_lines(correction)),
        categories=(),
        records={SETTING.name: "correction_setting", CORRECTION.name: "correction"},
        declared=(SETTING, CORRECTION),
        room={},
        tables=(setting,),
        rules=(BEGIN, USABLE, LEARN, SPEED),
        chooses=(),
        questions=(
            Questions("exits", (LEARN, SPEED), golden_exits(correction)),
            Questions("passes", (USABLE,), golden_passes()),
            Questions("speeds", (SPEED,), golden_speeds(correction)),
        ),
        commands=(),
        empty="limit_m_s",
    )


def origin_lines(correction: Correction) -> Iterator[str]:
    """The numbers of a correction for the eye."""
    yield f"limit      {correction.limit_m_s:g} m/s: the correction never leaves +-limit"
    yield f"step       {correction.step_m_s:g} m/s: most that one pass changes it by"
    yield f"spread     {correction.spread_m_s:g} m/s: standard deviation of a usable exit around its mean"
    yield f"memory     {correction.memory_passes:g} passes"
