"""The exported table of surfaces, as the closed loop runs it."""

from plant_models import Plant
from synth.simulation.closed_loop import TableController
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.tabulate import UNPREDICTED, tabulate
from tuning_tables import Estimator, Generator

ORIGIN = Generator("test", "0", "0" * 64), "surfaces", "2026-01-01T00:00:00Z"


def tabled(
    plant: Plant, surfaces: PolynomialSurfaces, estimator: Estimator | None = None, gauge_factor: float = 1.0
) -> TableController:
    """A regulator with the table of `surfaces`."""
    return TableController(tabulate(plant, surfaces, 3.0, UNPREDICTED, *ORIGIN, estimator), gauge_factor)
