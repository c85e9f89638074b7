"""A commented file of one type to start one's own from: that of the library, and what must be known of its form."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from plant_models.library import (
    BUILT_IN,
    CAR_MIXES,
    CARS,
    POSITIONS,
    RETARDERS,
    SENSORS,
    TRACKS,
    WEIGHT_CATEGORIES,
    WHEEL_SENSORS,
    YARD_CATEGORIES,
    Kind,
)
from synth.aim.configuration.settings import DEFAULT_TRACK
from synth.aim.configuration.shared_settings import DEFAULT_MIX
from synth.frame.settings.template import source_lines
from synth.retarder.configuration.plant_fault import require_held
from synth.retarder.configuration.plant_settings import DEFAULT_POSITION, DEFAULT_WHEEL_SENSOR

START_FROM: Final = {
    CARS: "gondola-4",
    RETARDERS: "knp-5",
    POSITIONS: DEFAULT_POSITION,
    SENSORS: "doppler-radar",
    WHEEL_SENSORS: DEFAULT_WHEEL_SENSOR,
    WEIGHT_CATEGORIES: YARD_CATEGORIES,
    TRACKS: DEFAULT_TRACK,
    CAR_MIXES: DEFAULT_MIX,
}
"""The type that is printed where none is named."""

NAMED_IN: Final = {
    CARS: 'car = "{0}" in a [[cut]]',
    RETARDERS: 'retarder = "{0}" in a position file',
    POSITIONS: 'name = "{0}" in [position]',
    SENSORS: 'sensor = "{0}" in a position file',
    WHEEL_SENSORS: 'type = "{0}" in [sensors]',
    WEIGHT_CATEGORIES: 'weight_categories = "{0}"',
    TRACKS: 'name = "{0}" in [track] of an aim configuration',
    CAR_MIXES: 'mix = "{0}" in [cuts] of an aim configuration',
}
"""How a file of each kind is named where it is used."""

FORM: Final = {
    CARS: """\
# The axles can be given in three forms; keep one:
#   pivot_base_m and bogie_axle_offsets_m   two equal bogies
#   pivots_m and bogie_axle_offsets_m       several equal bogies, as of an articulated car: pivots behind the first one
#   axle_offsets_m                          all axles behind the first, as of a wagon with two or three axles
# The overhangs at both ends are taken as equal.""",
    RETARDERS: """\
# law: "pressing" (force.slope_kn_per_kpa: force of a wheel pair by pressure) or "weight" (force.slope_kn_per_kpa_per_t:
# the same by pressure and axle load). stage_pressures_kpa: the released stage first, then the braking stages.
# length_m: over which one unit brakes. A position file says where the units stand.""",
    POSITIONS: """\
# retarder, sensor: names of types in the library, or paths from this file's folder.
# starts_m: where each unit begins. Units of different lengths: give zones_m = [[begin, end], …] in its place.
# [entry]: low_m_s and high_m_s; with mean_m_s and std_m_s beside them a normal law between these limits; or edges_m_s
# and shares, a histogram. [track]: one grade, or pieces, each [start in m, permille]. [regulator]: approach_m, from how
# far before the entrance the regulator acts, and initial_stage, the stage left from the cut ahead; 0 if left out.
# [friction]: mean_cv, how uncertain the mean friction itself is, may be left out, too: then it is taken as known.""",
    SENSORS: """\
# resolution_m_s: 0 means not quantised. missed_share: share of the readings that are lost, 0 to 0.5; missed_burst_s:
# for how long they are lost at a time on average, at least sample_period_s.""",
    WHEEL_SENSORS: """\
# base_m: distance of the coils; base_tolerance: standard deviation of its relative error, lasting for each sensor and
# unknown to the regulator. timer_noise_s: standard deviation of a measured time. timer_resolution_s: times are whole
# multiples of it; 0: not rounded. computing_delay_s: from the second pulse to the command on the wires.
# scan_period_s: step of the regulator's clock; changes of stage last whole steps. Where the sensors stand, says
# path_m in [sensors] of a configuration.""",
    WEIGHT_CATEGORIES: """\
# One table for each category, the lightest first. name: in tables; the table's own name is a second one, for keyboards.
# number: stands for the category in controllers for good: 16 to 255; 1 to 5 only for Л, ЛС, С, СТ, Т.
# The limit, exceeded by all cuts of the category: axle_load_above_t, or mass_above_t of a car with four axles; 0 first.
# allowed_stage: the highest stage that cuts of the category may be given; entrance_stage: the same while the first axle
# is before the entrance (left out: as allowed_stage). braking_stages: of how many braking stages these are; at a
# position with another number of them the same part is allowed, rounded down (left out: the stages as they are).""",
    TRACKS: """\
# [bends] may be left out as a whole: a track without switches and curves. The park position must end before the track
# does, and the stretch must end before the entrance of the park position.""",
    CAR_MIXES: """\
# One table [cars.NAME] for each type of car of the library or of your own; gross and tare are those of the type.""",
}


def type_toml(kind: Kind, name: str | None) -> str:
    """The file of the type `name` (None: a usual one) as TOML to start one's own from; it reads back the same.

    `InputError` if the library has no such type.
    """
    chosen = START_FROM[kind] if name is None else name
    require_held(f"retarder-synth init: the {kind.noun}", kind, chosen, BUILT_IN)
    text = BUILT_IN.file(kind, chosen).text
    return "\n".join((*head(kind, chosen), "", text.rstrip("\n"), *source_lines([text]))) + "\n"


def head(kind: Kind, name: str) -> Iterator[str]:
    """What stands above the file."""
    used = NAMED_IN[kind]
    own = f"my-{name}"
    yield f"# A {kind.noun} of retarder-synth to start your own from; this one is {name} of the library."
    yield f"# Save it as, say, my-types/{kind.folder}/{own}.toml; the file's name is the name of the type."
    yield f"# Use it by path, {used.format(f'my-types/{kind.folder}/{own}.toml')},"
    yield f'# or by name, {used.format(own)}, with  library = ["my-types/"]  at the top of the configuration.'
    yield "# Each number has a value, a sensible range that holds it, a source in your words and a confidence (H, M-H,"
    yield '# M, L-M, L). A source that begins with "engineering judgement" marks the number as assumed.'
    yield FORM[kind]
