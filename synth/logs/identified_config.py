"""The configuration with what measured passes say of its numbers, each with its origin, as a file of its own.

Numbers that the passes do not tell stay as they were, and stay assumed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from synth.frame.settings.toml_file import Tree
from synth.logs import unknowns as asked
from synth.logs.configured_numbers import configured_numbers
from synth.logs.estimate import Estimate
from synth.logs.identifiability import Finding, findings_of
from synth.retarder.configuration.config_file import ConfigSource
from synth.retarder.configuration.plant_settings import DEFAULT_CUTS

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
