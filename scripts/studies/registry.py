"""All studies, in the order of their names, and one of them as the user writes it. Listing them imports none of
them.
"""

from __future__ import annotations

from plant_models.errors import near_miss
from scripts.studies.study import Study
from scripts.studies.yard_studies import YARD_STUDIES
from synth.frame.faults import InputError

POSITION_STUDIES: tuple[Study, ...] = (
    Study(
        "any-time",
        "What is gained when a command may be given at every sample, also during a change of stage?",
        480.0,
        "explanation/any-time.md",
        "scripts.studies.any_time.study",
    ),
    Study(
        "approach",
        "What is gained when the regulator acts from before the entrance, and from how far?",
        150.0,
        "explanation/approach.md",
        "scripts.studies.approach",
    ),
    Study(
        "benchmark",
        "How fast do the kernels of a tune solve its problem, beside numpy and the limit of the machine?",
        300.0,
        "explanation/speed.md",
        "scripts.studies.benchmark.study",
    ),
    Study(
        "book",
        "How accurate are the tables of the default book?",
        16.0,
        "reference/results.md",
        "scripts.studies.book",
        "scripts.studies.book",
    ),
    Study(
        "command-times",
        "How long do whole commands take, on a first run and on later ones?",
        2400.0,
        "explanation/speed.md",
        "scripts.studies.command_times",
    ),
    Study(
        "controller-agreement",
        "Does the exported C decide, choose and estimate as Python does, however it is compiled?",
        50.0,
        "reference/code-checks.md",
        "scripts.studies.in_the_loop.agreement_study",
    ),
    Study(
        "controller-cost",
        "What does the exported C cost: instructions of the dearest call, bytes of code and data?",
        79.0,
        "how-to/controllers.md#what-it-costs",
        "scripts.studies.in_the_loop.cost_study",
    ),
    Study(
        "correction",
        "What does the on-line correction by the last exits gain on a plant that drifts, and cost on one that stays?",
        100.0,
        "explanation/correction.md#what-it-gains",
        "scripts.studies.correction",
    ),
    Study(
        "coverage",
        "How often do the printed 95 % intervals hold the truth?",
        1200.0,
        "explanation/method-validation.md#intervals",
        "scripts.studies.coverage",
    ),
    Study(
        "criteria",
        "What do other criteria than the mean square make of the tables, and what does a price on switchings buy?",
        41.0,
        "explanation/choices.md#criterion",
        "scripts.studies.criteria",
    ),
    Study(
        "degree",
        "Which degree do the polynomial lines need?",
        46.0,
        "explanation/choices.md#degree",
        "scripts.studies.degree",
    ),
    Study(
        "estimator",
        "What is gained when the regulator compares an estimated speed with its lines?",
        76.0,
        "explanation/estimator.md#what-it-gains",
        "scripts.studies.estimator.study",
    ),
    Study(
        "estimator-reserve",
        "How much reserve for less friction than thought should lines for the estimate keep, and at what price?",
        240.0,
        "explanation/estimator.md#reserve",
        "scripts.studies.estimator.reserve_study",
    ),
    Study(
        "estimator-wrong",
        "What does the estimator cost where it is wrong: another friction, mass or gauge, a lost sensor?",
        18.0,
        "explanation/estimator.md#where-it-is-wrong",
        "scripts.studies.estimator.wrong_study",
    ),
    Study(
        "every-cut",
        "Does the table that a tune makes beat every tuned rule, for every ordinary cut?",
        630.0,
        "explanation/every-cut.md",
        "scripts.studies.every_cut.study",
        "scripts.studies.every_cut.picture",
    ),
    Study(
        "identification",
        "How true are the numbers that measured passes tell, and do their intervals hold?",
        2400.0,
        "how-to/identify.md",
        "scripts.studies.identification",
    ),
    Study(
        "interpolation",
        "What is lost by lines between two tables of a book, against a table tuned for the very speed commanded?",
        6.0,
        "how-to/controllers.md",
        "scripts.studies.interpolation",
    ),
    Study(
        "limits",
        "What limits the accuracy: what does each source of error or of delay cost a controller that knows of it?",
        28.0,
        "explanation/estimator.md",
        "scripts.studies.limits",
    ),
    Study(
        "peers",
        "Do tables keep up with a predictive controller and a PI with pulse width that may do what they may?",
        720.0,
        "explanation/peers.md",
        "scripts.studies.peers.study",
        "scripts.studies.peers.picture",
    ),
    Study(
        "point-sensors",
        "What are point sensors worth beside a radar: by number, places and axles, and what do their faults cost?",
        700.0,
        "how-to/point-sensors.md",
        "scripts.studies.point_sensors.study",
    ),
    Study(
        "radar-faults",
        "What does a controller do in faults of the radar, and does it notice a wrong weight category?",
        160.0,
        "explanation/radar-faults.md",
        "scripts.studies.radar_faults.study",
    ),
    Study(
        "retuning",
        "How much of what can be recovered do tables recover that are tuned for measured passes?",
        75.0,
        "how-to/retune.md#measured",
        "scripts.studies.retuning",
    ),
    Study(
        "robustness",
        "What does a table do on another plant than it was tuned for, and would one tuned for that plant do better?",
        157.0,
        "explanation/radar-faults.md#another-plant",
        "scripts.studies.robustness.study",
    ),
    Study(
        "rooms",
        "Which room of the house is for what, and which rooms does it stand on?",
        2.0,
        "explanation/architecture.md",
        "scripts.studies.rooms",
        "scripts.studies.rooms_picture",
    ),
    Study(
        "software-in-the-loop",
        "Does the compiled controller, as a process of its own, control a pass to the same bits as the simulator's?",
        41.0,
        "reference/code-checks.md",
        "scripts.studies.in_the_loop.loop_study",
    ),
    Study(
        "solver-growth",
        "How does the time of solving grow with classes, targets, nodes, speeds and scenarios?",
        240.0,
        "explanation/speed.md",
        "scripts.studies.benchmark.growth",
    ),
    Study(
        "structure",
        "Do the named parts of the loop, run one by one as they are wired, give the simulator's pass?",
        20.0,
        "explanation/structure.md",
        "scripts.studies.structure.study",
        "scripts.studies.structure.study",
    ),
    Study(
        "switching-price",
        "What do fewer switchings cost in accuracy, with commands at rest and at any time?",
        130.0,
        "explanation/any-time.md",
        "scripts.studies.switching_price",
    ),
    Study(
        "time-price",
        "What does less time in a position cost in accuracy?",
        51.0,
        "explanation/choices.md#time",
        "scripts.studies.time_price",
        "scripts.studies.time_price",
    ),
    Study(
        "verification",
        "What does `verify` doubt: tables whose claims are true, and tables that state another rms than theirs?",
        120.0,
        "explanation/verification.md",
        "scripts.studies.verification",
    ),
    Study(
        "watch",
        "After how many passes is a drift found and named, how often is the alarm a false one, and what is repaired "
        "first?",
        150.0,
        "how-to/watch.md#how-it-was-shown",
        "scripts.studies.watch.study",
    ),
)

STUDIES: tuple[Study, ...] = tuple(sorted((*POSITION_STUDIES, *YARD_STUDIES), key=lambda study: study.name))


def study_named(name: str) -> Study:
    """The study called `name`. Raises `InputError` with a hint for another word."""
    known = {study.name: study for study in STUDIES}
    if name not in known:
        raise InputError(f"study: there is no study {name!r}; {near_miss(name, known)} ('study --list' tells all)")
    return known[name]
