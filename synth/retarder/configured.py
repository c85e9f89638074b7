"""What commands on the configuration of a tune share: its reading, its head, and what is refused before any work."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from plant_models import PlantError
from synth.frame.command import Head
from synth.frame.input_error import InputError
from synth.retarder.configuration.resolved_config import ResolvedConfig

if TYPE_CHECKING:
    from synth.retarder.epochs import Epochs


def head_of(config: ResolvedConfig, warnings: tuple[str, ...] = (), reads: tuple[Path, ...] = ()) -> Head:
    """What is said of `config`, with more warnings, and the other files that are read."""
    return Head(
        title=config.title,
        canonical_json=config.canonical_json(),
        parameters=config.parameters,
        output=config.output,
        warnings=(*config.warnings, *warnings),
        reads=reads,
    )


def sensors_left_aside(config: ResolvedConfig) -> tuple[str, ...]:
    """A word about point sensors in a configuration whose tables are made for a radar."""
    if config.sensors is None:
        return ()
    return ("tables are made for the radar of [sensor]; 'retarder-synth tune' makes those for [sensors]",)


def require_room(config: ResolvedConfig, epochs: Epochs[Any, Any], place: str, workers: int) -> None:
    """`InputError` about the file `place` if the grids of a tune on `epochs` would not fit into memory."""
    from synth.solver.chain.grid import require_memory

    for label, plant in config.plants():
        served, grids = epochs.grids(config, plant)
        try:
            require_memory(label, served, grids, workers)
        except PlantError as error:
            raise InputError(f"{place}: {str(error).replace('grid: ', 'grid.', 1)}") from None
