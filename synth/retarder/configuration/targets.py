"""Commanded exit speeds of a configuration: the general ones and those of a class."""

from __future__ import annotations

from plant_models import EntryLaw
from synth.frame.input_error import InputError


def resolve_targets(key: str, speeds_m_s: tuple[float, ...], entry: EntryLaw, file: str) -> tuple[float, ...]:
    """The targets under `key`, which must be different and below the highest entry speed."""
    for speed in speeds_m_s:
        if not 0.3 <= speed < entry.high_m_s:
            raise InputError(
                f"{file}: {key} holds {speed!r}; a target must be at least 0.3 m/s and below the highest entry speed, "
                f"entry.high_m_s = {entry.high_m_s:g}"
            )
    named: dict[str, float] = {}
    for speed in speeds_m_s:
        name = f"{speed:g}"
        if name in named:
            raise InputError(
                f"{file}: {key} holds {named[name]!r} and {speed!r}, but tables are named by six digits of their "
                "target; give each only once"
            )
        named[name] = speed
    return speeds_m_s
