"""summary.json of an aim: figures for programs, and the hashes of the files that belong to it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib.metadata import version

from synth.book.summary import Document, plain
from synth.yard.aim.aim_acceptance import AimBookVerdict, AimVerdict
from synth.yard.aim.aim_book import AimBook, MadeAim

VERSION = 1


def aim_summary(book: AimBook, verdict: AimBookVerdict, file_hashes: Mapping[str, str]) -> Document:
    """The document of `book`; `file_hashes`: SHA-256 by file name, all files but summary.json itself."""
    config = book.config
    document = {
        "format": "aim-summary",
        "version": VERSION,
        "created": book.created,
        "generator": {"name": "retarder-synth", "version": version("retarder-synth"), "config_sha256": config.sha256},
        "title": config.title,
        "config": json.loads(config.canonical_json),
        "warnings": config.warnings,
        "parameters_assumed": [value.key for value in config.parameters if value.assumed],
        "accepted": verdict.accepted,
        "verdict": verdict.sentence,
        "tables": [table_of(made, of_it) for made, of_it in zip(book.tables, verdict.tables, strict=True)],
        "files": dict(file_hashes),
    }
    plain_document: Document = plain(document)
    return plain_document


def table_of(made: MadeAim, verdict: AimVerdict) -> Document:
    """Everything about one table but its nodes, which are in its file; lists are [cars][free distance]."""
    speeds, figures = made.speeds, made.speeds.of_all
    return {
        "id": made.table.id,
        "table": f"tables/{made.table.id}.json",
        "category": made.category.name,
        "category_number": made.category.number,
        "knowledge": made.knowledge,
        "cars": speeds.order.cars,
        "free_distances_m": speeds.order.free_distances_m,
        "resistance_n_per_kn": None if speeds.readings is None else [speeds.readings[0], speeds.readings[-1]],
        "chosen_on_cuts": speeds.order.design_cuts,
        "judged_on_cuts": speeds.order.report_cuts,
        "accepted": not verdict.missed,
        "missed_cells": verdict.missed,
        "cells": verdict.cells,
        "cells_with_figures": verdict.told,
        "cells_without_speed": verdict.without,
        "worst_cell": {"p_overspeed": verdict.worst[0], "ci95": verdict.worst[1:]},
        "p_overspeed": figures.overspeed.tolist(),
        "p_overspeed_low95": figures.overspeed_low95.tolist(),
        "p_overspeed_high95": figures.overspeed_high95.tolist(),
        "mean_gap_m": figures.gap_m.tolist(),
        "mean_gap_low95_m": figures.gap_low95_m.tolist(),
        "mean_gap_high95_m": figures.gap_high95_m.tolist(),
        "share_without_speed": figures.without.tolist(),
        "interpolation": {"above_m_s": speeds.above_m_s, "below_m_s": speeds.below_m_s},
    }
