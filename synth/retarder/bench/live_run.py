"""The run as a browser sees it: the cut on its way, and the score so far."""

from __future__ import annotations

import json
import math
from importlib.resources import files
from typing import Any, Final

import numpy as np

from synth.frame.page.document import SCRIPT_POLICY, scripted_document
from synth.frame.page.markup import Markup, element
from synth.retarder.bench.bench_pass import BenchCase, BenchPass
from synth.retarder.bench.exchange import Exchange
from synth.simulation.sampled_pass import Reading
from synth.solver.tabulate import lines_of

LINE_NODES = 81
"""Of the lines that are drawn."""


class LiveRun:
    """Written by the thread that plays the position; `document` may be asked by any."""

    def __init__(self, title: str, passes: int, exchange: Exchange) -> None:
        self._title, self._passes, self._exchange = title, passes, exchange
        self._cut: dict[str, Any] | None = None
        self._trace: list[tuple[float, float, float | None, float, int]] = []
        self._ends: list[tuple[float, float, float, int, int]] = []

    def begins(self, case: BenchCase, count: int) -> None:
        """Cut `count` comes."""
        table, plant = case.table, case.loop.plant
        nodes = np.linspace(plant.start_m, plant.exit_m, LINE_NODES)
        lines = lines_of(table, nodes)
        self._trace = []
        self._cut = {
            "count": count,
            "label": case.label,
            "target_m_s": table.target_speed_m_s,
            "exit_m": plant.exit_m,
            "zones_m": plant.position.zones_m,
            "nodes_m": nodes.tolist(),
            "lower_m_s": finite(lines.lower_m_s),
            "upper_m_s": finite(lines.upper_m_s),
        }

    def sampled(self, reading: Reading, stage: int) -> None:
        """The cut has gone on."""
        measured = None if math.isnan(reading.measured_m_s) else round(float(reading.measured_m_s), 3)
        path, speed, pressure = reading.path_m, reading.speed_m_s, reading.pressure_kpa
        row = (round(float(path), 3), round(float(speed), 3), measured, round(float(pressure), 1), stage)
        self._trace.append(row)

    def ended(self, case: BenchCase, found: BenchPass) -> None:
        """It has left, or stands."""
        target = case.table.target_speed_m_s
        by_table = float(case.by_table.exit_speed_m_s[found.number]) - target
        error = found.end.exit_speed_m_s - target
        promised = case.table.predicted.rms_m_s
        self._ends.append((error, by_table, promised, found.samples, found.unanswered))

    def document(self) -> bytes:
        """All of it as JSON."""
        ends, traffic = list(self._ends), self._exchange.traffic
        columns = list(zip(*ends, strict=True)) or [()] * 5
        errors, by_table, promised, samples, unanswered = columns
        known = {
            "title": self._title,
            "passes": self._passes,
            "ended": len(ends),
            "rms_m_s": rms(errors),
            "by_table_m_s": rms(by_table),
            "promised_m_s": rms(promised),
            "samples": sum(samples),
            "unanswered": sum(unanswered),
            "errors_m_s": [round(each, 4) for each in errors],
            "traffic": vars(traffic),
            "cut": self._cut,
            "trace": list(self._trace),
        }
        return json.dumps(known, allow_nan=False).encode()


def rms(values: tuple[float, ...]) -> float | None:
    """Root of their mean square; None without any."""
    return math.sqrt(sum(each * each for each in values) / len(values)) if values else None


def finite(lines: np.ndarray) -> list[list[float | None]]:
    """Lines, (stages, nodes), None where there is none."""
    return [[float(f"{v:.4g}") if math.isfinite(v) else None for v in row] for row in lines.tolist()]


PAGE: Final = "/now"
"""Where the page asks."""


def live_page(title: str) -> bytes:
    """The whole document."""
    content = (element("h1", f"{title}: on the bench"), Markup(part("live.html")))
    policy = f"{SCRIPT_POLICY}; connect-src 'self'"
    text = scripted_document(f"{title}: on the bench", part("live.css"), content, PAGE, [part("live.js")], policy)
    return text.encode()


def part(name: str) -> str:
    """A part of the page that is kept as a file beside this one."""
    return files("synth.retarder.bench").joinpath(name).read_text(encoding="utf-8")
