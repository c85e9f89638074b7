"""What the study `hump-day` has found where positions work in their closed loop, and its tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from scripts.studies.humping.closed_loops import RegulatedCouplings
from scripts.studies.humping.day_figures import PairFigures
from scripts.studies.humping.exits import Exits, exits_table
from scripts.studies.humping.frontier import Gain
from scripts.studies.humping.pair_tables import gains_table, pair_table
from scripts.studies.markdown_table import MarkdownTable


@dataclass(frozen=True)
class RegulatedDay:
    """Gains of our tables beside other positions; variants at one least interval; couplings by regulator; what
    positions make of their commands."""

    gains: tuple[Gain, ...]
    beside: tuple[PairFigures, ...]
    couplings: tuple[RegulatedCouplings, ...]
    exits: tuple[Exits, ...]

    def tables(self) -> Mapping[str, MarkdownTable]:
        """See the titles."""
        return {
            "table-gains": gains_table("our tables: mean hump speed and cars an hour more, same trains", self.gains),
            "tables": pair_table("our tables", "positions", self.beside),
            "exits": exits_table(self.exits),
        }
