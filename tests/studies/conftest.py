"""The plants of the tests of `synth`."""

from tests.synth.conftest import plant_22t, plant_52t, plant_of

__all__ = ["plant_22t", "plant_52t", "plant_of"]
