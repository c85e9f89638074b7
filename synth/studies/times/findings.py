"""What the study of times has found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from synth.studies.markdown_table import MarkdownTable, table
from synth.studies.study import Findings
from synth.studies.timing.machine import Machine
from synth.studies.timing.turns import Times, speed_against


@dataclass(frozen=True)
class Waited:
    """A command and its times."""

    name: str
    times: Times

    @property
    def cell(self) -> str:
        """'9.03 s (9 to 9.1, n = 5)'."""
        least, greatest = min(self.times.wall_s), max(self.times.wall_s)
        return f"{self.times.median_s:.3g} s ({least:.3g} to {greatest:.3g}, n = {len(self.times.wall_s)})"


@dataclass(frozen=True)
class WaitingTimes(Findings):
    """`commands`: processes of a user; `simulated`: so many passes by threads; `parts` of so many passes on one thread.

    The last of `parts` are the passes one after the other, the last but one the same side by side.
    """

    machine: Machine
    case: str
    passes: int
    part_passes: int
    commands: tuple[Waited, ...]
    simulated: tuple[Waited, ...]
    parts: tuple[Waited, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """`commands`, `passes`, `parts`."""
        rates = [(w.name, w.cell, f"{self.passes / w.times.median_s:,.0f}".replace(",", " ")) for w in self.simulated]
        return {
            "commands": table("What a user waits for", ("", "wall time"), ((w.name, w.cell) for w in self.commands)),
            "passes": table(
                f"{self.passes} passes of {self.case}, random numbers included", ("", "wall time", "passes a second"),
                rates,
            ),
            "parts": table(
                f"Parts of {self.part_passes} passes on one thread", ("", "wall time, ms"),
                ((w.name, w.times.milliseconds) for w in self.parts),
            ),
        }  # fmt: skip

    def sentences(self) -> tuple[str, ...]:
        """The machine, and what vectors gain."""
        side_by_side, one_by_one = self.parts[-2:]
        gain = speed_against(one_by_one.times, side_by_side.times)
        return (
            self.machine.sentence,
            f"passes side by side are {gain.cell} times as fast as the same passes one by one",
        )
