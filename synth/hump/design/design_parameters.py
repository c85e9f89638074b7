"""The numbers that a design test depends on, and all of that in one text."""

from __future__ import annotations

import json
from typing import Final

from plant_models.library import SourcedValue
from synth.frame.settings.numbers import numbers_of
from synth.hump.configuration.design_settings import DesignSettings
from synth.hump.trains.resolved_trial import ResolvedTrial
from tuning_tables.canonical import canonical_json

OF_TRIAL: Final = ("hump.", "position.", "exit_speeds.usable_share", "couplings.allowed_m_s", "hump_speed.early_s")
"""Beginnings of the keys of a trial that count for its hump."""


def design_parameters(config: ResolvedTrial) -> tuple[SourcedValue, ...]:
    """Those of hump, positions and runners."""
    of_hump = (each for each in config.parameters if each.key.startswith(OF_TRIAL))
    return (*of_hump, *numbers_of(config.settings.design, "design", DesignSettings()))


def design_json(config: ResolvedTrial) -> str:
    """What the figures depend on, in one form."""
    names = json.loads(config.trains_json)
    numbers = {each.key: each.value for each in design_parameters(config) if not each.key.startswith("hump.")}
    kept = {key: names[key] for key in ("hump_sha256", "lead", "categories", "positions", "roles")}
    return canonical_json({"format": "hump-design", **kept, "numbers": numbers}).decode("utf-8")
