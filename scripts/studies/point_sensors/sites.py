"""The plants that point sensors are put to: a bunch position, a park position, the position behind a car dumper."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from plant_models import Plant
from plant_models.library.near_miss import near_miss
from synth.frame.input_error import InputError
from synth.problem.aim import Aim
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig

TEXTS = {
    "bunch-22": ("", '[[cut]]\ncar = "gondola-4"\nmass_t = 22\ntargets_m_s = [2.0]\n'),
    "bunch-52": ("", '[[cut]]\ncar = "gondola-4"\nmass_t = 52\ntargets_m_s = [3.0]\n'),
    "park-22": (
        '[position]\nname = "rnz-2m-park"\n',
        '[[cut]]\ncar = "gondola-4"\nmass_t = 22\ntargets_m_s = [2.0]\n',
    ),
    "park-85": (
        '[position]\nname = "rnz-2m-park"\n[entry]\nhigh_m_s = 4.5\n',
        '[[cut]]\ncar = "gondola-4"\nmass_t = 85\ntargets_m_s = [2.5]\n',
    ),
    "dumper-4": (
        '[position]\nname = "rnz-2m-dumper"\n',
        '[[cut]]\ncar = "gondola-4"\nmass_t = 22\nallowed_stage = 3\ntargets_m_s = [2.0]\n',
    ),
    "dumper-6": (
        '[position]\nname = "rnz-2m-dumper"\n',
        '[[cut]]\ncar = "gondola-6"\nmass_t = 32\nallowed_stage = 3\ntargets_m_s = [2.0]\n',
    ),
}
"""Position and cut of each site. At the park position brake power for 85 t ends at about 4.5 m/s. Cars behind a dumper
may be given stage 3: with oil it brakes no harder than stage 2 does without."""


@dataclass(frozen=True)
class Site:
    """One class of cuts at a position, with its aim; `config`: the configuration that tables are made with."""

    name: str
    config: ResolvedConfig
    plant: Plant
    aim: Aim

    @property
    def target_m_s(self) -> float:
        """Commanded exit speed."""
        return self.aim.target_speed_m_s

    @property
    def title(self) -> str:
        """'bunch, 52 t to 3 m/s'."""
        kind, _, _ = self.name.partition("-")
        axles = f" on {self.plant.cut.axles} axles" if kind == "dumper" else ""
        return f"{kind}, {self.plant.cut.mass_t:g} t{axles} to {self.target_m_s:g} m/s"


def sites(names: Sequence[str]) -> tuple[Site, ...]:
    """The sites of these names. Raises `InputError`."""
    return tuple(site_of(name) for name in names)


def site_of(name: str) -> Site:
    """The site `name`; its configuration has the grid of a tune. Raises `InputError`."""
    if name not in TEXTS:
        raise InputError(f"study point-sensors: there is no case {name!r}; {near_miss(name, TEXTS)}")
    config = parse_config("".join(TEXTS[name]), name)
    ((label, plant),) = config.plants()
    (target,) = config.targets_of(label)
    return Site(name, config, plant, Aim(target, config.criterion))


def single_stage(site: Site, pressure_kpa: float) -> Site:
    """The same site where the brake has one stage besides the released one, so that no command passes over a stage."""
    position = replace(site.plant.position, stage_pressures_kpa=(0.0, pressure_kpa))
    return replace(site, plant=replace(site.plant, position=position))
