"""Tables as C99 source: the rule, the estimator, the choice, the data, and a self-test with golden vectors and tracks.

The C text itself is in `c99/*.in`; here its blanks are filled. Numbers are hexadecimal floats, which every C99
compiler reads exactly; the checksum of each table proves that it did.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping, Sequence

import numpy as np

from tuning_tables.c_any_time import any_time_blanks, any_time_text, reading_columns
from tuning_tables.c_estimator import estimator_blanks, estimator_text, track_blanks, tracks_csv
from tuning_tables.c_literals import hex_float
from tuning_tables.c_template import filled
from tuning_tables.category_names import category_names, comment_text
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.golden_choices import GoldenChoice, golden_choices
from tuning_tables.golden_tracks import GoldenTrack, golden_tracks
from tuning_tables.golden_vectors import GoldenVectors, golden_vectors
from tuning_tables.self_test_size import FULL, SelfTestSize
from tuning_tables.table_block import (
    HAS_LOWER,
    HAS_UPPER,
    LAYOUT,
    BlockSize,
    TableBlock,
    approach_m,
    block_of,
    block_size,
)
from tuning_tables.table_book import TableBook

TEMPLATES = ("retarder_table.h", "retarder_table.c", "retarder_self_test.h", "retarder_self_test.c")
VECTORS_FILE = "golden_vectors.csv"
TRACKS_FILE = "golden_tracks.csv"

VECTOR_COLUMNS = "s_bits,v_bits,s_m,v_m_s"
VECTOR_COLUMNS_OF_GAUGE = "s_bits,v_bits,p_bits,s_m,v_m_s,pressure_kpa"


def c_files(book: TableBook, prefix: ExportPrefix = RETARDER, self_test: SelfTestSize = FULL) -> Mapping[str, bytes]:
    """The files of the export by name: four of C99, ASCII, and all golden vectors as CSV for other languages.

    If a table has an estimator, the golden tracks are there as CSV too. Equal books give equal bytes. Raises
    `InvalidTable` for a category without number.
    """
    tracks = golden_tracks(book)
    blanks = c_blanks(book, [self_test.vectors(table) for table in book.tables], tracks)
    sources = {prefix.renamed(name): prefix.renamed(filled(name, blanks)).encode("ascii") for name in TEMPLATES}
    data = {prefix.data_file(VECTORS_FILE): vectors_csv(book, [golden_vectors(table) for table in book.tables])}
    if block_size(book).breaks:
        data[prefix.data_file(TRACKS_FILE)] = tracks_csv(book, tracks)
    return {**sources, **data}


def c_blanks(book: TableBook, vectors: Sequence[GoldenVectors], tracks: Sequence[GoldenTrack]) -> Mapping[str, str]:
    """What the templates ask for, by the names of their blanks."""
    size, choices = block_size(book), golden_choices(book)
    return {
        "LAYOUT": f"{LAYOUT}",
        "EXPORT": f"0x{export_tag(book):08x}u",
        "ORIGIN": "\n".join(f" * {line}" for line in origin_lines(book)),
        "CATEGORIES": "\n".join(category_lines(book)),
        "STAGES": f"{size.stages}u",
        "POWERS": f"{size.powers}u",
        "BREAKS": f"{size.breaks}u",
        "APPROACH": f"{size.approach:d}u",
        "COUNT": f"{len(book.tables)}",
        "TABLES": ",\n".join(table_text(book, number, size) for number in range(len(book.tables))),
        "VECTORS": f"{sum(map(len, vectors))}",
        "CHOICES": f"{len(choices)}",
        "GOLDEN_VECTORS": ",\n".join(line for n, each in enumerate(vectors) for line in vector_lines(n, each, size)),
        "GOLDEN_CHOICES": ",\n".join(map(choice_line, choices)),
        **any_time_blanks(book, size),
        **track_blanks(book, tracks),
        **estimator_blanks(),
    }


def export_tag(book: TableBook) -> int:
    """A number that differs for exports whose files must not be mixed: CRC-32 over layout, categories, all blocks.

    Without the checksums of the blocks: a CRC over content and its own CRC is the same whatever the content is.
    """
    content = "\n".join([f"layout {LAYOUT}", *book.category_numbers]).encode("utf-8")
    size = block_size(book)
    for number in range(len(book.tables)):
        content += block_of(book, number, size=size).words[:-1].astype("<u4").tobytes()
    return zlib.crc32(content)


def origin_lines(book: TableBook) -> list[str]:
    """What the book is for and where it comes from, in ASCII."""
    first = book.tables[0]
    made = dict.fromkeys((table.generator, table.created) for table in book.tables)
    lines = [
        f"retarder   {comment_text(first.retarder.name)}",
        f"tables     {len(book.tables)}",
    ]
    for generator, created in made:
        lines.append(f"made by    {comment_text(generator.name)} {comment_text(generator.version)}, {created}")
        lines.append(f"           configuration {generator.config_sha256}")
    return lines


def category_lines(book: TableBook) -> list[str]:
    """One #define for each weight category."""
    return [
        f"#define RETARDER_CATEGORY_{each.macro} {each.number}u /* {comment_text(each.category)} */"
        for each in category_names(book.exported_numbers())
    ]


