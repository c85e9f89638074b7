"""What a configuration file may contain: one frozen model a section, units in the key names.

What it says of the plant is in `plant_settings`; limits of the numerical settings are here.
`synth.retarder.configuration.config_file` turns every fault into one sentence.
"""

from __future__ import annotations

import math
from typing import Literal

from pydantic import Field, model_validator

from plant_models import Plant
from plant_models.errors import require
from plant_models.library import Value
from synth.frame.settings.numbers import Source, library_values
from synth.frame.settings.section import OutputSettings, Section, choice, many, of_library, setting
from synth.problem.criterion import AsymmetricSquare, Criterion, SquaredError
from synth.problem.requirement import FrictionRange, OverspeedLimit, Requirement
from synth.problem.resolution import LONG_PASS_M, Resolution
from synth.retarder.configuration.own_types import TopKeys
from synth.retarder.configuration.plant_settings import (
    DEFAULT_CUTS,
    CutSettings,
    EntrySettings,
    FrictionSettings,
    PointSensorSettings,
    PositionSettings,
    RetarderSettings,
    SensorSettings,
    TargetSettings,
    TrackSettings,
)


class GridSettings(Section):
    """Discretisation of the dynamic programme."""

    path_step_m: float = setting(
        0.5,
        "m",
        0.02,
        5.0,
        "path quantum, rounded so that whole quanta fill S_exit; "
        f"in passes of more than {LONG_PASS_M:g} m longer, in proportion",
    )
    speed_step_m_s: float = setting(0.03, "m/s", 0.002, 0.2, "step of the speed grid")
    transient_step_s: float = setting(0.05, "s", 0.002, 0.2, "longest time step within a change of stage")
    friction_scenarios: int = setting(6, "1", 1, 15, "Gauss–Hermite nodes of the friction of a cut")
    path_levels: int = setting(2, "1", 1, 9, "levels of the friction that varies along the path")
    resistance_scenarios: int = setting(3, "1", 1, 15, "Gauss nodes of the running resistance of a cut")

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

    def resolution_for(self, plant: Plant) -> Resolution:
        """The same for one plant, with the transients of its sensor's sampling period and quanta for its pass."""
        return self.resolution(plant.sensor.sample_period_s).for_pass(plant.pass_m)


class FitSettings(Section):
    """Smoothing of the switching lines."""

    degree: int = setting(3, "1", 1, 6, "degree of the polynomials of the switching lines")


class RegulatorSettings(Section):
    """Where the regulator on the track acts, and what it computes besides the rule."""

    approach_m: float | None = of_library("from how far before the entrance it acts")
    initial_stage: int | None = of_library("stage that is left from the cut ahead")
    estimator: bool = choice(True, "compare an estimated speed with the lines; false for the smallest controllers")
    commands: Literal["at_rest", "any_time"] = choice(
        "at_rest", "a command only when the last one is carried out, or at every sample"
    )
    pressure: Literal["gauge", "none"] = choice(
        "gauge", "with commands at any time: whether the regulator measures the pressure"
    )

    @property
    def at_any_time(self) -> bool:
        """Whether it may give a command at every sample."""
        return self.commands == "any_time"

    @property
    def has_gauge(self) -> bool:
        """Whether its lines may depend on the pressure."""
        return self.at_any_time and self.pressure == "gauge"


