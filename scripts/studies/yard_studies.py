"""The studies of the yard: humping, rolling, aiming, the computer of a hump. Listing them imports none of them."""

from __future__ import annotations

from scripts.studies.study import Study

YARD_STUDIES: tuple[Study, ...] = (
    Study(
        "aim-tables",
        "How large are the gaps where the default aim tables are used?",
        12.0,
        "how-to/aim.md#results",
        "scripts.studies.aim_tables",
    ),
    Study(
        "aimed-braking",
        "How far does a position aim: gap against over-speed, which assumption moves it, what would measuring bring?",
        240.0,
        "explanation/aimed-braking.md",
        "scripts.studies.aimed_braking.study",
        "scripts.studies.aimed_braking.pictures",
    ),
    Study(
        "control-computer",
        "How fast and how reliable must the control computer be, what does it pay, and which controller does it today?",
        110.0,
        "how-to/control-computer.md",
        "scripts.studies.control_computer.study",
    ),
    Study(
        "hump-day",
        "How fast can trains be humped, and at what price in catch-ups, over-speeds and gaps?",
        1150.0,
        "explanation/hump-day.md",
        "scripts.studies.humping.study",
        "scripts.studies.humping.pictures",
    ),
    Study(
        "rolling",
        "How fast and how exactly do cuts roll, beside numpy and scipy, and by which step?",
        40.0,
        "explanation/rolling.md",
        "scripts.studies.rolling.study",
    ),
    Study(
        "yard-chain",
        "What do exact exits and measured resistance bring the yard: metres of gap and damaging couplings?",
        510.0,
        "explanation/aimed-braking.md#the-chain",
        "scripts.studies.yard_chain.study",
        "scripts.studies.yard_chain.pictures",
    ),
)
