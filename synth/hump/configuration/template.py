"""A commented hump trial configuration to start from: that of the built-in hump and mix of cars."""

from __future__ import annotations

from plant_models.library.hump_entry import load_hump
from synth.aim.configuration.mix_settings import usual_mix
from synth.frame.settings.template import template
from synth.frame.settings.told import Usual
from synth.hump.configuration.settings import DEFAULT_HUMP, HumpTrialSettings


def default_trial_toml() -> str:
    """The defaults as TOML; it reads back to the same hump trial."""
    notes = load_hump(DEFAULT_HUMP).notes
    return template(HumpTrialSettings(), "Hump trial", "hump simulate", usual_trial(), notes)


def usual_trial() -> Usual:
    """What the built-in mix has for keys that are left out."""
    return usual_mix("cars")
