"""An attempt at one case of a book: what is made, or the case as failed, with what to change in its configuration."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeVar

from plant_models import PlantError
from plant_models.library.data_file import keyed
from synth.retarder.configuration.plant_fault import KEY_OF_PLANT_MESSAGE, LONGEST_SENTENCE
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.failed_case import FailedCase
from synth.solver.coarse_grid import STEPS, CoarseGridError
from tuning_tables import InvalidTable
from tuning_tables.excerpt import excerpt

Made = TypeVar("Made")

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
