"""What an export of tables for point sensors says of itself at its head: for what, from where, which categories."""

from __future__ import annotations

import zlib

from tuning_tables.category_names import category_names, comment_text
from tuning_tables.passages.passage_block import exported_number, passage_block, passage_block_size
from tuning_tables.passages.passage_book import PassageBook


def origin_lines(book: PassageBook) -> list[str]:
    """For which retarder the tables are, where its sensors stand, and what made them, in ASCII."""
    first = book.tables[0]
    places = ", ".join(f"{place:g}" for place in first.sensors.path_m)
    made = dict.fromkeys((table.generator, table.created) for table in book.tables)
    lines = [
        f"retarder   {comment_text(first.retarder.name)}",
        f"sensors    0 to {len(first.sensors.path_m) - 1}, middle of their bases at {places} m from the entrance",
        f"tables     {len(book.tables)}",
    ]
    for generator, created in made:
        lines.append(f"made by    {comment_text(generator.name)} {comment_text(generator.version)}, {created}")
        lines.append(f"           configuration {generator.config_sha256}")
    return lines


def category_texts(book: PassageBook) -> list[tuple[str, int, str]]:
    """(macro, number, name for a comment) of every weight category, by number; `InvalidTable` for one without."""
    names = category_names({table.cut.category: exported_number(table) for table in book.tables})
    return [(each.macro, each.number, comment_text(each.category)) for each in names]


def export_tag(book: PassageBook) -> int:
    """A number that differs for exports whose files must not be mixed: CRC-32 over categories and all blocks.

    Without the checksums of the blocks: a CRC over content and its own CRC is the same whatever the content is.
    """
    size = passage_block_size(book.tables)
    content = "\n".join(["passage tables", *dict.fromkeys(table.cut.category for table in book.tables)]).encode("utf-8")
    return zlib.crc32(
        content + b"".join(passage_block(table, size)[:-1].astype("<u4").tobytes() for table in book.tables)
    )
