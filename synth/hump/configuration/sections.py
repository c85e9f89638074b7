"""Sections of a hump trial configuration that others use by themselves: from which speed on couplings are too fast, the
runners of the design test and what it asks, and what may be said of a position.
"""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Final, Literal

from pydantic import BeforeValidator, Field, model_validator

from plant_models.errors import require
from plant_models.library.sourced_value import JUDGEMENT
from synth.aim.configuration.shared_settings import COUPLING_SPEED_M_S
from synth.frame.settings.section import Section, choice, many, needed, optional, setting

IN_CLASSES = "[hump-computer-1970s]: over-speeds are told up to 1.5, up to 2 m/s, and faster"


class CouplingLimits(Section):
    """Coupling speeds: what is too fast, and in which classes that is told. Cuts are aimed at the allowed speed."""

    allowed_m_s: float = setting(
        COUPLING_SPEED_M_S, "m/s", 0.3, 5.0, "highest allowed one; faster is over-speed", "[braking-position]: 5 km/h"
    )
    rough_m_s: float = setting(1.5, "m/s", 0.3, 6.0, "over-speed above this is rough", IN_CLASSES)
    harmful_m_s: float = setting(2.0, "m/s", 0.3, 7.0, "over-speed above this is harmful", IN_CLASSES)

    @model_validator(mode="after")
    def _rising(self) -> CouplingLimits:
        low, middle, high = self.classes_m_s
        require(
            low < middle < high,
            f"allowed_m_s is {low:g}; it must be less than rough_m_s, {middle:g}, and that less than harmful_m_s, "
            f"{high:g}",
        )
        return self

    @property
    def classes_m_s(self) -> tuple[float, float, float]:
        """Where each class of over-speeds begins."""
        return self.allowed_m_s, self.rough_m_s, self.harmful_m_s


NO_TABLE: Final = f"{JUDGEMENT}: no table of the runners that humps are designed for was found"


class DesignSettings(Section):
    """The design test: single cars, a bad runner ahead of a good one ahead of a bad one, and a very good one that the
    brakes must hold."""

    hump_speed_m_s: float = setting(
        1.7, "m/s", 0.3, 4.0, "speed at which the cars are pushed over the crest",
        f"{JUDGEMENT}: 0.8 of a small hump to 1.7 of a very large one are usual",
    )  # fmt: skip
    bad_mass_t: float = setting(22.0, "t", 10.0, 100.0, "mass of the bad runner", NO_TABLE)
    bad_n_per_kn: float = setting(4.0, "N/kN", 0.2, 15.0, "its resistance at standstill on straight track", NO_TABLE)
    bad_head_wind_m_s: float = setting(2.0, "m/s", -15.0, 15.0, "wind against it", NO_TABLE)
    good_mass_t: float = setting(70.0, "t", 10.0, 100.0, "mass of the good runner", NO_TABLE)
    good_n_per_kn: float = setting(0.8, "N/kN", 0.2, 15.0, "its resistance", NO_TABLE)
    good_head_wind_m_s: float = setting(0.0, "m/s", -15.0, 15.0, "wind against it; below 0: from behind", NO_TABLE)
    very_good_mass_t: float = setting(
        85.0, "t", 10.0, 100.0, "mass of the very good runner, which the brakes must hold",
        "[runner-types]: a gondola of 85 t",
    )  # fmt: skip
    very_good_n_per_kn: float = setting(
        0.5, "N/kN", 0.2, 15.0, "its resistance; wind as against the good one", NO_TABLE
    )
    into_track_m: float = setting(
        50.0, "m", 0.0, 500.0, "how far into its track the bad runner must roll", "[hump-height]: 50 to 100 m"
    )


EXIT_RANGE_M_S: Final = (4.0, 7.0)
"""Exit speeds of a position that keeps cuts apart, where a file gives none: assumed."""

USUAL_RANGE: Final = f"{JUDGEMENT}: {EXIT_RANGE_M_S[0]:g} to {EXIT_RANGE_M_S[1]:g} m/s are usual of bunch positions"

ALL: Final = "all"
"""Stands for the weight categories that are not named."""

Speed = Annotated[float, Field(ge=0.3, le=12.0)]
"""At a position, m/s."""