class CriterionSettings(Section):
    """Cost of a pass; the last five keys choose another criterion than the mean squared exit-speed error."""

    stall_cost_m2_s2: float = setting(
        Criterion.stall_cost_m2_s2, "m2/s2", 0.0, 1e4, "cost of a cut that stops in the position"
    )
    switching_tolerance_m2_s2: float = setting(
        Criterion.switching_tolerance_m2_s2, "m2/s2", 0.0, 1.0, "a change of stage must gain more than this"
    )
    time_price_m2_s3: float = setting(
        Criterion.time_price_m2_s3, "m2/s3", 0.0, 1.0, "cost of a second between where the regulator acts and the exit"
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

    @model_validator(mode="after")
    def _one_of_three(self) -> CriterionSettings:
        asked = [
            name
            for name, wanted in (
                (f"overspeed_factor is {self.overspeed_factor:g}", self.overspeed_factor != 1.0),
                (f"p_overspeed is {self.p_overspeed:g}", self.p_overspeed != 1.0),
                (f"worst_friction_low is {self.worst_friction_low:g}", self.has_worst_case),
            )
            if wanted
        ]
        require(
            len(asked) <= 1,
            f"{' and '.join(asked)}, but only one of asymmetric cost, chance constraint and worst case can be in "
            "force: set the others back to 1",
        )
        return self

    @property
    def has_worst_case(self) -> bool:
        """Whether the worst friction of a range counts."""
        return (self.worst_friction_low, self.worst_friction_high) != (1.0, 1.0)

    def criterion(self) -> Criterion:
        """The same for the solver; `PlantError` for a range of friction that is none."""
        requirement: Requirement | None = None
        if self.p_overspeed != 1.0:
            requirement = OverspeedLimit(self.overspeed_margin_m_s, self.p_overspeed)
        elif self.has_worst_case:
            requirement = FrictionRange(self.worst_friction_low, self.worst_friction_high)
        return Criterion(
            stall_cost_m2_s2=self.stall_cost_m2_s2,
            switching_tolerance_m2_s2=self.switching_tolerance_m2_s2,
            time_price_m2_s3=self.time_price_m2_s3,
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
    time_s: float = setting(600.0, "s", 0.1, 600.0, "highest mean time from where the regulator acts to the exit")
    switchings: float = setting(1000.0, "1", 0.0, 1000.0, "highest mean number of commands a cut")
    prediction_ratio_low: float = setting(0.9, "1", 0.0, 1.0, "lowest predicted rms / simulated rms")
    prediction_ratio_high: float = setting(1.1, "1", 1.0, 100.0, "highest predicted rms / simulated rms")


class TuneOutputSettings(OutputSettings):
    """What is written besides the book and the JSON tables; changes no result and no hash."""

    csv: bool = choice(False, "also write the tables as CSV")


class Settings(TopKeys):
    """A whole configuration file; an empty one is the built-in default."""

    sources: dict[str, Source] = Field(
        default_factory=dict,
        description="where numbers that this file changes are from, by their keys",
        examples=[{"sensor.noise_m_s": "measured in our yard, 2026"}],
    )
    position: PositionSettings = PositionSettings()
    retarder: RetarderSettings = RetarderSettings()
    track: TrackSettings = TrackSettings()
    entry: EntrySettings = EntrySettings()
    friction: FrictionSettings = FrictionSettings()
    sensor: SensorSettings = SensorSettings()
    sensors: PointSensorSettings | None = choice(
        None, "point sensors in place of the radar; 'init point-sensors' has them"
    )
    targets: TargetSettings = TargetSettings()
    cut: tuple[CutSettings, ...] = many(DEFAULT_CUTS, 1, 1000, "[[cut]] tables")
    grid: GridSettings = GridSettings()
    fit: FitSettings = FitSettings()
    regulator: RegulatorSettings = RegulatorSettings()
    criterion: CriterionSettings = CriterionSettings()
    validation: ValidationSettings = ValidationSettings()
    acceptance: AcceptanceSettings = AcceptanceSettings()
    output: TuneOutputSettings = TuneOutputSettings()

    def library_overrides(self) -> dict[str, Value]:
        """Set values by the dotted keys of the library's positions."""
        sections = ("retarder", "track", "entry", "friction", "sensor", "regulator", "targets")
        return {key: value for name in sections for key, value in library_values(getattr(self, name), name)}


NUMERICAL_SECTIONS = ("grid", "fit", "criterion", "validation", "acceptance")
"""Sections made of `setting`s alone."""
