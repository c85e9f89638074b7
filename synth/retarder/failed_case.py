"""One case of a book that no table can be made for, and why: it is told of, and loses none but itself. What is made of
a case whose input is at fault: the case as failed, or a refusal, with what to change.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final, TypeVar

from plant_models import PlantError
from plant_models.library.data_file import keyed
from synth.frame.faults import InputError
from synth.retarder.configuration.plant_fault import KEY_OF_PLANT_MESSAGE, LONGEST_SENTENCE
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.solver.descent import STEPS, CoarseGridError
from tuning_tables import InvalidTable
from tuning_tables.errors import excerpt

Made = TypeVar("Made")


@dataclass(frozen=True)
class FailedCase:
    """A cut class and target without a table; `reason`: why, and what to change, in one sentence without a full stop.

    Of some part of a case, as that: its table can be there.
    """

    label: str
    target_m_s: float
    reason: str

    @property
    def case(self) -> tuple[str, float]:
        """Class, and target in m/s."""
        return self.label, self.target_m_s

    @property
    def name(self) -> str:
        """Class and target in words."""
        return f"{self.label} to {self.target_m_s:g} m/s"

    @property
    def sentence(self) -> str:
        """The case, that it has no table, and why."""
        return f"{self.name}: no table: {self.reason}"


def told_together(failed: Iterable[FailedCase]) -> str:
    """All of them with their reasons; those that fail for the same one are named side by side."""
    by_reason: dict[str, list[str]] = {}
    for case in failed:
        by_reason.setdefault(case.reason, []).append(case.name)
    return "; ".join(f"{', '.join(names)}: {reason}" for reason, names in by_reason.items())


def require_none(failed: Iterable[FailedCase]) -> None:
    """`PlantError` where a case has failed, for who needs all of them."""
    told = told_together(failed)
    if told:
        raise PlantError(f"no table for {told}")


def parted(results: Iterable[Made | FailedCase]) -> tuple[tuple[Made, ...], tuple[FailedCase, ...]]:
    """What was made, and what has failed, each in the order of `results`."""
    kept, failed = [], []
    for result in results:
        if isinstance(result, FailedCase):
            failed.append(result)
        else:
            kept.append(result)
    return tuple(kept), tuple(failed)


KEYS_OF_LINES: Final = (*STEPS, "fit.degree")
"""Keys of a configuration that lines depend on."""


def attempted(make: Callable[[], Made], label: str, target_m_s: float, config: ResolvedConfig) -> Made | FailedCase:
    """What `make` gives, or the case as failed.

    These are all the ways in which a case fails by its input: `PlantError`, which a grid too coarse is, and
    `InvalidTable`. Everything else is a fault of the program or of the machine, and is raised.
    """
    try:
        return make()
    except (PlantError, InvalidTable) as fault:
        return FailedCase(label, target_m_s, reason_of(fault, config))


def reason_of(fault: PlantError | InvalidTable, config: ResolvedConfig) -> str:
    """What `fault` says, with what to change and the present values of those keys."""
    if isinstance(fault, InvalidTable):
        sentence = no_table(fault)
    else:
        sentence = excerpt(keyed(str(fault), KEY_OF_PLANT_MESSAGE), LONGEST_SENTENCE)
    keys = (
        fault.keys if isinstance(fault, CoarseGridError) else KEYS_OF_LINES if isinstance(fault, InvalidTable) else ()
    )
    present = {each.key: each.value for each in config.parameters if isinstance(each.value, float)}
    now = " and ".join(f"{key} is {present[key]:g}" for key in keys)
    return " ".join(f"{sentence}; now {now}".split()) if now else " ".join(sentence.split())


def no_table(fault: InvalidTable) -> str:
    """What it means that lines or switching speeds make no table."""
    return (
        f"what was found makes no table ({str(fault).rstrip('.')}): make grid.path_step_m or grid.speed_step_m_s "
        "smaller, or lower fit.degree"
    )


@contextlib.contextmanager
def tables_refused(source: str, config: ResolvedConfig) -> Iterator[None]:
    """Within, a `PlantError` and an `InvalidTable` become an `InputError` of `source`, which says `config`."""
    try:
        yield
    except (PlantError, InvalidTable) as fault:
        raise InputError(f"{source}: {reason_of(fault, config)}") from None


def require_a_table(cases: Sequence[object], failed: Sequence[FailedCase]) -> None:
    """`PlantError` where all cases have failed; it tells the first."""
    if cases or not failed:
        return
    first, others = failed[0], len(failed) - 1
    more = f" (nor for the {others} other case{'s' * (others > 1)})" if others else ""
    raise PlantError(f"no table for {first.name}{more}: {first.reason}")