RoleName = Literal["spacing", "aim", "fixed"]


def by_category(given: Any) -> Any:
    """Validator: one speed is that of all weight categories."""
    if isinstance(given, int | float) and not isinstance(given, bool):
        return {ALL: given}
    if not isinstance(given, dict):
        raise ValueError("it must be a speed, or a table of speeds by weight category, { L = 5.0, all = 4.8 }")
    return given


class HumpPositionSettings(Section):
    """One position, on every route that has so many. What is left out is as the hump file tells.

    Roles: spacing, exit speeds that keep a cut apart from those ahead and behind; aim, exit speeds for the standing
    cars of the track; fixed, one exit speed for each weight category. Without a role, the last position of a route
    aims, but keeps cuts apart where a switch is behind it; all other positions keep cuts apart.
    """

    MEANT: ClassVar = {"exit_speed_m_s": "exit_m_s", "exit_speed": "exit_m_s", "speed_m_s": "exit_m_s"}

    number: int = needed("1", 1, 10, "which position, 1 being the first behind the crest", "")
    role: RoleName | None = choice(
        None, "what it does with cuts; aim: on routes of which it is the last position", "fixed"
    )
    exit_m_s: Annotated[dict[str, Speed] | None, BeforeValidator(by_category, json_schema_input_type=float | dict)] = (
        many(
            None, 1, 32, "speeds, { L = 5.0, all = 4.8 }",
            "its fixed exit speed: one, or one by weight category, with `all` for those that are not named", "m/s",
            example={"L": 5.0, ALL: 4.8},
        )
    )  # fmt: skip
    lowest_m_s: float | None = optional("m/s", 0.3, 12.0, "lowest exit speed that keeps cuts apart", EXIT_RANGE_M_S[0])
    highest_m_s: float | None = optional("m/s", 0.3, 12.0, "the highest", EXIT_RANGE_M_S[1])
    most_entry_m_s: float | None = optional(
        "m/s", 0.3, 12.0, "fastest that cuts may come to it, unless it aims; left out: no limit", 7.5
    )
    exit_std_m_s: float | None = optional(
        "m/s", 0.0, 1.0, "standard deviation of the exit speed about the commanded one", 0.35
    )
    tables: str | None = choice(
        None,
        "in its place, controller tables (a file, a book or a folder), which run in their closed loop",
        "out/book.h5",
    )
    tables_config: str | None = choice(
        None, "the configuration that it was tuned with; left out: the built-in one", "my.toml"
    )
    out_of_service: bool = choice(False, "whether it brakes nothing")
    supply_share: float | None = optional(
        "1", 0.05, 1.0, "of the full brake power, where the supply pressure is low", 0.8
    )

    @model_validator(mode="after")
    def _one_word_on_its_accuracy(self) -> HumpPositionSettings:
        require(
            self.exit_std_m_s is None or self.tables is None,
            f"exit_std_m_s is {self.exit_std_m_s} and tables is {self.tables!r}; both say how exactly the position "
            "works: leave out one of the two",
        )
        return self

    @model_validator(mode="after")
    def _speeds_of_its_role(self) -> HumpPositionSettings:
        fixed = self.exit_m_s is not None
        require(self.role != "fixed" or fixed, "role is 'fixed'; the speed is missing: add exit_m_s")
        require(
            not fixed or self.role in (None, "fixed"),
            f"exit_m_s fixes the exit speed, but role is {self.role!r}; leave out one of the two",
        )
        for key in ("lowest_m_s", "highest_m_s"):
            value = getattr(self, key)
            require(
                value is None or not (fixed or self.role == "aim"),
                f"{key} is {value}; it is for a position that keeps cuts apart: a fixed speed is exit_m_s, and what "
                f"aims has aim.{key}",
            )
        low, high = self.lowest_m_s, self.highest_m_s
        require(
            low is None or high is None or low <= high, f"lowest_m_s is {low}; it must not be above highest_m_s, {high}"
        )
        return self

    @property
    def role_name(self) -> RoleName | None:
        """The role that is asked for; a fixed speed asks for one."""
        return "fixed" if self.exit_m_s is not None else self.role
