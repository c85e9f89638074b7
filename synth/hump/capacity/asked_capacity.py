"""What a capacity is asked of: the curves, their points, and the trial of each point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain
from math import prod
from typing import Final

from synth.frame.command import Asked
from synth.frame.faults import InputError
from synth.hump.capacity.curves import Axis, Curve
from synth.hump.capacity.variants import KeyValues, Variant, changed_text, key_values, variants
from synth.hump.configuration.trial_file import TrialFile, parse_trial_file
from synth.hump.options import MOST_POINTS, CapacityOptions
from synth.hump.trial.asked_trial import AskedTrial, asked_trial

MOST_CURVES: Final = 50

LEAST: Final = Axis("hump_speed.least_s", "least interval of the program", "s", ())
CONSTANT: Final = Axis("hump_speed.constant_m_s", "hump speed", "m/s", ())

TYPED: Final = {"trains.number": "--trains", "trains.seed": "--seed", "trains.list": "--list"}
"""Keys that all curves have in common, and what tells them."""

ABOUT: Final = (0.7, 0.85, 1.0, 1.15, 1.3)
"""Speeds of a curve where the trial has one constant speed, as shares of it."""


@dataclass(frozen=True)
class AskedCapacity:
    """`base`: the trial as it is; `points` of each of `variants` along `axis`, as many trains each."""

    base: AskedTrial
    variants: tuple[Variant, ...]
    axis: Axis
    points: tuple[tuple[AskedTrial, ...], ...]
    options: CapacityOptions

    @property
    def number(self) -> int:
        """Trains of each point."""
        return self.base.config.settings.trains.number

    @property
    def every_point(self) -> tuple[AskedTrial, ...]:
        """Those of all curves."""
        return tuple(chain.from_iterable(self.points))


@dataclass(frozen=True)
class FoundCapacity:
    """The curves that were asked for."""

    asked: AskedCapacity
    curves: tuple[Curve, ...]


def asked_capacity(asked: Asked[TrialFile, CapacityOptions]) -> AskedCapacity:
    """The trials of all points. `InputError` for a change that the trial does not take, with the change in front."""
    options = asked.options
    options.require_one("hump capacity")
    base = asked_trial(asked.settings, options, options.trains)
    axis = axis_of(options, base)
    values = key_values_of(options, base)
    require_other_keys(values)
    curves = prod(len(each.values) for each in values)
    if curves > MOST_CURVES:
        raise InputError(f"hump capacity: --set and --exit-std ask for {curves} curves; at most {MOST_CURVES}")
    chosen = variants(values)

    def trial_at(variant: Variant, value: float) -> AskedTrial:
        changes = {**variant.changes, axis.key: value}
        try:
            text = changed_text(asked.text, asked.place, changes)
            return asked_trial(parse_trial_file(text, asked.place), options, options.trains)
        except InputError as fault:
            told = ", ".join(filter(None, (variant.name, f"{axis.key} {value:g}")))
            raise InputError(*(f"with {told}: {sentence}" for sentence in fault.sentences)) from None

    points = tuple(tuple(trial_at(variant, value) for value in axis.values) for variant in chosen)
    return AskedCapacity(base, chosen, axis, points, options)


def require_other_keys(values: Sequence[KeyValues]) -> None:
    """`InputError` for a key that changes along each curve, that all curves have in common, or that is given twice."""
    taken = {**TYPED, LEAST.key: "--least", CONSTANT.key: "--speeds"}
    known: set[str] = set()
    for key in (key for each in values for key in each.keys):
        if key in taken:
            raise InputError(f"--set {key}: all curves have it in common; give it by {taken[key]}")
        if key in known:
            raise InputError(f"--set {key}: its values are given twice; give each key once")
        known.add(key)


def axis_of(options: CapacityOptions, base: AskedTrial) -> Axis:
    """Constant speeds where they are asked for or the trial has one, else programs."""
    constant = base.config.settings.hump_speed.constant_m_s
    if options.speeds is not None:
        return axis_with(CONSTANT, sorted(options.speeds), "--speeds")
    if constant is not None:
        return axis_with(CONSTANT, [round(share * constant, 3) for share in ABOUT], "--speeds")
    return axis_with(LEAST, sorted(options.least, reverse=True), "--least")


def axis_with(axis: Axis, values: Sequence[float], option: str) -> Axis:
    """`axis` with these values. `InputError` for too few or too many."""
    if not 2 <= len(set(values)) == len(values) <= MOST_POINTS:
        raise InputError(f"{option} has {len(values)} values; a curve needs 2 to {MOST_POINTS} that differ")
    return replace(axis, values=tuple(values))


def key_values_of(options: CapacityOptions, base: AskedTrial) -> list[KeyValues]:
    """What curves differ in."""
    found = [key_values(words) for words in options.set]
    if options.exit_std is not None:
        normal = tuple(each.number for each in base.config.positions if each.book is None and not each.out_of_service)
        keys = tuple(f"position.{number}.exit_std_m_s" for number in normal)
        if not keys:
            raise InputError(
                "--exit-std: every position of this trial runs tables, which have an accuracy of their own"
            )
        found.insert(0, KeyValues("exit_std_m_s", keys, options.exit_std))
    return found
