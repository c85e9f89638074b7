"""Aim tables as C99 source: the rule, the choice, the data, and a self-test with golden aims."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tuning_tables.aim.aim_tables import AimTables
from tuning_tables.aim.golden_aims import GoldenAims, golden_aims
from tuning_tables.c_source import c_texts
from tuning_tables.controller_code.aim_code import aim_code
from tuning_tables.export_prefix import AIM, RETARDER, ExportPrefix
from tuning_tables.self_test_size import FULL, SelfTestSize

VECTORS_FILE: Final = "golden_aims.csv"


def aim_c_files(
    aims: AimTables, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL
) -> Mapping[str, bytes]:
    """The files of the export by name: four of C99, ASCII, and all golden aims as CSV for other languages.

    Equal sets give equal bytes.
    """
    texts = c_texts(aim_code(aims, self_test), prefix.of_kind(AIM))
    return {**texts, prefix.data_file(VECTORS_FILE): aims_csv(aims)}


def aims_csv(aims: AimTables) -> bytes:
    """All golden aims, CR LF: table number and id, cars, the other numbers as bits and as numbers; -1: no answer."""
    head = "table,id,cars,distance_bits,resistance_bits,speed_bits,free_distance_m,resistance_n_per_kn,exit_speed_m_s"
    rows = [head]
    for number, table in enumerate(aims.tables):
        name = '"' + table.id.replace('"', '""') + '"'
        golden = golden_aims(table)
        values = zip(golden.free_distance_m, golden.resistance_n_per_kn, golden.exit_speed_m_s, strict=True)
        for (cars, *bits), told in zip(_bits(golden), values, strict=True):
            fields = [*(f"{each:08x}" for each in bits), *(f"{each:.9g}" for each in told)]
            rows.append(f"{number},{name},{cars},{','.join(fields)}")
    return ("\r\n".join(rows) + "\r\n").encode("utf-8")


def _bits(golden: GoldenAims) -> list[tuple[int, ...]]:
    columns = (golden.free_distance_m, golden.resistance_n_per_kn, golden.exit_speed_m_s)
    return list(zip(golden.cars.tolist(), *(each.view("u4").tolist() for each in columns), strict=True))
