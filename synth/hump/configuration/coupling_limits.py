"""From which speed on couplings are too fast, and how bad they are: by the practice of a yard."""

from __future__ import annotations

from pydantic import model_validator

from plant_models.errors import require
from synth.aim.coupling_speed import COUPLING_SPEED_M_S
from synth.frame.settings.section import Section, setting

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
