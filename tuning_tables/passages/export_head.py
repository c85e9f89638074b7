"""What an export of tables for point sensors says of itself at its head: for what, from where, which categories."""

from __future__ import annotations

import zlib
from collections.abc import Mapping, Sequence

from tuning_tables.category_names import comment_text
from tuning_tables.passages.passage_block import number_of, passage_block, passage_block_size
from tuning_tables.passages.passage_table import PassageTable


def origin_lines(tables: Sequence[PassageTable]) -> list[str]:
    """For which retarder the tables are, where its sensors stand, and what made them, in ASCII."""
    first = tables[0]
    places = ", ".join(f"{place:g}" for place in first.sensors.path_m)
    made = dict.fromkeys((table.generator, table.created) for table in tables)
    lines = [
        f"retarder   {comment_text(first.retarder.name)}",
        f"sensors    0 to {len(first.sensors.path_m) - 1}, middle of their bases at {places} m from the entrance",
        f"tables     {len(tables)}",
    ]
    for generator, created in made:
        lines.append(f"made by    {comment_text(generator.name)} {comment_text(generator.version)}, {created}")
        lines.append(f"           configuration {generator.config_sha256}")
    return lines


def exported_numbers(tables: Sequence[PassageTable]) -> Mapping[str, int]:
    """The number of every weight category; `InvalidTable` for one without."""
    return {table.cut.category: number_of(table) for table in tables}


def export_tag(tables: Sequence[PassageTable]) -> int:
    """A number that differs for exports whose files must not be mixed: CRC-32 over categories and all blocks.

    Without the checksums of the blocks: a CRC over content and its own CRC is the same whatever the content is.
    """
    size = passage_block_size(tables)
    content = "\n".join(["passage tables", *exported_numbers(tables)]).encode("utf-8")
    return zlib.crc32(content + b"".join(passage_block(table, size)[:-1].astype("<u4").tobytes() for table in tables))
