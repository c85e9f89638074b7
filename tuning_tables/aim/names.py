"""Names in the controller code of aim tables, and what its head says of where they come from."""

from __future__ import annotations

import re

from tuning_tables.aim.aim_tables import AimTables
from tuning_tables.category_names import comment_text
from tuning_tables.export_prefix import ExportPrefix


def with_prefix(prefix: ExportPrefix, code: str) -> str:
    """`code`, or the name of a file, with PREFIX_AIM_ for AIM_ and prefix_aim_ for aim_; unchanged by default."""
    if prefix.is_default:
        return code
    code = re.sub(r"\bAIM_", f"{prefix.text.upper()}_AIM_", code)
    return re.sub(r"\baim_", f"{prefix.text.lower()}_aim_", code)


def origin_lines(aims: AimTables) -> list[str]:
    """What the tables are for and where they come from, in ASCII."""
    position = aims.tables[0].position
    made = dict.fromkeys((table.generator, table.created) for table in aims.tables)
    lines = [
        f"position   {comment_text(position.name)}, left at {position.exit_at_m:g} m from the crest",
        f"tables     {len(aims.tables)}",
    ]
    for generator, created in made:
        lines.append(f"made by    {comment_text(generator.name)} {comment_text(generator.version)}, {created}")
        lines.append(f"           configuration {generator.config_sha256}")
    return lines
