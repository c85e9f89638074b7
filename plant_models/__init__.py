"""The plant: cars, retarders, pneumatics, friction, sensors and motion, in SI, without solver words."""

from plant_models.cut import Car, Cut, couple
from plant_models.entry_speed import EntryLaw, EntrySpeed, HistogramEntrySpeed, NormalEntrySpeed
from plant_models.errors import PlantError
from plant_models.friction import Friction
from plant_models.motion import PathCoefficients, path_coefficients
from plant_models.plant import Plant
from plant_models.pneumatics import Pneumatics, PressureHistory
from plant_models.point_sensors import PointSensors, every_axle, first_axle
from plant_models.retarder import PressingForce, RetarderPosition, WeightForce
from plant_models.rolling_resistance import RollingResistance
from plant_models.speed_sensor import DopplerSensor
from plant_models.track_profile import Approach, TrackProfile

__all__ = [
    "Approach",
    "Car",
    "Cut",
    "DopplerSensor",
    "EntryLaw",
    "EntrySpeed",
    "Friction",
    "HistogramEntrySpeed",
    "NormalEntrySpeed",
    "PathCoefficients",
    "Plant",
    "PlantError",
    "Pneumatics",
    "PointSensors",
    "PressingForce",
    "PressureHistory",
    "RetarderPosition",
    "RollingResistance",
    "TrackProfile",
    "WeightForce",
    "couple",
    "every_axle",
    "first_axle",
    "path_coefficients",
]


def __dir__() -> list[str]:
    return __all__
