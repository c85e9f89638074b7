"""Aim tables as C99 source: the rule, the choice, the data, and a self-test with golden aims.

The C text itself is in `c99/aim_*.in` and in the parts that it shares with controller tables; here its blanks are
filled. Numbers are hexadecimal floats, which every C99 compiler reads exactly; the checksum of each table proves it.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.aim_tables import AimTables
from tuning_tables.aim.block import AimBlockSize, aim_block, aim_block_size
from tuning_tables.aim.golden_aims import GoldenAims, golden_aims, golden_selections
from tuning_tables.aim.names import origin_lines, with_prefix
from tuning_tables.c_literals import hex_float
from tuning_tables.c_template import filled
from tuning_tables.category_names import category_names, comment_text
from tuning_tables.export_prefix import RETARDER, ExportPrefix

TEMPLATES = ("aim_table.h", "aim_table.c", "aim_self_test.h", "aim_self_test.c")
VECTORS_FILE = "golden_aims.csv"

Ask: TypeAlias = Callable[[AimTable], GoldenAims]
"""What a self-test asks of a table."""


def aim_c_files(aims: AimTables, prefix: ExportPrefix = RETARDER, ask: Ask = golden_aims) -> Mapping[str, bytes]:
    """The files of the export by name: four of C99, ASCII, and all golden aims as CSV for other languages.

    `ask`: what the self-test asks. Equal sets give equal bytes.
    """
    blanks = aim_blanks(aims, [ask(table) for table in aims.tables])
    # The parts that are shared with controller tables name them; nothing else here does.
    texts = {name: filled(name, blanks).replace("retarder_", "aim_") for name in TEMPLATES}
    sources = {with_prefix(prefix, name): with_prefix(prefix, text).encode("ascii") for name, text in texts.items()}
    return {**sources, prefix.data_file(VECTORS_FILE): aims_csv(aims)}


def aim_blanks(aims: AimTables, golden: Sequence[GoldenAims]) -> Mapping[str, str]:
    """What the templates ask for, by the names of their blanks."""
    size, selections = aim_block_size(aims), golden_selections(aims)
    return {
        "EXPORT": f"0x{export_tag(aims):08x}u",
        "ORIGIN": "\n".join(f" * {line}" for line in origin_lines(aims)),
        "CATEGORIES": "\n".join(
            f"#define AIM_CATEGORY_{each.macro} {each.number}u /* {comment_text(each.category)} */"
            for each in category_names(aims.exported_numbers())
        ),
        "CARS": f"{size.cars}u",
        "DISTANCES": f"{size.distances}u",
        "RESISTANCES": f"{size.resistances}u",
        "COUNT": f"{len(aims.tables)}",
        "TABLES": ",\n".join(table_text(table, number, size) for number, table in enumerate(aims.tables)),
        "AIMS": f"{sum(map(len, golden))}",
        "SELECTIONS": f"{len(selections)}",
        "GOLDEN_AIMS": ",\n".join(line for number, each in enumerate(golden) for line in aim_lines(number, each)),
        "GOLDEN_SELECTIONS": ",\n".join(
            f"    {{{category}u, {measured:d}, {number if number >= 0 else len(aims.tables)}u}}"
            for category, measured, number in selections
        ),
    }


def export_tag(aims: AimTables) -> int:
    """A number that differs for exports whose files must not be mixed: CRC-32 over categories and all blocks.

    Without the checksums of the blocks: a CRC over content and its own CRC is the same whatever the content is.
    """
    size = aim_block_size(aims)
    content = "\n".join(["aim tables", *aims.exported_numbers()]).encode("utf-8")
    return zlib.crc32(content + b"".join(aim_block(table, size)[:-1].astype("<u4").tobytes() for table in aims.tables))


def table_text(table: AimTable, number: int, size: AimBlockSize) -> str:
    """The initialiser of one table."""
    words = aim_block(table, size)
    floats = words.view(np.float32)
    first = 8 + size.cars
    nodes = floats[size.nodes].reshape(size.cars, size.distances, size.resistances)
    names = ("allowed p", "coupling speed, m/s", "lowest exit speed", "highest")
    return "\n".join(
        [
            f"    /* {number}: {comment_text(table.id)} */",
            "    {",
            f"        {words[0]}u, /* category */",
            f"        {words[1]}u, {words[2]}u, {words[3]}u, /* numbers of cars, free distances, resistances */",
            *(
                f"        {hex_float(value)}, /* {name}, {value:g} */"
                for name, value in zip(names, floats[4:8], strict=True)
            ),
            f"        {{{', '.join(f'{cars}u' for cars in words[8:first])}}},",
            f"        {_row(floats[first : first + size.distances])}, /* m */",
            f"        {_row(floats[first + size.distances : size.nodes.start])}, /* N/kN */",
            "        {",
            ",\n".join(_cars_text(cars, rows) for cars, rows in zip(words[8:first].tolist(), nodes, strict=True)),
            "        },",
            f"        0x{words[-1]:08x}u /* crc32 */",
            "    }",
        ]
    )


def _cars_text(cars: int, rows: npt.NDArray[np.float32]) -> str:
    """The exit speeds for one number of cars, a free distance a line."""
    lines = ",\n".join(f"                {_row(row)}" for row in rows)
    return f"            {{ /* {cars} cars */\n{lines}\n            }}"


def _row(values: npt.NDArray[np.float32]) -> str:
    return "{" + ", ".join(map(hex_float, values)) + "}"


def aim_lines(number: int, golden: GoldenAims) -> list[str]:
    """The golden aims of table `number` as initialisers; cars that an `int` of 16 bits holds."""
    return [
        f"    {{{number}u, {cars}, 0x{distance:08x}u, 0x{resistance:08x}u, 0x{speed:08x}u}}"
        for cars, distance, resistance, speed in _bits(golden)
    ]


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
    return list(zip(golden.cars.tolist(), *(each.view(np.uint32).tolist() for each in columns), strict=True))
