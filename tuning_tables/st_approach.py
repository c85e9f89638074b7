"""The approach in the Structured Text export: the gate of the rule, its part of a table, the interlock in words."""

from __future__ import annotations

from collections.abc import Mapping
from string import Template
from typing import Final

from tuning_tables.st_literals import int_array, real, real_array
from tuning_tables.table_block import BlockSize, TableBlock, approach_m

NO_APPROACH: Final[Mapping[str, str]] = {
    **dict.fromkeys(("GATE_RULE", "INTERLOCK", "APPROACH_MEMBERS", "GATE", "SAME_APPROACH", "LOAD_APPROACH"), ""),
}

APPROACH: Final[Mapping[str, str]] = {
    "GATE_RULE": """
      Before the entrance (path below 0.0) only below EntranceStage: no stage above it is commanded there.""",
    "INTERLOCK": """
   Approach
   The regulator acts from Approach_m before the entrance on. The path is negative there, and 0.0 where the first axle
   enters. The interlock is the program's: the regulator may take over a cut only when the cut ahead has left the
   position, its last axle out of the last retarder, and then only when the stage commanded is at most EntranceStage.
""",
    "APPROACH_MEMBERS": """
        Approach_m : REAL; (* the regulator acts from so far before the entrance; 0: from the entrance on *)
        EntranceStage : INT; (* the highest stage that may be commanded before the entrance *)""",
    "GATE": """
                AND ((Path >= 0.0) OR (Wanted < Table.EntranceStage))""",
    "SAME_APPROACH": """
                AND (Table.Approach_m = Faster.Approach_m) AND (Table.EntranceStage = Faster.EntranceStage)""",
    "LOAD_APPROACH": """
    Table.Approach_m := ApproachOf[TableNo];
    Table.EntranceStage := EntranceStageOf[TableNo];""",
}

CHECK: Final = """\
IF (Table.Approach_m <> $LENGTH) OR (Table.EntranceStage <> $STAGE) THEN
    IF Failed = 0 THEN
        FirstFailed := 0;
    END_IF;
    Failed := Failed + 1;
END_IF;
"""


def approach_blanks(size: BlockSize) -> Mapping[str, str]:
    """What the templates ask for about approaches; nothing much if no table has one."""
    return APPROACH if size.approach else NO_APPROACH


def approach_constants(blocks: list[TableBlock], size: BlockSize) -> list[str]:
    """Declarations: length and entrance stage by table; none if no table has an approach."""
    if not size.approach:
        return []
    return [
        real_array("ApproachOf", [approach_m(block.table) for block in blocks]),
        int_array("EntranceStageOf", [block.table.entrance_stage for block in blocks]),
    ]


def approach_check(block: TableBlock) -> str:
    """Whether a table has the approach and the entrance stage that it should have."""
    length = real(approach_m(block.table))
    return Template(CHECK).substitute(LENGTH=length, STAGE=block.table.entrance_stage)
