"""A commented aim configuration to start from: that of the built-in track and mix of cars."""

from __future__ import annotations

from dataclasses import replace

from plant_models.library import load_track, load_weight_categories
from synth.aim.configuration.mix_settings import usual_mix
from synth.aim.configuration.settings import AimFileSettings
from synth.aim.configuration.track_settings import DEFAULT_TRACK
from synth.aim.configuration.track_values import bends_of, elements_of
from synth.frame.settings.template import template
from synth.frame.settings.told import Told, Usual, told_numbers


def default_aim_toml() -> str:
    """The defaults as TOML; it reads back to the same aim configuration."""
    notes = load_track(DEFAULT_TRACK).notes
    return template(AimFileSettings(), "Aim configuration", "aim", usual_aim(), notes)


def usual_aim() -> Usual:
    """What the built-in track, mix and weight categories have for keys that are left out."""
    entry = load_track(DEFAULT_TRACK)
    told = told_numbers(entry.provenance)
    return {
        **told,
        **usual_mix("cuts"),
        "track.elements": replace(told["track.grade_permille"], value=elements_of(entry.track)),
        "track.bends": replace(told["bends.turn_deg"], value=bends_of(entry.track)),
        "position.name": Told(entry.position),
        "cuts.categories": Told(tuple(member.name for member in load_weight_categories().members)),
    }
