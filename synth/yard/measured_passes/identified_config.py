"""The configuration with what measured passes say of its numbers, each with its origin, as a file of its own.

Numbers that the passes do not tell stay as they were, and stay assumed.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

from synth.configuration.plant_settings import DEFAULT_CUTS
from synth.configuration.resolved_config import ResolvedConfig
from synth.configuration.toml_file import Tree
from synth.configuration.toml_text import toml_text
from synth.yard.measured_passes import unknowns as asked
from synth.yard.measured_passes.config_source import ConfigSource
from synth.yard.measured_passes.estimate import Estimate
from synth.yard.measured_passes.identifiability import Finding, findings_of
from synth.yard.measured_passes.identified_plants import FACTORS, factors_by_axles

TYPES: Final = "types"
DIGITS: Final = 6


def identified(source: ConfigSource, found: Estimate, origin: str) -> ConfigSource:
    """`source` with the numbers of `found`; `origin` says of which passes."""
    config = source.resolved()
    tree: Tree = {key: value for key, value in source.tree.items() if key not in ("cut", "sources")}
    cuts = [dict(cut) for cut in source.tree.get("cut") or [cut.model_dump(exclude_unset=True) for cut in DEFAULT_CUTS]]
    sources: dict[str, str] = {}
    for finding in findings_of(found):
        for key, value in values_of(finding, config):
            *path, name = key.split(".")
            table = cuts[int(path[0][4:-1])] if path[0].startswith("cut[") else tree
            for part in path[1:] if table is not tree else path:
                table[part] = table = dict(table.get(part, {}))
            table[name] = value
            low, high = finding.interval
            sources[key] = f"identified from {origin}, 95 % interval {low:.4g} to {high:.4g} {finding.unit}".strip()
    kept = {k: v for k, v in source.tree.get("sources", {}).items() if k not in sources}
    tree["cut"], tree["sources"] = cuts, kept | sources
    return ConfigSource(f"identified from {origin}", tree, source.library)


def values_of(finding: Finding, config: ResolvedConfig) -> Iterator[tuple[str, float | list[float]]]:
    """(key of the configuration, value) of what a finding changes."""
    if not finding.identified or finding.key in (asked.BIAS, asked.GAUGE_NOISE):
        return
    value = rounded(finding.value)
    if finding.key == asked.SLOPE_BY_AXLES:
        low, high = finding.interval
        if low > 0.0 or high < 0.0:  # else the force is as well told by one slope
            yield FACTORS, [rounded(c) for c in factors_by_axles(config, finding.value)]
    elif finding.key == asked.RESISTANCE_SPREAD:
        for number, of_class in enumerate(config.cuts):
            std = of_class.resistance.std_n_per_kn
            yield f"cut[{number}].rolling_resistance.std_n_per_kn", rounded(std * finding.value)
    elif finding.key.startswith(asked.RESISTANCE):
        category = finding.key.removeprefix(asked.RESISTANCE)
        for number, of_class in enumerate(config.cuts):
            if of_class.cut.category == category:
                yield f"cut[{number}].rolling_resistance.mean_n_per_kn", value
    else:
        yield finding.key, value


def rounded(value: float) -> float:
    """To so many digits as nobody measures."""
    return float(f"{value:.{DIGITS}g}")


def config_files(source: ConfigSource, name: str) -> dict[str, bytes]:
    """The files that tell `source`, by their paths in the folder of the configuration `name`."""
    tree: dict[str, Any] = dict(source.tree)
    if source.library.own:
        tree["library"] = [f"{TYPES}/"]
    files = {f"{TYPES}/{each.kind.folder}/{each.name}.toml": each.text.encode() for each in source.library.own}
    head = f"# {source.place[:1].upper()}{source.place[1:]}.\n"
    return {**files, name: (head + toml_text(tree)).encode("utf-8")}
