"""Which cases of a configuration a study takes: a class of cuts and a target, named MASS:TARGET."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from synth.frame.input_error import InputError

if TYPE_CHECKING:
    from plant_models import Plant
    from synth.retarder.configuration.resolved_config import ResolvedConfig


OTHER_PLANTS = (
    ("park", '[position]\nname = "rnz-2m-park"\n[[cut]]\ncar = "gondola-4"\nmass_t = 36\n'),
    ("three cars", '[targets]\nexit_speeds_m_s = [4.0]\n[[cut]]\ncar = "gondola-4"\ncars = 3\nmass_t = 156\n'),
    ("8 axles", '[targets]\nexit_speeds_m_s = [3.5]\n[[cut]]\ncar = "tank-8"\nmass_t = 120\n'),
)
"""Configurations besides the default one: name, text."""


@dataclass(frozen=True)
class Case:
    """A plant with the label of its class of cuts, and a target speed."""

    label: str
    plant: Plant
    target_m_s: float

    @property
    def name(self) -> str:
        """'22 t to 2 m/s'."""
        return f"{self.plant.cut.mass_t:g} t to {self.target_m_s:g} m/s"


def named_cases(config: ResolvedConfig, words: Sequence[str]) -> tuple[Case, ...]:
    """The cases named '22:2' (mass of a cut of the configuration, t : target, m/s). Raises `InputError`."""
    plants = {plant.cut.mass_t: (label, plant) for label, plant in config.plants()}
    found = []
    for word in words:
        try:
            mass, target = (float(part) for part in word.split(":"))
            label, plant = plants[mass]
        except (KeyError, ValueError):
            known = ", ".join(f"{mass:g}" for mass in plants)
            raise InputError(
                f"study: the case is {word!r}; give MASS:TARGET as in 22:2, the mass one of {known} t"
            ) from None
        found.append(Case(label, plant, target))
    return tuple(found)


def of_masses(config: ResolvedConfig, masses_t: Sequence[float]) -> ResolvedConfig:
    """`config` with the cuts of these masses only; with all of them where none is given. Raises `InputError`."""
    known = {cut_class.cut.mass_t for cut_class in config.cuts}
    unknown = [mass for mass in masses_t if mass not in known]
    if unknown:
        all_known = ", ".join(f"{mass:g}" for mass in sorted(known))
        raise InputError(f"study: no cut of the configuration has {unknown[0]:g} t; its masses are {all_known} t")
    return replace(config, cuts=tuple(c for c in config.cuts if not masses_t or c.cut.mass_t in masses_t))


def class_cases(config: ResolvedConfig, masses_t: Sequence[float], targets_m_s: Sequence[float]) -> tuple[Case, ...]:
    """The cuts of these masses (all for none) to each of these speeds (their targets for none). Raises `InputError`."""
    return tuple(
        Case(label, plant, target)
        for label, plant in of_masses(config, masses_t).plants()
        for target in targets_m_s or config.targets_of(label)
    )
