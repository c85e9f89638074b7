"""What a configuration file may contain: one frozen model a section, units in the key names.

Only the keys that a file sets replace the library's values, so everything that the library knows is
optional here. Physical limits are the plant's own (`PlantError`); limits of the numerical settings are
here. `synth.configuration.config_file` turns every fault into one sentence.
"""

from __future__ import annotations

import math
from typing import Any

from pydantic import BaseModel, ConfigDict, Field

from plant_models.errors import require
from plant_models.library import Value
from synth.configuration.value_forms import Grade, Numbers, Pairs, Title
from synth.problem.criterion import Criterion
from synth.problem.requirement import FrictionRange, OverspeedLimit, Requirement
from synth.problem.resolution import Resolution
from synth.problem.terminal_cost import AsymmetricSquare, SquaredError

DEFAULT_RETARDER = "knp-5-bunch"


def setting(default: float, unit: str, low: float, high: float, meaning: str) -> Any:
    """A numerical setting with its unit, its limits (both allowed) and what it means."""
    return Field(default, ge=low, le=high, description=meaning, json_schema_extra={"unit": unit})


class Section(BaseModel):
    """A table of the file: unknown keys, wrong types, inf and nan are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


class ForceSettings(Section):
    """Replaces values of the library's force law; the slope's key depends on the law."""

    slope_kn_per_kpa: float | None = None
    slope_kn_per_kpa_per_t: float | None = None
    touch_pressure_kpa: float | None = None
    slope_factor_by_axles: Numbers | None = None


class PneumaticsSettings(Section):
    """Replaces values of the library's pneumatics."""

    supply_pressure_kpa: float | None = None
    exhaust_pressure_kpa: float | None = None
    brake_delay_s: float | None = None
    touch_delay_s: float | None = None
    release_delay_s: float | None = None
    fill_time_constant_s: float | None = None
    exhaust_time_constant_s: float | None = None
    dead_band_kpa: float | None = None
    closing_delay_s: float | None = None


class RetarderSettings(Section):
    """The library's retarder position, and what is different here."""

    name: str = DEFAULT_RETARDER
    zones_m: Pairs | None = None
    stage_pressures_kpa: Numbers | None = None
    max_entry_speed_m_s: float | None = None
    force: ForceSettings = ForceSettings()
    pneumatics: PneumaticsSettings = PneumaticsSettings()


class TrackSettings(Section):
    """One grade, or pairs (start in m, grade in permille); downhill positive."""

    grade_permille: Grade | None = None


class EntrySettings(Section):
    """Entry speeds are uniform between the two."""

    low_m_s: float | None = None
    high_m_s: float | None = None


class FrictionSettings(Section):
    """Replaces values of the library's friction model."""

    common_cv: float | None = None
    axle_cv: float | None = None
    path_std: float | None = None
    correlation_length_m: float | None = None
    floor: float | None = None


class SensorSettings(Section):
    """Replaces values of the library's Doppler sensor."""

    noise_m_s: float | None = None
    resolution_m_s: float | None = None
    sample_period_s: float | None = None
    computing_delay_s: float | None = None


class TargetSettings(Section):
    """Commanded exit speeds; every cut class is tuned for each."""

    exit_speeds_m_s: Numbers | None = None


class RollingResistanceSettings(Section):
    """Replaces values of the weight category."""

    mean_n_per_kn: float | None = None
    std_n_per_kn: float | None = None


class CutSettings(Section):
    """A cut class: `cars` equal cars of the library that together weigh `mass_t`."""

    label: str | None = Field(None, pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]{0,60}$")
    car: str
    cars: int = Field(1, ge=1, le=60)
    mass_t: float
    category: str | None = None
    allowed_stage: int | None = None
    rolling_resistance: RollingResistanceSettings = RollingResistanceSettings()


DEFAULT_CUTS = tuple(CutSettings(car="gondola-4", mass_t=mass_t) for mass_t in (22.0, 36.0, 52.0, 66.0, 85.0))
"""One gondola for each weight category."""


class GridSettings(Section):
    """Discretisation of the dynamic programme."""

    path_step_m: float = setting(0.5, "m", 0.02, 5.0, "path quantum, rounded so that whole quanta fill S_exit")
    speed_step_m_s: float = setting(0.03, "m/s", 0.002, 0.2, "step of the speed grid")
    transient_step_s: float = setting(0.05, "s", 0.002, 0.2, "longest time step within a change of stage")
    friction_scenarios: int = setting(4, "1", 1, 15, "Gauss–Hermite nodes of the friction of a cut")
    path_levels: int = setting(2, "1", 1, 9, "levels of the friction that varies along the path")
    resistance_scenarios: int = setting(1, "1", 1, 15, "Gauss nodes of the running resistance of a cut")

    def resolution(self, sample_period_s: float) -> Resolution:
        """The same for the solver, which cuts a sampling period of `sample_period_s` into equal parts."""
        return Resolution(
            path_step_m=self.path_step_m,
            speed_step_m_s=self.speed_step_m_s,
            transient_substeps=min(64, max(1, math.ceil(sample_period_s / self.transient_step_s - 1e-9))),
            friction_nodes=self.friction_scenarios,
            path_levels=self.path_levels,
            resistance_nodes=self.resistance_scenarios,
        )


class FitSettings(Section):
    """Smoothing of the switching lines."""

    degree: int = setting(3, "1", 1, 6, "degree of the polynomials of the switching lines")


class RegulatorSettings(Section):
    """What the regulator on the track computes besides the rule."""

    estimator: bool = Field(False, description="compare an estimated speed with the lines: tables of version 2")


