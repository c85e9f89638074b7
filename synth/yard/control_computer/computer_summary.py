"""summary.json of a control computer: figures for programs, and the hashes of the files that belong to it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from importlib.metadata import version
from typing import Any

from synth.book.summary import Document, plain
from synth.yard.control_computer.computer_acceptance import ComputerVerdict
from synth.yard.control_computer.computer_results import ComputerResults, UncertainMoney
from synth.yard.control_computer.economics.economic_case import EconomicResult
from synth.yard.control_computer.economics.estimate import Estimate
from synth.yard.control_computer.economics.savings import Item
from synth.yard.control_computer.sized_computer import SizedComputer, TaskWait
from synth.yard.control_computer.sizing.inputs_outputs import total_channels
from synth.yard.control_computer.sizing.memory_need import Memory

VERSION = 1


def computer_summary(
    results: ComputerResults, verdict: ComputerVerdict, created: str, file_hashes: Mapping[str, str]
) -> Document:
    """The document; `file_hashes`: SHA-256 by file name, all files but summary.json itself. None: never, or none."""
    config = results.config
    document = {
        "format": "control-computer-summary",
        "version": VERSION,
        "created": created,
        "generator": {"name": "retarder-synth", "version": version("retarder-synth"), "config_sha256": config.sha256},
        "title": config.title,
        "config": json.loads(config.canonical_json),
        "warnings": config.warnings,
        "parameters_assumed": [value.key for value in config.parameters if value.assumed],
        "accepted": verdict.accepted,
        "limits": [asdict(limit) for limit in verdict.limits],
        "sizing": sizing_of(results.sized),
        "reliability": asdict(results.reliable),
        "economics": economics_of(results.economics),
        "uncertainty": None if results.money is None else uncertainty_of(results.money),
        "files": dict(file_hashes),
    }
    plain_document: Document = plain(finite(document))
    return plain_document


def sizing_of(sized: SizedComputer) -> dict[str, Any]:
    """How fast, and how large."""
    return {
        "load": sized.load,
        "tasks": [wait_of(each) for each in sized.waits],
        "needed_op_s": {each.name.lower(): speed for each, speed in sized.needed_op_s.items()},
        "waits_allowed": sized.waits_allowed,
        "cyclic": {"speed_op_s": sized.cyclic_op_s, "used_share": sized.cyclic_used},
        "word_bits": sized.word_bits,
        "memory_kibibytes": {each.name.lower(): sized.memory.kibibytes(each) for each in Memory},
        "channels": asdict(total_channels(sized.channels)),
        "controllers": [
            {
                "name": row.controller.name,
                "positions": row.all_positions.positions,
                "answer_s": row.all_positions.answer_s,
                "table_s": row.all_positions.table_s,
                "used_share": row.all_positions.used_share,
                "in_time": row.all_positions.in_time,
                "most_positions": row.most,
                "source": row.controller.source,
            }
            for row in sized.controllers
        ],
    }


def wait_of(each: TaskWait) -> dict[str, Any]:
    """One task, formula and simulation."""
    late, long_s = each.late_share, each.simulated.long_s
    return {
        "task": each.formula.task,
        "mean_wait_s": each.formula.start_s,
        "mean_sojourn_s": each.formula.sojourn_s,
        "long_wait": {"share": each.long_share.value, "error": each.long_share.error, "longer_than_s": long_s},
        "missed_deadline": None if late is None else {"share": late.value, "error": late.error},
        "simulated": {
            "mean_wait_s": sampled(each.simulated.start_s), "mean_sojourn_s": sampled(each.simulated.sojourn_s),
            "long_wait_share": sampled(each.simulated.long_share),
        },
    }  # fmt: skip


def sampled(found: Any) -> dict[str, float]:
    """A simulated mean with its interval."""
    ends = (found.mean - found.half_width, found.mean + found.half_width)
    return {"value": found.mean, "low95": ends[0], "high95": ends[1], "n": found.count}


def economics_of(found: EconomicResult) -> dict[str, Any]:
    """What it pays at the configured values."""
    rate = found.internal_rate
    return {
        "today": asdict(found.today),
        "new": asdict(found.new),
        "savings_per_year": [item_of(item) for item in found.savings],
        "released_capital": [item_of(item) for item in found.capital],
        "figures": found.figures(),
        "pay_back": found.pay_back.statement,
        "internal_rate": {"per_year": rate.per_year, "statement": rate.statement},
    }


def item_of(item: Item) -> dict[str, Any]:
    """One saving."""
    return {**asdict(item), "amount": item.amount}


def uncertainty_of(money: UncertainMoney) -> dict[str, Any]:
    """What the draws tell."""
    return {
        "draws": money.draws.n,
        "impossible": estimate_of(money.draws.impossible),
        "why_impossible": [{"sentence": text, "draws": n} for text, n in money.draws.found.faults],
        "outputs": [
            {
                "name": each.name,
                "n": each.n,
                "never": estimate_of(each.never),
                "mean": None if each.mean is None else estimate_of(each.mean),
                "quantiles": [dict(zip(("p", "value", "low95", "high95"), row, strict=True)) for row in each.quantiles],
            }
            for each in money.figures
        ],
        "tornado": {"output": money.tornado.output, "at_medians": money.tornado.at_medians,
                    "bars": [asdict(bar) for bar in money.tornado.bars]},
        "sobol": [asdict(index) for index in money.sobol],
        "no_sobol": money.no_sobol,
    }  # fmt: skip


def estimate_of(found: Estimate) -> dict[str, Any]:
    """A share or mean with its interval."""
    return asdict(found)


def finite(value: Any) -> Any:
    """The same with None for what is infinite or no number: JSON has neither."""
    if isinstance(value, dict):
        return {key: finite(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [finite(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
