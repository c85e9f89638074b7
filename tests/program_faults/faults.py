"""Twenty faults of the program, one to be planted at a time: where, what stands there, and what is put in its place."""

from __future__ import annotations

from pathlib import Path
from typing import Final, NamedTuple

PACKAGES: Final = ("plant_models", "synth", "tuning_tables")


class ProgramFault(NamedTuple):
    """A fault of a part; `right` stands once in the file."""

    part: str
    file: str
    right: str
    wrong: str

    def plant(self, checkout: Path) -> None:
        """Put it into a copy of the checkout."""
        file = checkout / self.file
        text = file.read_text(encoding="utf-8")
        if text.count(self.right) != 1:
            raise ValueError(f"{self.file}: {self.right!r} does not stand there once")
        file.write_text(text.replace(self.right, self.wrong), encoding="utf-8")


RULES, PLANT, EXPORT = "tuning_tables/programs", "plant_models", "tuning_tables/language"

PLANTED: Final = {
    "rule": (
        (f"{RULES}/decide.py", "if v < lower:", "if v <= lower:"),
        (f"{RULES}/decide.py", "stage < table.entrance_stage", "stage <= table.entrance_stage"),
        (f"{RULES}/decide.py", "pressure - table.pressure_kpa[stage]", "pressure - table.pressure_kpa[0]"),
        (f"{RULES}/decide.py", "answer + before == 0", "answer - before == 0"),
        (f"{RULES}/choose.py", "if target <= commanded_m_s:", "if target < commanded_m_s:"),
        (f"{RULES}/observe.py", "GATE: Final = 5.0", "GATE: Final = 50.0"),
    ),
    "plant": (
        (f"{PLANT}/cut.py", "ROTATING_MASS_PER_AXLE_T = 0.42", "ROTATING_MASS_PER_AXLE_T = 0.24"),
        (f"{PLANT}/motion.py", "slope[axles] / cut.inertia_t", "slope[axles] / cut.mass_t"),
        (f"{PLANT}/motion.py", "(axle < end)", "(axle < end - 1.0)"),
        (f"{PLANT}/pneumatics.py", "target_kpa - sign * drive.band_kpa", "target_kpa"),
        (f"{PLANT}/valve_drive.py", "if pressure_kpa <= drive.touch_kpa else 0.0)", "if pressure_kpa < 0.0 else 0.0)"),
        (f"{PLANT}/friction.py", "np.sqrt(np.tanh(x) / x)", "np.tanh(x) / x"),
    ),
    "prediction": (
        ("synth/solver/exit_density.py", "first - self.stalled * target_speed_m_s", "first"),
        ("synth/problem/problem.py", "OVERSPEED_M_S = 0.3", "OVERSPEED_M_S = 0.4"),
        ("synth/solver/tabulate.py", "rms_m_s=density.rms_m_s(", "rms_m_s=0.9 * density.rms_m_s("),
        ("synth/simulation/closed_loop.py", "self.plant.sensor.computing_delay_s,", "0.0,"),
    ),
    "exporter": (
        (f"{EXPORT}/st_data.py", "{float(number):.9E}", "{float(number):.6E}"),
        (f"{EXPORT}/c99_data.py", "float(np.float32(value)).hex()", "float(np.float16(value)).hex()"),
        ("tuning_tables/book_classes.py", "for_cut(other) and interpolable(one, other)", "for_cut(other)"),
        ("tuning_tables/csv_file.py", '["number", key, repr(cells)]', '["number", key, f"{cells:g}"]'),
    ),
}
TESTS: Final = {
    "rule": ("tests/tuning_tables", "tests/controller_code", "tests/checker"),
    "plant": ("tests/plant_models", "tests/oracles", "tests/convergence", "tests/synth", "tests/checker"),
    "prediction": ("tests/oracles", "tests/convergence", "tests/synth", "tests/checker"),
    "exporter": ("tests/tuning_tables", "tests/controller_code", "tests/checker"),
}
"""Folders whose marked tests are about a part."""

FAULTS: Final = tuple(ProgramFault(part, *each) for part, planted in PLANTED.items() for each in planted)
