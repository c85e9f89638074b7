"""Where a table comes from and what it is for, as sections of a JSON document, and back."""

from __future__ import annotations

from tuning_tables.provenance import CutId, Generator, RetarderId
from tuning_tables.section import Section


def floats(values: tuple[float, ...]) -> list[float]:
    """The numbers as JSON is to write them: with a decimal point or an exponent."""
    return [float(value) for value in values]


def provenance_document(generator: Generator, retarder: RetarderId, cut: CutId) -> dict[str, object]:
    """The sections "generator", "retarder" and "cut", in this order."""
    return {
        "generator": {
            "name": generator.name,
            "version": generator.version,
            "config_sha256": generator.config_sha256,
        },
        "retarder": {
            "name": retarder.name,
            "zones_m": [floats(zone) for zone in retarder.zones_m],
            "exit_m": float(retarder.exit_m),
            "dead_band_kpa": float(retarder.dead_band_kpa),
        },
        "cut": {
            "category": cut.category,
            **({} if cut.category_number is None else {"category_number": cut.category_number}),
            "mass_t": float(cut.mass_t),
            "axle_offsets_m": floats(cut.axle_offsets_m),
        },
    }


def read_generator(top: Section) -> Generator:
    """The section "generator" of the document; raises `DamagedTable` and `InvalidTable`, as the others here."""
    section = top.section("generator", ("name", "version", "config_sha256"))
    return Generator(section.text("name"), section.text("version"), section.text("config_sha256"))


def read_retarder(top: Section) -> RetarderId:
    """The section "retarder" of the document."""
    section = top.section("retarder", ("name", "zones_m", "exit_m", "dead_band_kpa"))
    return RetarderId(
        section.text("name"), section.pairs("zones_m"), section.number("exit_m"), section.number("dead_band_kpa")
    )


def read_cut(top: Section) -> CutId:
    """The section "cut" of the document."""
    section = top.section("cut", ("category", "mass_t", "axle_offsets_m"), ("category_number",))
    return CutId(
        section.text("category"),
        section.number("mass_t"),
        section.numbers("axle_offsets_m"),
        section.count("category_number") if "category_number" in section else None,
    )
