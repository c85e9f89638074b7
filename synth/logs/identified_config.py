"""Which numbers of a configuration the identified numbers are (the one place that says so), and the configuration
with what measured passes say of them, each with its origin, as a file of its own.

Numbers that the passes do not tell stay as they were, and stay assumed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from plant_models import Plant
from plant_models.motion import braked_axles, mean_braked_axles
from plant_models.retarder import factor_at
from synth.frame.settings.toml_file import Tree
from synth.logs import unknowns as asked
from synth.logs.estimate import Estimate
from synth.logs.identify import Finding, findings_of
from synth.retarder.configuration.config_file import ConfigSource
from synth.retarder.configuration.plant_settings import DEFAULT_CUTS
from synth.retarder.configuration.resolved_config import ResolvedConfig

FACTORS = asked.FORCE + "slope_factor_by_axles"

OF_INSTRUMENTS = (asked.BIAS, asked.GAUGE_NOISE)
"""Numbers of the log alone: no configuration has them."""


@dataclass(frozen=True)
class ConfiguredNumber:
    """`value` of the configuration's `key` ("cut[0]. …" for a class), which the identified number `by` tells."""

    key: str
    value: float | tuple[float, ...]
    by: str


def configured_numbers(values: Mapping[str, float], config: ResolvedConfig) -> Iterator[ConfiguredNumber]:
    """What the identified numbers `values`, by key, are in `config`.

    Most have its keys. A slope by axles goes into the factors of the force slope; rolling resistance of a category, and
    the spread of all, into the classes.
    """
    for key, value in values.items():
        if key in OF_INSTRUMENTS:
            continue
        if key == asked.SLOPE_BY_AXLES:
            yield ConfiguredNumber(FACTORS, factors_by_axles(config, value), key)
        elif key == asked.RESISTANCE_SPREAD:
            for number, of_class in enumerate(config.cuts):
                std = of_class.resistance.std_n_per_kn
                yield ConfiguredNumber(f"cut[{number}].rolling_resistance.std_n_per_kn", std * value, key)
        elif key.startswith(asked.RESISTANCE):
            for number, of_class in enumerate(config.cuts):
                if of_class.cut.category == key.removeprefix(asked.RESISTANCE):
                    yield ConfiguredNumber(f"cut[{number}].rolling_resistance.mean_n_per_kn", value, key)
        else:
            yield ConfiguredNumber(key, value, key)


def factors_by_axles(config: ResolvedConfig, by_axles: float) -> tuple[float, ...]:
    """c(N) for as many wheel pairs as the classes ever have inside, times 1 + `by_axles` (N − N̄).

    N̄ is the mean over the classes, as in the likelihood (`pass_rows`).
    """
    force = config.retarder.position.force
    old: tuple[float, ...] = getattr(force, "slope_factor_by_axles", (1.0,))
    if by_axles == 0.0:
        return old
    plants = [plant for _, plant in config.plants()]
    middle = float(np.mean([mean_braked_axles(plant.position, plant.cut) for plant in plants]))
    most = max(len(old), *(most_braked_axles(plant) for plant in plants))
    return tuple(factor_at(old, n) * (1.0 + by_axles * (n - middle)) for n in range(1, most + 1))


def most_braked_axles(plant: Plant) -> int:
    """Most wheel pairs of the cut that stand in the retarders at a time."""
    return int(braked_axles(plant.position, plant.cut, np.arange(0.0, plant.exit_m, 0.05)).max())


DIGITS: Final = 6


def identified(source: ConfigSource, found: Estimate, origin: str) -> ConfigSource:
    """`source` with the numbers of `found` that the passes tell; `origin` says of which passes."""
    told = {finding.key: finding for finding in findings_of(found) if is_told(finding)}

    def sentence(key: str) -> str:
        low, high = told[key].interval
        return f"identified from {origin}, 95 % interval {low:.4g} to {high:.4g} {told[key].unit}".strip()

    values = {key: finding.value for key, finding in told.items()}
    return with_numbers(source, values, f"identified from {origin}", sentence)


def is_told(finding: Finding) -> bool:
    """Whether a configuration takes the number: where it may be 0, a slope by axles is told as well by one slope."""
    low, high = finding.interval
    return finding.identified and not (finding.key == asked.SLOPE_BY_AXLES and low <= 0.0 <= high)


def with_numbers(
    source: ConfigSource, values: Mapping[str, float], place: str, origin: Callable[[str], str]
) -> ConfigSource:
    """`source` with the identified numbers `values` by key, called `place`; `origin` of a key says where it is from."""
    tree: Tree = {key: value for key, value in source.tree.items() if key not in ("cut", "sources")}
    cuts = [dict(cut) for cut in source.tree.get("cut") or [cut.model_dump(exclude_unset=True) for cut in DEFAULT_CUTS]]
    sources: dict[str, str] = {}
    for number in configured_numbers(values, source.resolved()):
        *path, name = number.key.split(".")
        table = tree
        if path[0].startswith("cut["):
            table = cuts[int(path.pop(0)[4:-1])]
        for part in path:
            table[part] = table = dict(table.get(part, {}))
        table[name] = [*map(rounded, number.value)] if isinstance(number.value, tuple) else rounded(number.value)
        sources[number.key] = origin(number.by)
    kept = {k: v for k, v in source.tree.get("sources", {}).items() if k not in sources}
    tree["cut"], tree["sources"] = cuts, kept | sources
    return ConfigSource(place, tree, source.library)


def rounded(value: float) -> float:
    """To so many digits as nobody measures."""
    return float(f"{value:.{DIGITS}g}")
