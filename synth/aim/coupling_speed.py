"""How fast cars may couple unless a yard says otherwise; alone, for declarations need nothing that is heavy."""

from __future__ import annotations

from typing import Final

COUPLING_SPEED_M_S: Final = 5.0 / 3.6
"""5 km/h, the highest speed at which cars may couple ([braking-position])."""
