"""All studies, in the order of their names. Listing them imports none of them."""

from __future__ import annotations

from plant_models.library.near_miss import near_miss
from synth.faults.input_error import InputError
from synth.studies.study import Study

STUDIES: tuple[Study, ...] = (
    Study(
        "accuracy-grid",
        "How near are the tables to what physics leaves, over a whole grid of cases, and are all limits kept?",
        122.0,
        "estimator.md#the-whole-grid",
        "synth.studies.accuracy_grid.study",
        "synth.studies.accuracy_grid.picture",
    ),
    Study(
        "approach",
        "What is gained when the regulator acts from before the entrance, and from how far?",
        150.0,
        "approach.md",
        "synth.studies.approach.study",
        "synth.studies.approach.picture",
    ),
    Study(
        "benchmark",
        "How fast do the kernels of a tune solve its problem, beside numpy and the limit of the machine?",
        34.0,
        "speed.md",
        "synth.studies.benchmark.study",
        "synth.studies.benchmark.picture",
    ),
    Study(
        "book",
        "How accurate are the tables of the default book?",
        8.0,
        "results.md",
        "synth.studies.book",
    ),
    Study(
        "controller-agreement",
        "Does the exported C decide, choose and estimate as Python does, however it is compiled?",
        50.0,
        "controllers.md#how-it-was-shown",
        "synth.studies.in_the_loop.agreement_study",
    ),
    Study(
        "controller-cost",
        "What does the exported C cost: instructions of the dearest call, bytes of code and data?",
        79.0,
        "controllers.md#what-it-costs",
        "synth.studies.in_the_loop.cost_study",
    ),
    Study(
        "convergence",
        "How do value, lines and prediction change as the steps of the grid are halved?",
        17.0,
        "method.md#11-convergence",
        "synth.studies.convergence.study",
        "synth.studies.convergence.picture",
    ),
    Study(
        "coverage",
        "How often do the printed 95 % intervals hold the truth?",
        1200.0,
        "method.md#8-closed-loop",
        "synth.studies.coverage",
    ),
    Study(
        "criteria",
        "What do other criteria than the mean square make of the tables, and what does a price on switchings buy?",
        41.0,
        "method.md#12-criteria",
        "synth.studies.criteria.study",
        "synth.studies.criteria.picture",
    ),
    Study(
        "degree",
        "Which degree do the polynomial lines need?",
        46.0,
        "degree.md",
        "synth.studies.degree",
        "synth.studies.degree",
    ),
    Study(
        "estimator",
        "What is gained when the regulator compares an estimated speed with its lines?",
        76.0,
        "estimator.md#what-it-gains",
        "synth.studies.estimator.study",
        "synth.studies.estimator.study",
    ),
    Study(
        "estimator-reserve",
        "How much reserve for less friction than thought should lines for the estimate keep, and at what price?",
        240.0,
        "estimator.md#reserve",
        "synth.studies.estimator.reserve_study",
        "synth.studies.estimator.reserve_picture",
    ),
    Study(
        "estimator-spreads",
        "What does the estimator gain at other spreads of friction, and at another position?",
        104.0,
        "estimator.md#what-it-gains",
        "synth.studies.estimator.spreads",
    ),
    Study(
        "estimator-wrong",
        "What does the estimator cost where it is wrong: another friction, mass or gauge, a lost sensor?",
        18.0,
        "estimator.md#where-it-is-wrong",
        "synth.studies.estimator.wrong_study",
        "synth.studies.estimator.wrong_study",
    ),
    Study(
        "friction-known",
        "How good is the reference that regret and feasibility are measured by: what would more effort make of it?",
        150.0,
        "limits.md#the-friction-known-reference",
        "synth.studies.friction_known",
    ),
    Study(
        "integration-error",
        "What do the time steps of the closed loop cost in accuracy?",
        8.0,
        "method.md#8-closed-loop",
        "synth.studies.integration_error",
        "synth.studies.integration_error",
    ),
    Study(
        "interpolation",
        "What is lost by lines between two tables of a book, against a table tuned for the very speed commanded?",
        6.0,
        "controllers.md",
        "synth.studies.interpolation",
        "synth.studies.interpolation_picture",
    ),
    Study(
        "limits",
        "What limits the accuracy: what does each source of error or of delay cost a controller that knows of it?",
        28.0,
        "estimator.md",
        "synth.studies.limits.study",
        "synth.studies.limits.picture",
    ),
    Study(
        "rare-events",
        "How often does a cut leave far too fast, down to one in a million and below?",
        126.0,
        "rare-events.md",
        "synth.studies.rare_events.study",
        "synth.studies.rare_events.picture",
    ),
    Study(
        "reference-problem",
        "How fast is a neutral, published problem solved, beside scipy, QuantEcon, plain numba and numpy?",
        56.0,
        "benchmark.md",
        "synth.studies.reference_problem.study",
        "synth.studies.reference_problem.picture",
    ),
    Study(
        "robustness",
        "What does a table do on another plant than it was tuned for: wrong parameters, worn parts, faulty sensors?",
        157.0,
        "robustness.md",
        "synth.studies.robustness.study",
        "synth.studies.robustness.pictures",
    ),
    Study(
        "rolling",
        "How fast and how exactly do cuts roll, beside numpy and scipy, and by which step?",
        40.0,
        "rolling.md",
        "synth.studies.rolling.study",
    ),
    Study(
        "software-in-the-loop",
        "Does the compiled controller, as a process of its own, control a pass to the same bits as the simulator's?",
        41.0,
        "controllers.md#how-it-was-shown",
        "synth.studies.in_the_loop.loop_study",
    ),
    Study(
        "solver-scaling",
        "What does a solve cost against each size of the problem, on more threads and in float32; what a prediction?",
        44.0,
        "speed.md#solving-and-predicting",
        "synth.studies.solver_scaling.study",
        "synth.studies.solver_scaling.picture",
    ),
    Study(
        "sweep-speed",
        "How fast does a sweep make tables, what memory does it take, and what would 10 000 tables need?",
        104.0,
        "sweep.md#measured",
        "synth.studies.sweep_speed.study",
        "synth.studies.sweep_speed.picture",
    ),
    Study(
        "times",
        "How long does a user wait: start-up, a tune with and without compiled kernels, the closed loop?",
        278.0,
        "speed.md",
        "synth.studies.times.study",
        "synth.studies.times.picture",
    ),
    Study(
        "unlocked",
        "What is gained when a command may be given at every sample, also during a change of stage?",
        3480.0,
        "unlocked.md",
        "synth.studies.unlocked.study",
        "synth.studies.unlocked.pictures",
    ),
    Study(
        "verification",
        "What does `verify` doubt: tables whose claims are true, and tables that state another rms than theirs?",
        120.0,
        "verification.md",
        "synth.studies.verification",
    ),
)


def study_named(name: str) -> Study:
    """The study called `name`. Raises `InputError` with a hint for another word."""
    known = {study.name: study for study in STUDIES}
    if name not in known:
        raise InputError(f"study: there is no study {name!r}; {near_miss(name, known)} ('study --list' tells all)")
    return known[name]
