"""The configuration that tables were made of, for whoever gets their code: from the summary beside them."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from synth.frame.settings.toml_text import toml_text
from synth.frame.summary import FORMAT
from tuning_tables import AnyTable
from tuning_tables.aim.aim_table import AimTable
from tuning_tables.canonical import canonical_json
from tuning_tables.export_prefix import AIM, ExportPrefix

NAME: Final = "retarder_configuration.toml"

HEAD: Final = """\
# What the tables beside this file were made of, every value of it, to be read: `tune` takes the shorter file that these
# values were found from. As canonical JSON (RFC 8785) they have the SHA-256
# {sha256}
"""


def configuration_file(source: Path, tables: Sequence[AnyTable], prefix: ExportPrefix) -> Mapping[str, bytes]:
    """The file with the configuration of the tables, all of one kind; none where no summary at `source` has it.

    `source`: a table, a book, or the directory of a command; the summary lies there, or in a folder above a file.
    """
    sha256s = {table.generator.config_sha256 for table in tables}
    named = prefix.of_kind(AIM) if isinstance(tables[0], AimTable) else prefix
    here = source if source.is_dir() else source.parent
    for folder in (here, here.parent):
        try:
            document = json.loads((folder / "summary.json").read_bytes())
            config = document["config"] if document["format"] == FORMAT else {}
            sha256 = hashlib.sha256(canonical_json(config)).hexdigest()
        except (OSError, ValueError, KeyError, TypeError):  # no summary, or none of ours
            continue
        if sha256 in sha256s:
            text = HEAD.format(sha256=sha256) + toml_text(config)
            return {named.renamed(NAME): text.encode("utf-8")}
    return {}
