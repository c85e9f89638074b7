"""What a hump trial configuration may say of a position: its role, its exit speeds, its controller."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Final, Literal

from pydantic import BeforeValidator, Field, model_validator

from plant_models.errors import require
from plant_models.library.sourced_value import JUDGEMENT
from synth.frame.settings.section import Section, choice, many, needed, optional

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
