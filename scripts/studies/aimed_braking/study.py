"""Aimed braking as Kozachenko studies it, beside what Kozachenko, the dissertation and an independent prototype found.

Exit speeds are chosen for a share of over-speeds on some cuts and judged on others. The position adds a normal error to
the commanded exit speed, as in Kozachenko. Every figure comes from independent replicates of both steps.
"""

from __future__ import annotations

from dataclasses import dataclass

from scripts.studies.aimed_braking.findings import AimedBraking, Norm
from scripts.studies.aimed_braking.measuring import WAYS, measured
from scripts.studies.aimed_braking.published_figures import (
    BEHIND_POSITION,
    FROM_CREST,
    Line,
    beside,
    by_category,
    doubled_accuracy,
    line,
    over_speeds,
)
from scripts.studies.aimed_braking.sensitivity import INPUTS, sensitivities
from scripts.studies.aiming.cuts import POINTS, large_hump, weight_category
from scripts.studies.aiming.refinements import ByRegression, LightnessByWeigher, NearestRecord
from scripts.studies.aiming.trial import Cuts, Draws, norm_distance, value_of
from scripts.studies.study import Method, Tell, option
from synth.aim.knowledge import ByCategory, ByReading, Knowledge, ResistanceByTwoSpeeds
from synth.aim.position_models import NormalPosition
from synth.aim.scene import AimScene

EXACT_WEIGHT = 1e-4
"""Relative error of a weigher that stands for exact weight."""

