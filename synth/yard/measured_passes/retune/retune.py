"""New tables from measured passes: estimate, tune, and keep what is better beyond doubt."""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import dataclass

from synth.configuration.resolved_config import ResolvedConfig
from synth.yard.measured_passes.config_source import ConfigSource
from synth.yard.measured_passes.estimate import Estimate, estimate
from synth.yard.measured_passes.fitting_passes import FittingPasses
from synth.yard.measured_passes.identified_config import identified
from synth.yard.measured_passes.retune.predicted_gain import CaseGain, GainOrder, better, likely_plants, predicted_gains
from synth.yard.measured_passes.retune.tuned_books import Case, Tell, class_setups, finished, tuned_tables
from synth.yard.measured_passes.unknowns import unknowns_of
from tuning_tables import ControllerTable


@dataclass(frozen=True)
class Retuned:
    """`config` before, `identified` after; `gains` of all cases; `old`, `new` tables by case.

    `tables`: the new book, in which cases without a proven gain keep their lines; empty where that is all of them.
    """

    config: ResolvedConfig
    identified: ResolvedConfig
    estimate: Estimate
    created: str
    gains: tuple[CaseGain, ...]
    old: Mapping[Case, ControllerTable]
    new: Mapping[Case, ControllerTable]
    tables: tuple[ControllerTable, ...]

    @property
    def changed(self) -> tuple[CaseGain, ...]:
        """The cases whose new table is better beyond doubt, all cases considered."""
        return better(self.gains)


STANDARD = GainOrder()


@dataclass(frozen=True)
class RetuneOrder:
    """What runs in the yard: `old` tables by case, None: those that a tune of the configuration makes."""

    old: Mapping[Case, ControllerTable] | None
    created: str
    gain: GainOrder = STANDARD
    threads: int = 1


def retune(passes: FittingPasses, source: ConfigSource, order: RetuneOrder, tell: Tell) -> Retuned:
    """Tables for the configuration that `identify` would write: `source` with what `passes` say.

    Raises `InputError` or `PlantError` for numbers that no plant has.
    """
    config = source.resolved()
    found = estimate(passes, unknowns_of(passes, config.parameters), order.threads)
    tell(f"{len(found.unknowns)} numbers identified from {found.passes} passes")
    told = identified(source, found, f"{found.passes} passes").resolved()
    old = order.old
    if old is None:
        old = tuned_tables(config, class_setups(config, order.created), order.threads, lambda _: None)
        tell(f"{len(old)} tables of the configuration tuned")
    setups = class_setups(told, order.created)
    new = tuned_tables(told, setups, order.threads, tell)
    plants = likely_plants(source, found, order.gain)
    gains = predicted_gains(old, new, plants, order.gain, order.threads)
    tell(f"{len(gains)} cases compared on {len(plants)} likely plants")
    proven = {gain.case for gain in better(gains)}
    tables = () if not proven else finished(setups, *book_of(old, new, proven))
    return Retuned(config, told, found, order.created, gains, old, new, tables)


def book_of(
    old: Mapping[Case, ControllerTable], new: Mapping[Case, ControllerTable], proven: Set[Case]
) -> tuple[dict[Case, ControllerTable], frozenset[Case]]:
    """The tables of the new book, and the cases that keep their old lines: all but those `proven` and new ones."""
    kept = frozenset(case for case in new if case in old and case not in proven)
    return {case: old[case] if case in kept else table for case, table in new.items()}, kept
