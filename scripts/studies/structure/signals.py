"""What the signals of the block diagrams are: meaning and unit, by symbol."""

from __future__ import annotations

from typing import Final

SIGNALS: Final[dict[str, tuple[str, str]]] = {
    "S": ("path of the first axle", "m"),
    "V": ("speed of the cut", "m/s"),
    "F⁻¹(S)": ("time at which a place of the path is reached", "s"),
    "S[n]": ("path at a sample", "m"),
    "V[n]": ("speed at a sample", "m/s"),
    "t_V[n]": ("time from the first coil of a sensor to the second", "s"),
    "m[n]": ("number of the sensor", "1"),
    "Δt[n]": ("time since the pulse pair before", "s"),
    "z": ("noise of the radar or of the timer, in standard deviations", "1"),
    "z_b": ("error of the base of a sensor, in standard deviations", "1"),
    "S*[n]": ("path as the rule takes it; with point sensors the number of the passage", "m or 1"),
    "V*[n]": ("measured speed", "m/s"),
    "locked": ("the transient has not ended", "1"),
    "D[n]": ("stage that the controller wants", "1"),
    "U[n]": ("stage commanded", "1"),
    "U_τ[n]": ("stage commanded, after the computing delay", "1"),
    "U*[n]": ("impulses, their areas the signals of stages", "kPa"),
    "U_k": ("signal of the stage in force", "kPa"),
    "U_P": ("signal of the pressure", "kPa"),
    "ε_U": ("mismatch", "kPa"),
    "sgn ε_U": ("its sign, 0 in the dead zone", "1"),
    "P_in, T": ("pressure that the drive is to be connected to, and its time constant", "kPa, s"),
    "P_v, T": ("the same behind the valve", "kPa, s"),
    "τ(P)": ("delay of the valve", "s"),
    "P": ("pressure in the cylinders, gauge", "kPa"),
    "p": ("pressure above the touch of the pads", "kPa"),
    "ξ_cut": ("friction factor of the cut", "1"),
    "η": ("friction along the path", "1"),
    "B(S)": ("slope of the pads: deceleration by one kPa", "m/s² per kPa"),
}
"""(meaning, unit) of every signal that a wire carries."""
