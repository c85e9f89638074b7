"""New tables from measured passes: estimate, tune, and keep what is better beyond doubt."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set
from dataclasses import dataclass

from synth.frame.workers.engine import Teller, Watcher
from synth.logs.estimate import Estimate, estimate
from synth.logs.fitting_passes import FittingPasses
from synth.logs.identified_config import identified
from synth.logs.retune.predicted_gain import CaseGain, GainOrder, better, likely_plants, predicted_gains
from synth.logs.retune.tuned_books import Case, cases_of, class_setups, finished, tuned_tables
from synth.logs.unknowns import unknowns_of
from synth.retarder.configuration.config_file import ConfigSource
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.failed_case import FailedCase
from tuning_tables import ControllerTable


@dataclass(frozen=True)
class Retuned:
    """`config` before, `identified` after; `gains` of all cases; `old`, `new` tables by case.

    `tables`: the new book, in which cases without a proven gain keep their lines; empty where that is all of them.
    `failed`: cases that no new table could be tuned for; they keep the old one, if there is one.
    """

    config: ResolvedConfig
    identified: ResolvedConfig
    estimate: Estimate
    created: str
    gains: tuple[CaseGain, ...]
    old: Mapping[Case, ControllerTable]
    new: Mapping[Case, ControllerTable]
    tables: tuple[ControllerTable, ...]
    failed: tuple[FailedCase, ...] = ()

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


def retune(passes: FittingPasses, source: ConfigSource, order: RetuneOrder, watcher: Watcher) -> Retuned:
    """Tables for the configuration that `identify` would write: `source` with what `passes` say.

    Raises `InputError` or `PlantError` for numbers that no plant has, and where no case has a new table.
    """
    config = source.resolved()
    found = estimate(passes, unknowns_of(passes, config.parameters), order.threads)
    watcher.note(f"{len(found.unknowns)} numbers identified from {found.passes} passes")
    told = identified(source, found, f"{found.passes} passes").resolved()
    old = order.old
    if old is None:
        before = tuned_tables(config, class_setups(config, order.created), order.threads, Teller(lambda _: None))
        old = before.tables
        watcher.note(f"{len(old)} tables of the configuration tuned")
        for case in before.failed:
            watcher.note(f"with the configuration as it is, {case.sentence}")
    setups = class_setups(told, order.created)
    tuned = tuned_tables(told, setups, order.threads, watcher)
    new = tuned.tables or tuned.whole
    plants = likely_plants(source, found, order.gain)
    gains = predicted_gains(old, new, plants, order.gain, order.threads)
    watcher.note(f"{len(gains)} cases compared on {len(plants)} likely plants")
    proven = {gain.case for gain in better(gains)}
    tables = () if not proven else finished(setups, *book_of(cases_of(told), old, new, proven))
    return Retuned(config, told, found, order.created, gains, old, new, tables, tuned.failed)


def book_of(
    cases: Iterable[Case],
    old: Mapping[Case, ControllerTable],
    new: Mapping[Case, ControllerTable],
    proven: Set[Case],
) -> tuple[dict[Case, ControllerTable], frozenset[Case]]:
    """The tables of the new book in the order of `cases`, and the cases that keep their old lines.

    These are all that have an old table and are not `proven`, because they are within noise or have no new one.
    """
    cases = [case for case in cases if case in old or case in new]
    kept = frozenset(case for case in cases if case in old and case not in proven)
    return {case: old[case] if case in kept else new[case] for case in cases}, kept
