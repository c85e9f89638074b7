"""Tables for point sensors as C99 source: rule, tracker and step, the data, and a self-test with golden rows.

The C text itself is in `c99/retarder_passages*.in`; here its blanks are filled. Numbers are hexadecimal floats, which
every C99 compiler reads exactly; the checksum of each table proves that it did.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final, TypeAlias

import numpy as np
import numpy.typing as npt

from tuning_tables.c_literals import hex_float
from tuning_tables.c_template import filled
from tuning_tables.category_names import comment_text
from tuning_tables.export_prefix import RETARDER, ExportPrefix
from tuning_tables.passages.export_head import category_texts, export_tag, origin_lines
from tuning_tables.passages.golden_passages import GoldenPassages, golden_crc, golden_passages, row_words
from tuning_tables.passages.golden_pulses import PAIR_ROW, PULSE_ROW, WHOLE
from tuning_tables.passages.golden_selections import GoldenSelection, golden_selections
from tuning_tables.passages.golden_stages import STAGE_ROW
from tuning_tables.passages.passage_block import COUNTS, PassageBlockSize, passage_block, passage_block_size
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.regulator import SHORTEST_READING_S
from tuning_tables.passages.tracker import LONGEST_WAIT_S

TEMPLATES: Final = (
    "retarder_passages.h",
    "retarder_passages.c",
    "retarder_passages_self_test.h",
    "retarder_passages_self_test.c",
)

Ask: TypeAlias = Callable[[PassageTable], GoldenPassages]
"""What a self-test asks of a table."""


def passage_c_files(
    book: PassageBook, prefix: ExportPrefix = RETARDER, ask: Ask = golden_passages
) -> Mapping[str, bytes]:
    """The files of the export by name: four of C99, ASCII, and all golden rows as CSV for other languages.

    `ask`: what the self-test asks. Equal books give equal bytes. Raises `InvalidTable` for a category without number.
    """
    blanks = passage_blanks(book, [ask(table) for table in book.tables])
    sources = {prefix.renamed(name): prefix.renamed(filled(name, blanks)).encode("ascii") for name in TEMPLATES}
    golden = [golden_passages(table) for table in book.tables]
    rows = {
        "golden_stages.csv": [each.stages for each in golden],
        "golden_pairs.csv": [each.pairs for each in golden],
        "golden_pulses.csv": [each.pulses for each in golden],
    }
    return {**sources, **{prefix.data_file(name): rows_csv(book.tables, each) for name, each in rows.items()}}


def passage_blanks(book: PassageBook, golden: Sequence[GoldenPassages]) -> Mapping[str, str]:
    """What the templates ask for, by the names of their blanks."""
    size, selections = passage_block_size(book.tables), golden_selections(book)
    kinds = zip(*((each.stages, each.pairs, each.pulses) for each in golden), strict=True)
    stages, pairs, pulses = (np.vstack([row_words(number, rows) for number, rows in enumerate(kind)]) for kind in kinds)
    return {
        "EXPORT": f"0x{export_tag(book):08x}u",
        "ORIGIN": "\n".join(f" * {line}" for line in origin_lines(book)),
        "CATEGORIES": "\n".join(
            f"#define RETARDER_CATEGORY_{macro} {number}u /* {name} */" for macro, number, name in category_texts(book)
        ),
        "HEARD": f"{size.heard}u",
        "PASSAGES": f"{size.passages}u",
        "STAGES": f"{size.stages}u",
        "LONGEST_WAIT_HEX": hex_float(np.float32(LONGEST_WAIT_S)),
        "SHORTEST_READING_HEX": hex_float(np.float32(SHORTEST_READING_S)),
        "COUNT": f"{len(book.tables)}",
        "TABLES": ",\n".join(table_text(table, number, size) for number, table in enumerate(book.tables)),
        "STAGE_ROWS": f"{len(stages)}",
        "PAIR_ROWS": f"{len(pairs)}",
        "PULSE_ROWS": f"{len(pulses)}",
        "STAGE_WORDS": f"{stages.shape[1]}",
        "PAIR_WORDS": f"{pairs.shape[1]}",
        "PULSE_WORDS": f"{pulses.shape[1]}",
        "GOLDEN_CRC": f"0x{golden_crc(golden):08x}u",
        "SELECTIONS": f"{len(selections)}",
        "GOLDEN_SELECTIONS": ",\n".join(map(_selection_text, selections)),
        "GOLDEN_STAGES": _rows_text(STAGE_ROW, stages),
        "GOLDEN_PAIRS": _rows_text(PAIR_ROW, pairs),
        "GOLDEN_PULSES": _rows_text(PULSE_ROW, pulses),
    }


def table_text(table: PassageTable, number: int, size: PassageBlockSize) -> str:
    """The initialiser of one table."""
    words = passage_block(table, size)
    floats = words.view(np.float32)
    speeds = floats[size.switching].reshape(size.passages, size.stages, size.stages - 1)
    counts = (
        "category", "axles", "stages", "passages heard", "passages", "before the entrance", "entrance stage",
        "initial stage",
    )  # fmt: skip
    numbers = (
        "mass, t", "target speed, m/s", "base, m", "least speed, m/s", "greatest speed, m/s", "acceleration, m/s2",
        "deceleration, m/s2", "tolerance of a speed", "tolerance of a path, m",
    )  # fmt: skip
    values = floats[COUNTS : size.path.start]
    return "\n".join(
        [
            f"    /* {number}: {comment_text(table.id)} */",
            "    {",
            *(f"        {word}u, /* {name} */" for word, name in zip(words[:COUNTS], counts, strict=True)),
            *(f"        {hex_float(v)}, /* {name}: {v:g} */" for v, name in zip(values, numbers, strict=True)),
            f"        {_row(floats[size.path])}, /* path, m */",
            *(
                f"        {{{', '.join(f'{word}u' for word in words[place])}}}, /* {name} */"
                for place, name in ((size.sensor, "sensor"), (size.deciding, "deciding passage"))
            ),
            "        {",
            ",\n".join(_passage_text(table, passage, rows) for passage, rows in enumerate(speeds)),
            "        },",
            f"        0x{words[-1]:08x}u /* crc32 */",
            "    }",
        ]
    )


def _selection_text(selection: GoldenSelection) -> str:
    """A golden selection as initialiser."""
    bits = int(selection.commanded_m_s.view(np.uint32))
    asked = f"{selection.category}u, {selection.axles}u, 0x{bits:08x}u"
    return f"    {{{asked}, {int(selection.status)}, {selection.table}u}}"


def _passage_text(table: PassageTable, passage: int, rows: npt.NDArray[np.float32]) -> str:
    """The switching speeds at one passage, a stage in force each line, with decimals for the eye."""
    told = "none"
    if passage < len(table.passages):
        row = table.passages[passage]
        told = f"{passage}: sensor {row.sensor}, axle {row.axle}, {row.path_m:g} m"
    lines = ",\n".join(f"                {_row(speeds)}" for speeds in rows)
    return f"            {{ /* {told} */\n{lines}\n            }}"


def _row(values: npt.NDArray[np.float32]) -> str:
    return "{" + ", ".join(map(hex_float, values)) + "}"


def _rows_text(kind: np.dtype[np.void], words: npt.NDArray[np.uint32]) -> str:
    """Golden rows as initialisers: whole numbers in decimal, others as bits."""
    names = kind.names or ()
    texts = []
    for row in words:
        fields = zip(names, row[1:], strict=True)
        literals = [str(word.view(np.int32)) if name in WHOLE else f"0x{word:08x}u" for name, word in fields]
        if "rival" in names:
            literals = [_tracker(literals[:6]), *literals[6:-7], _tracker(literals[-7:-1]), literals[-1]]
        texts.append(f"    {{{row[0]}u, {', '.join(literals)}}}")
    return ",\n".join(texts)


def _tracker(literals: Sequence[str]) -> str:
    """What is believed, and the rival."""
    return f"{{{{{', '.join(literals[:3])}}}, {{{', '.join(literals[3:])}}}}}"


def rows_csv(tables: Sequence[PassageTable], golden: Sequence[npt.NDArray[np.void]]) -> bytes:
    """Golden rows of all tables, CR LF: number and id of the table, whole numbers, others as bits and as numbers."""
    names = golden[0].dtype.names or ()
    others = [name for name in names if name not in WHOLE]
    lines = [",".join(("table", "id", *(name if name in WHOLE else f"{name}_bits" for name in names), *others))]
    for number, (table, rows) in enumerate(zip(tables, golden, strict=True)):
        head = f'{number},"{table.id.replace(chr(34), 2 * chr(34))}"'
        for row in rows:
            exact = [str(row[name]) if name in WHOLE else f"{row[name].view(np.uint32):08x}" for name in names]
            lines.append(",".join([head, *exact, *(f"{row[name]:.9g}" for name in others)]))
    return ("\r\n".join(lines) + "\r\n").encode("utf-8")