class CriterionSettings(Section):
    """Cost of a pass; the last five keys choose another criterion than the mean squared exit-speed error."""

    stall_cost_m2_s2: float = setting(
        Criterion.stall_cost_m2_s2, "m2/s2", 0.0, 1e4, "cost of a cut that stops in the position"
    )
    switching_tolerance_m2_s2: float = setting(
        Criterion.switching_tolerance_m2_s2, "m2/s2", 0.0, 1.0, "a change of stage must gain more than this"
    )
    overspeed_factor: float = setting(
        1.0, "1", 1.0, 1000.0, "asymmetric cost: a squared error above the target weighs this much; 1: as one below"
    )
    p_overspeed: float = setting(
        1.0, "1", 1e-4, 1.0, "chance constraint: highest P(exit > target + overspeed_margin_m_s); 1: none"
    )
    overspeed_margin_m_s: float = setting(0.1, "m/s", 0.01, 5.0, "margin of the chance constraint p_overspeed")
    worst_friction_low: float = setting(
        1.0, "1", 0.05, 5.0, "worst case: lowest friction factor of the range whose worst counts; both 1: the mean does"
    )
    worst_friction_high: float = setting(1.0, "1", 0.05, 5.0, "worst case: highest friction factor of that range")

    def criterion(self) -> Criterion:
        """The same for the solver; `PlantError` where two of the three other criteria are asked for at once."""
        worst = (self.worst_friction_low, self.worst_friction_high) != (1.0, 1.0)
        asked = [
            name
            for name, wanted in (
                (f"overspeed_factor is {self.overspeed_factor:g}", self.overspeed_factor != 1.0),
                (f"p_overspeed is {self.p_overspeed:g}", self.p_overspeed != 1.0),
                (f"worst_friction_low is {self.worst_friction_low:g}", worst),
            )
            if wanted
        ]
        require(
            len(asked) <= 1,
            f"criterion: {' and '.join(asked)}, but only one of asymmetric cost, chance constraint and worst case can "
            "be in force: set the others back to 1",
        )
        requirement: Requirement | None = None
        if self.p_overspeed != 1.0:
            requirement = OverspeedLimit(self.overspeed_margin_m_s, self.p_overspeed)
        elif worst:
            requirement = FrictionRange(self.worst_friction_low, self.worst_friction_high)
        return Criterion(
            stall_cost_m2_s2=self.stall_cost_m2_s2,
            switching_tolerance_m2_s2=self.switching_tolerance_m2_s2,
            terminal=SquaredError() if self.overspeed_factor == 1.0 else AsymmetricSquare(self.overspeed_factor),
            requirement=requirement,
        )


class ValidationSettings(Section):
    """Closed-loop Monte Carlo of the exported tables."""

    passes: int = setting(20_000, "1", 1_000, 50_000, "stratified passes of each table; validate --passes takes more")
    seed: int = setting(20261120, "1", 0, 2**53, "seed of the random streams")


class AcceptanceSettings(Section):
    """Limits that a table must keep; exit code 1 if one does not."""

    rms_m_s: float = setting(
        0.10, "m/s", 0.001, 5.0, "highest rms exit-speed error; 0.15 to 0.2 in [hump-computer-1970s]"
    )
    overspeed_margin_m_s: float = setting(0.3, "m/s", 0.01, 5.0, "an exit is over-speed beyond target + margin")
    p_overspeed: float = setting(0.05, "1", 0.0, 1.0, "highest probability of an over-speed exit")
    p_stall: float = setting(0.01, "1", 0.0, 1.0, "highest probability of a stop in the position")
    honesty_low: float = setting(0.9, "1", 0.0, 1.0, "lowest predicted rms / simulated rms")
    honesty_high: float = setting(1.1, "1", 1.0, 100.0, "highest predicted rms / simulated rms")


class OutputSettings(Section):
    """What is written besides the book and the JSON tables; changes no result and no hash."""

    csv: bool = Field(False, description="also write the tables as CSV")
    plots: bool = Field(True, description="draw the pictures")
    report: bool = Field(True, description="write report.html")


class Settings(Section):
    """A whole configuration file; an empty one is the built-in default."""

    title: Title | None = None
    retarder: RetarderSettings = RetarderSettings()
    track: TrackSettings = TrackSettings()
    entry: EntrySettings = EntrySettings()
    friction: FrictionSettings = FrictionSettings()
    sensor: SensorSettings = SensorSettings()
    targets: TargetSettings = TargetSettings()
    cut: tuple[CutSettings, ...] = Field(DEFAULT_CUTS, min_length=1, max_length=1000, strict=False)
    grid: GridSettings = GridSettings()
    fit: FitSettings = FitSettings()
    regulator: RegulatorSettings = RegulatorSettings()
    criterion: CriterionSettings = CriterionSettings()
    validation: ValidationSettings = ValidationSettings()
    acceptance: AcceptanceSettings = AcceptanceSettings()
    output: OutputSettings = OutputSettings()

    def library_overrides(self) -> dict[str, Value]:
        """Set values by the dotted keys of the library's retarder files."""
        sections = {"retarder", "track", "entry", "friction", "sensor", "targets"}
        tree = self.model_dump(include=sections, exclude={"retarder": {"name"}}, exclude_none=True)
        return dict(dotted(tree, ""))


NUMERICAL_SECTIONS = ("grid", "fit", "criterion", "validation", "acceptance")
"""Sections made of `setting`s alone."""


def dotted(tree: dict[str, Any], prefix: str) -> list[tuple[str, Any]]:
    """(dotted key, value) of every leaf of nested tables."""
    flat: list[tuple[str, Any]] = []
    for name, item in tree.items():
        flat += dotted(item, f"{prefix}{name}.") if isinstance(item, dict) else [(prefix + name, item)]
    return flat
