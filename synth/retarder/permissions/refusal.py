"""Configurations for which nobody can tell what permissions of the hardware would give."""

from __future__ import annotations

from plant_models import PlantError
from synth.frame.input_error import InputError
from synth.problem.any_time_resolution import design_resolution
from synth.retarder.configuration.plant_fault import in_file
from synth.retarder.configuration.resolved_config import ResolvedConfig


def require_tellable(config: ResolvedConfig, source: str, asked: str) -> None:
    """`InputError` about `source` where nobody can tell permissions of `config`; `asked`: what asks for them."""
    if config.criterion.requirement is not None:
        raise InputError(
            f"{source}: criterion has p_overspeed or worst_friction_*, for which {asked} has no design: commands at "
            "any time are designed for the mean square error alone; leave these keys out"
        )
    if config.regulator.at_any_time:
        raise InputError(
            f'{source}: regulator.commands is "any_time", but {asked} tells what to ask the hardware for beyond '
            'commands at rest: set it to "at_rest"'
        )
    with in_file(source):
        for _, problem in config.problems():
            try:
                problem.plant.drive_at_any_time()
                design_resolution(problem.plant, problem.target_speed_m_s)
            except PlantError as error:  # nobody has asked for such commands by name
                raise PlantError(f"{error}; {asked} designs commands at any time") from None


def tellable(config: ResolvedConfig) -> bool:
    """Whether permissions of `config` can be told."""
    try:
        require_tellable(config, "", "")
    except InputError:
        return False
    return True
