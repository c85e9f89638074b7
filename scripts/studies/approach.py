"""What is gained when the regulator acts from before the entrance.

Tables are tuned for each approach, and run on the same cuts: friction, its course along the path, entry speed and
resistance of every pass are the same. The rules of thumb may act from the same place. Asked besides: how far the
approach should reach, what the limit at the entrance costs, what a brake does that the cut ahead has left closed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from scripts.studies.approach_tables import (
    Approaches,
    AtEntrance,
    CaseRow,
    FoundClosed,
    Given,
    LengthRow,
    best_rival,
    figures_of,
    highest_served_m_s,
    own_figures,
    run_on,
    table_of,
    with_approach,
)
from scripts.studies.cases import OTHER_PLANTS, Case, class_cases, named_cases, side_by_side
from scripts.studies.study import Method, Tell, option
from synth.retarder.configuration.config_file import load_config, parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.exit_statistics import rms_ratio
from synth.simulation.random_passes import random_passes
from synth.simulation.stratified_passes import stratified_passes

FRESH = 14
"""Added to the seed of the configuration: no table was made on these passes."""

TUNING_PASSES = 600


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((), "only cuts of these masses, t")
    length_m: float = option(4.0, "approach that every case is given, m", (0.1, 100.0))
    lengths_m: tuple[float, ...] = option((0.0, 2.0, 4.0, 6.0, 8.0, 12.0), "approaches compared, m", (0.0, 100.0))
    heavy: tuple[str, ...] = option(("52:2", "66:2", "66:3", "85:2", "85:3", "85:4"), "cases that they are compared on")
    light: tuple[str, ...] = option(("22:2", "36:2"), "cases of which the stage allowed at the entrance is varied")
    others: int = option(len(OTHER_PLANTS), "how many of the other plants", (0, len(OTHER_PLANTS)))
    passes: int = option(20_000, "stratified passes of each table", (200, 10**7))


def run(options: Options, tell: Tell) -> Approaches:
    """All parts."""
    config = load_config(options.config)
    seed = config.validation.seed + FRESH
    passes = stratified_passes(seed, 0, options.passes)
    given = Given(config, passes, random_passes(seed, options.passes, TUNING_PASSES))

    def compared(item: tuple[str, Case, Given]) -> CaseRow:
        name, case, own = item
        row = case_row(name, case, own, options.length_m)
        tell(f"{name}: {row.without.rms_m_s:.4f} from the entrance, {row.ahead.rms_m_s:.4f} from before it")
        return row

    asked = [(case.name, case, given) for case in class_cases(config, options.masses_t, ())]
    asked += [item for name, text in OTHER_PLANTS[: options.others] for item in other_cases(name, text, given)]
    cases = side_by_side(compared, asked)
    lengths = side_by_side(lambda case: length_row(case, given, options.lengths_m), named_cases(config, options.heavy))
    tell("lengths compared")
    light = named_cases(config, options.light)
    entrance = [row for case in light for row in entrance_rows(case, given, options.length_m)]
    closed = [row for case in named_cases(config, options.heavy) for row in closed_rows(case, given, options.length_m)]
    return Approaches(
        config.sha256, seed, options.passes, options.length_m, options.lengths_m, cases, lengths,
        tuple(entrance), tuple(closed),
    )  # fmt: skip


def other_cases(name: str, text: str, given: Given) -> Iterator[tuple[str, Case, Given]]:
    """The cases of another configuration."""
    config: ResolvedConfig = parse_config(text, name)
    for case in class_cases(config, (), ()):
        yield f"{name}, {case.name}", case, Given(config, given.passes, given.tuning)


def case_row(name: str, case: Case, given: Given, length_m: float) -> CaseRow:
    """One case from the entrance and from before it, with the best rule of thumb of each."""
    target = case.target_m_s
    plants = with_approach(case.plant, 0.0), with_approach(case.plant, length_m)
    (before, entrance), (after, ahead) = (run_on(plant, table_of(plant, target, given), given) for plant in plants)
    ratio, ci95 = rms_ratio(after, before, target)
    return CaseRow(
        case=name,
        without=figures_of(before, entrance, target),
        ahead=figures_of(after, ahead, target),
        ratio=ratio,
        ratio_ci95=ci95,
        rival_without=best_rival(before, entrance, target, given),
        rival=best_rival(after, ahead, target, given),
        served_m_s=(highest_served_m_s(plants[0], target, given), highest_served_m_s(plants[1], target, given)),
    )


def length_row(case: Case, given: Given, lengths_m: tuple[float, ...]) -> LengthRow:
    """rms of one case by the length of the approach."""
    found = [own_figures(with_approach(case.plant, x), case.target_m_s, given) for x in lengths_m]
    return LengthRow(case.name, tuple(f.rms_m_s for f in found), tuple(f.rms_ci95_m_s for f in found))


def entrance_rows(case: Case, given: Given, length_m: float) -> Iterator[AtEntrance]:
    """rms of one case by the stage allowed at the entrance."""
    for stage in range(case.plant.top_stage + 1):
        figures = own_figures(with_approach(case.plant, length_m, stage), case.target_m_s, given)
        yield AtEntrance(case.name, stage, figures.rms_m_s, figures.rms_ci95_m_s)


def closed_rows(case: Case, given: Given, length_m: float) -> Iterator[FoundClosed]:
    """What the table of a released brake does where the cut ahead has left the brake at a stage."""
    plant = with_approach(case.plant, length_m)
    table = table_of(plant, case.target_m_s, given)
    released, _ = run_on(plant, table, given)
    for stage in range(1, plant.entrance_stage + 1):
        sample, passes = run_on(with_approach(plant, length_m, initial_stage=stage), table, given)
        ratio, ci95 = rms_ratio(sample, released, case.target_m_s)
        yield FoundClosed(case.name, stage, figures_of(sample, passes, case.target_m_s).rms_m_s, ratio, ci95)


METHOD = Method(
    Options,
    Options(None, (36.0,), 4.0, (0.0, 4.0), ("66:3",), ("36:2",), 0, 400),
    Approaches,
    run,
)