def table_text(book: TableBook, number: int, size: BlockSize) -> str:
    """The initialiser of one table."""
    block = block_of(book, number, size=size)
    low, high = block.table.valid_range[:2]
    target = block.table.target_speed_m_s
    lines = ", ".join(f"{each}u" for each in block.words[4 : 4 + size.stages])
    return "\n".join(
        [
            f"    /* {number}: {comment_text(book.tables[number].id)} */",
            "    {",
            f"        {block.category}u, /* category */",
            f"        {block.axles}u, /* axles */",
            f"        {block.table.coefficients.shape[0]}u, /* stages */",
            f"        {block.table.coefficients.shape[2]}u, /* coefficients of a line */",
            f"        {{{lines}}}, /* lines of stage 0, 1, ... */",
            f"        {hex_float(block.mass_t)}, /* mass, {block.mass_t:g} t */",
            f"        {hex_float(target)}, /* target speed, {target:g} m/s */",
            f"        {hex_float(low)}, {hex_float(high)}, /* path range, {low:g} to {high:g} m */",
            "        {",
            ",\n".join(stage_text(block, stage, size) for stage in range(size.stages)),
            "        },",
            *estimator_text(block, size),
            *approach_text(block, size),
            *any_time_text(block, size),
            f"        0x{block.crc32:08x}u /* crc32 */",
            "    }",
        ]
    )


def approach_text(block: TableBlock, size: BlockSize) -> list[str]:
    """The lines of a table's initialiser about its approach; none if no table of the book has one."""
    if not size.approach:
        return []
    length_m = approach_m(block.table)
    return [
        f"        {hex_float(length_m)}, /* approach, {length_m:g} m */",
        f"        {block.table.entrance_stage}u, /* highest stage before the entrance */",
    ]


def stage_text(block: TableBlock, stage: int, size: BlockSize) -> str:
    """The two lines of one stage, a row each, with their coefficients in decimal for the eye."""
    coefficients = block.words[size.coefficients].view(np.float32).reshape(size.stages, 2, size.powers)[stage]
    rows = []
    for index, (name, bit) in enumerate((("lower", HAS_LOWER), ("upper", HAS_UPPER))):
        numbers = ", ".join(map(hex_float, coefficients[index]))
        shown = " ".join(f"{c:.6g}" for c in coefficients[index]) if block.words[4 + stage] & bit else "none"
        rows.append(f"                {{{numbers}}}{',' if index == 0 else ''} /* {name}: {shown} */")
    return "\n".join([f"            {{ /* stage {stage} */", *rows, "            }"])


def vector_lines(number: int, vectors: GoldenVectors, size: BlockSize) -> list[str]:
    """The golden vectors of table `number` as initialisers."""
    bits = zip(*(values.view(np.uint32) for values in reading_columns(vectors, size)), strict=True)
    return [
        f"    {{{number}u, {k}, {', '.join(f'0x{word:08x}u' for word in words)}, {answer}}}"
        for k, words, answer in zip(vectors.stage, bits, vectors.answer, strict=True)
    ]


def choice_line(choice: GoldenChoice) -> str:
    """A golden choice as initialiser."""
    bits = int(np.float32(choice.commanded_m_s).view(np.uint32))
    command = f"{choice.layout}u, {choice.category}u, {choice.axles}u, 0x{bits:08x}u"
    return f"    {{{command}, {int(choice.status)}, 0x{choice.crc32:08x}u}}"


def vectors_csv(book: TableBook, vectors: list[GoldenVectors]) -> bytes:
    """All golden vectors, CR LF: table number and id, stage, path and speed as bits and as numbers, answer.

    If a table of the book has a gauge, the pressure stands behind the speed, as bits and as a number.
    """
    size = block_size(book)
    rows = [f"table,id,stage,{VECTOR_COLUMNS_OF_GAUGE if size.gauge else VECTOR_COLUMNS},answer"]
    for number, (table, each) in enumerate(zip(book.tables, vectors, strict=True)):
        name = '"' + table.id.replace('"', '""') + '"'
        columns = reading_columns(each, size)
        bits = zip(*(values.view(np.uint32) for values in columns), strict=True)
        for k, words, values, answer in zip(each.stage, bits, zip(*columns, strict=True), each.answer, strict=True):
            fields = [*(f"{word:08x}" for word in words), *(f"{value:.9g}" for value in values)]
            rows.append(f"{number},{name},{k},{','.join(fields)},{answer}")
    return ("\r\n".join(rows) + "\r\n").encode("utf-8")
