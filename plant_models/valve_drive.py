"""The pneumatic drive commanded at any moment: from any pressure, with a valve open, shut or about to open.

`Pneumatics.respond` tells the pressure after a command given at rest. Here a command may also come during a
transient. The valves are those of zhukovitsky-2012, and one thing is assumed beyond it: a valve's delay starts with the
command that asks for this direction of flow. So a command that asks for the same direction (one stage further)
changes only where the flow ends: an open valve stays open, a valve that is about to open opens when it would have. A
command that asks for the other direction shuts the open valve at once and pays the whole delay of the other one;
between the two the pressure stands still.

When a valve opens is said here alone: `Pneumatics.respond` asks `wait_after_command`. How the pressure flows then is
written twice, as one step of numbers here and as the pieces of a whole history there, because a kernel cannot compile
the history and its numpy would round the step otherwise; the tests hold the two to 1e-9 of each other.

The functions are plain arithmetic on numbers, so that a kernel can compile them as they are.
"""

from __future__ import annotations

import math
from typing import NamedTuple


class ValveDrive(NamedTuple):
    """Constants of the drive, kPa gauge and s; `touch_kpa` P0, the pressure at which the pads touch."""

    supply_kpa: float
    exhaust_kpa: float
    brake_delay_s: float
    touch_delay_s: float
    release_delay_s: float
    fill_s: float
    exhaust_s: float
    band_kpa: float
    touch_kpa: float


def wait_after_command(pressure_kpa: float, wait_s: float, old_kpa: float, new_kpa: float, drive: ValveDrive) -> float:
    """Time until the valve that `new_kpa` needs opens; 0 where it is open, or where none is needed.

    `wait_s`: the same for the commanded pressure `old_kpa` that the command replaces.
    """
    band = drive.band_kpa * (1.0 + 1e-12)
    old, new = old_kpa - pressure_kpa, new_kpa - pressure_kpa
    if abs(new) <= band:
        return 0.0
    if abs(old) > band and (old > 0.0) == (new > 0.0):
        return wait_s
    if new > 0.0:
        return drive.brake_delay_s + (drive.touch_delay_s if pressure_kpa <= drive.touch_kpa else 0.0)
    return drive.release_delay_s


def drive_on(
    pressure_kpa: float, wait_s: float, stage_kpa: float, duration_s: float, drive: ValveDrive
) -> tuple[float, float, float]:
    """(pressure, remaining wait, ∫max(0, P − P0)dt in kPa·s) after `duration_s` with `stage_kpa` commanded throughout.

    Closed form: wait, then an exponential until the edge of the dead band, then rest.
    """
    over = max(0.0, pressure_kpa - drive.touch_kpa) * duration_s
    error = stage_kpa - pressure_kpa
    if abs(error) <= drive.band_kpa * (1.0 + 1e-12):
        return pressure_kpa, 0.0, over
    if wait_s >= duration_s:
        return pressure_kpa, wait_s - duration_s, over
    if error > 0.0:
        asymptote, constant, until = drive.supply_kpa, drive.fill_s, stage_kpa - drive.band_kpa
    else:
        asymptote, constant, until = drive.exhaust_kpa, drive.exhaust_s, stage_kpa + drive.band_kpa
    flowing = duration_s - wait_s
    end = asymptote + (pressure_kpa - asymptote) * math.exp(-flowing / constant)
    rests = end >= until if error > 0.0 else end <= until
    if rests:
        flowing = min(constant * math.log((asymptote - pressure_kpa) / (asymptote - until)), flowing)
        end = until
    # Of dp/dt = (asymptote − p)/constant the integral over the time in which p is above the touch pressure.
    a, b, e = asymptote - drive.touch_kpa, pressure_kpa - drive.touch_kpa, end - drive.touch_kpa
    above = flowing
    if b <= 0.0 and e <= 0.0:
        above = 0.0
    elif b < 0.0:
        above -= constant * math.log((a - b) / a)
    elif e < 0.0:
        above = constant * math.log((a - b) / a)
    over = max(0.0, b) * wait_s + a * above + constant * (max(0.0, b) - max(0.0, e))
    if rests:
        over += max(0.0, e) * (duration_s - wait_s - flowing)
    return end, 0.0, over