COARSE_STD_M_S = 0.4
"""Of the exit speed that the dissertation's regulators had, nearly."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    p_overspeed: float = option(0.1, "share of over-speeds that commands keep", (0.01, 0.5))
    exit_std_m_s: float = option(0.1, "standard deviation of the exit speed, as in Kozachenko", (0.0, 1.0))
    metres: tuple[float, ...] = option(
        (360.0, 380.0, 400.0, 425.0, 450.0, 475.0, 500.0, 550.0, 600.0, 650.0, 700.0), "distances from the crest",
        (350.0, 900.0),
    )  # fmt: skip
    last_m: float = option(900.0, "the norm is looked for to this distance from the crest", (400.0, 950.0))
    records: int = option(300, "recorded cuts of the three control points", (10, 100_000))
    cars: tuple[int, ...] = option((1, 2, 3, 5, 6, 8), "cars in a cut, figure 5", (1, 20))
    inputs: int = option(len(INPUTS), "how many assumed inputs are changed", (0, len(INPUTS)))
    prototype_rows: int = option(9, "rows of the prototype's tables", (1, 9))
    ways: int = option(len(WAYS), "ways to measure", (1, len(WAYS)))
    replicates: int = option(8, "independent replicates", (2, 1000))
    design: int = option(6000, "cuts of a replicate that commands are chosen on", (200, 10**6))
    report: int = option(6000, "cuts of a replicate that commands are judged on", (200, 10**6))
    seed: int = option(15, "of all draws", (0, 10**9))


SPEEDS_M_S = (0.6, 0.8, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7, 1.8, 1.9, 2.0, 2.2, 2.4, 2.6, 2.8, 3.0, 3.5)
"""Commanded speeds of figures 2 and 3."""


def run(options: Options, tell: Tell) -> AimedBraking:
    """All parts."""
    scene, draws = large_hump(), Draws(options.replicates, options.design, options.report, options.seed)
    light, heavy = (weight_category(scene, name) for name in ("L", "T"))
    p, std = options.p_overspeed, options.exit_std_m_s
    over = tuple(
        over_speeds(scene, category, metres, SPEEDS_M_S, std, draws)
        for category in (light, heavy)
        for metres in (400.0, 450.0, 500.0, 600.0, 700.0)
    )
    tell("over-speed and gap over the exit speed")
    categories = by_category(scene, options.metres, std, p, draws)
    refined = refined_lines(scene, options, draws)
    accuracy = accuracy_lines(scene, options, draws)
    cars = tuple(
        line(f"{n} car{'s' * (n > 1)}", Cuts(scene, light, n), options.metres, std, ByCategory(), p, draws)
        for n in options.cars
    )
    tell("gap over the distance")
    norms = norm_rows(scene, options, draws)
    moved = tuple(sensitivities(scene, options.inputs, options.last_m, p, draws))
    tell("sensitivity")
    doubled = tuple(
        row
        for category in (light, heavy)
        for row in doubled_accuracy(scene, category, options.metres, COARSE_STD_M_S, draws)
    )
    from_crest, from_exit = (
        tuple(beside(scene, rows[: options.prototype_rows], p, draws)) for rows in (FROM_CREST, BEHIND_POSITION)
    )
    tell("prototype's tables")
    behind = (100.0, 200.0, 300.0)
    ways = tuple(measured(scene, behind, p, draws, WAYS[: options.ways]))
    tell("ways to measure")
    return AimedBraking(
        draws, p, options.last_m, over, categories, refined, accuracy, cars, norms, moved, doubled,
        from_crest, from_exit, behind, ways,
    )  # fmt: skip


def refinements(options: Options) -> tuple[tuple[str, Knowledge], ...]:
    """What may be known of a single light car."""
    return (
        ("category alone", ByCategory()),
        ("exact weight", ByRegression(LightnessByWeigher(EXACT_WEIGHT))),
        (f"three control points, nearest of {options.records} records", NearestRecord(POINTS, options.records)),
        ("resistance by two speeds, σ_v 0.03", ByReading(ResistanceByTwoSpeeds(0.03))),
    )


def refined_lines(scene: AimScene, options: Options, draws: Draws) -> tuple[Line, ...]:
    """Figure 4, light single cars with and without refinement; category alone first."""
    cuts = Cuts(scene, weight_category(scene, "L"))
    std, p = options.exit_std_m_s, options.p_overspeed
    return tuple(line(name, cuts, options.metres, std, knowledge, p, draws) for name, knowledge in refinements(options))


def accuracy_lines(scene: AimScene, options: Options, draws: Draws) -> tuple[Line, ...]:
    """Light single cars by the error of the exit speed; the exact exit speed first."""
    cuts = Cuts(scene, weight_category(scene, "L"))
    names = (("exact exit speed", 0.0), ("σ 0.1", 0.1), ("σ 0.2", 0.2), ("σ 0.4", 0.4))
    return tuple(line(name, cuts, options.metres, std, ByCategory(), options.p_overspeed, draws) for name, std in names)


def norm_rows(scene: AimScene, options: Options, draws: Draws) -> tuple[Norm, ...]:
    """How far the norm is met: by category, by cars of light cuts, by refinement of light single cars."""
    members = scene.population.categories.members
    light = weight_category(scene, "L")
    asked: list[tuple[str, Cuts, Knowledge]] = [
        (f"{c.latin}, 1 car, category", Cuts(scene, c), ByCategory()) for c in members
    ]
    asked += [(f"L, {n} cars, category", Cuts(scene, light, n), ByCategory()) for n in options.cars if n > 1]
    asked += [(f"L, 1 car, {name}", Cuts(scene, light), known) for name, known in refinements(options)[1:]]
    position = NormalPosition(options.exit_std_m_s, only_brakes=False)
    rows = []
    for name, cuts, knowledge in asked:
        found = norm_distance(cuts, position, knowledge, options.p_overspeed, draws, options.last_m)
        rows.append(Norm(name, None if (found == float("inf")).any() else value_of(found)))
    return tuple(rows)


METHOD = Method(
    Options,
    Options(metres=(400.0, 500.0), last_m=600.0, records=50, cars=(1, 2), inputs=1, prototype_rows=1, ways=5,
            replicates=2, design=400, report=300),
    AimedBraking,
    run,
)  # fmt: skip
