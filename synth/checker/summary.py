"""summary.json of a tune: the configuration, what it says of the tables, nominal and off nominal, and the hashes
of the files beside it.

What a summary says of tables off nominal: its shape, and what its figures must keep among themselves. The changed
plants are those of the program that made the summary, so nothing is simulated anew here.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from synth.checker.claims import PredictionRatio
from synth.checker.content import canonical_form, content_of, parse_json
from synth.checker.document_shape import COUNT, NUMBER, TEXT, OrNull, require_shape
from synth.checker.finding import DamagedError, shown
from synth.checker.passages.table import PassageTable
from synth.checker.plant import Plant, Reader, UnusableConfigError, config_sha256, plant_of
from synth.checker.table_reading import Table

KEYS: Final = ("low_friction", "slow_valves", "lost_readings", "wrong_weight")
"""Every condition; each must be told of."""

INTERVAL: Final[Mapping[str, Any]] = {"value": NUMBER, "low95": NUMBER, "high95": NUMBER, "n": COUNT}
FOUND: Final[Mapping[str, Any]] = {
    "label": TEXT,
    "target_speed_m_s": NUMBER,
    "key": TEXT,
    "condition": TEXT,
    "change": TEXT,
    "rms_m_s": INTERVAL,
    "ratio": OrNull(INTERVAL),
    "overspeed": INTERVAL,
    "stalled": INTERVAL,
    "impossible": OrNull(TEXT),
}
NOT_POSSIBLE: Final[Mapping[str, Any]] = {
    **FOUND,
    **dict.fromkeys(("change", "rms_m_s", "ratio", "overspeed", "stalled"), OrNull(TEXT)),
    "impossible": TEXT,
}
CONDITION_FIGURES: Final = ("rms_m_s", "ratio", "overspeed", "stalled")
SHARES: Final = ("overspeed", "stalled")


def off_nominal_faults(rows: list[Any], validated: Any) -> Iterator[str]:
    """Where the `rows` of a case are no such figures, or contradict themselves.

    `validated`: passes that its table was simulated on.
    """
    keys = [row.get("key") if isinstance(row, dict) else None for row in rows]
    if sorted(map(str, keys)) != sorted(KEYS):
        yield f"summary.json says of it off nominal {shown(keys)}, but it must tell of {', '.join(KEYS)}, each once"
        return
    for key, row in zip(keys, rows, strict=True):
        fault = condition_fault(row, validated)
        if fault:
            yield f"summary.json says of it off nominal, {key}: {fault}"


def condition_fault(row: Any, validated: Any) -> str | None:
    """What is wrong with the figures of one condition, of no more passes than the `validated` ones, if anything is."""
    impossible = row.get("impossible") is not None
    try:
        require_shape(row, NOT_POSSIBLE if impossible else FOUND, "")
    except DamagedError as error:
        return str(error)
    if impossible:
        return None
    for name, of in ((name, row[name]) for name in CONDITION_FIGURES if row[name] is not None):
        if not 0.0 <= of["low95"] <= of["value"] <= of["high95"]:
            return f"{name} is {shown(of['value'])}, which is outside its interval {shown([of['low95'], of['high95']])}"
        if of["n"] < 1 or not isinstance(validated, int) or of["n"] > validated:
            return f"{name} of {shown(of['n'])} passes, but the table was simulated on {shown(validated)}"
    if any(row[share]["high95"] > 1.0 for share in SHARES):
        return "a share above 1"
    return None


DEFAULT_PREDICTION_RATIO: Final = PredictionRatio(0.9, 1.1)
"""Where no configuration sets others."""
CARRIERS: Final = ("book.h5", "tables/", "c/", "st/")
"""What files that hold tables are called; pictures and report may go without a word."""
FIGURES: Final = ("rms_m_s", "bias_m_s", "p_overspeed", "switchings", "p_stall", "passes")
"""What a table predicts of itself; in a summary each name begins with `predicted_`."""
TUNE: Final = "tune"
MAKERS: Final = (TUNE, "sweep run")
"""Commands whose summaries tell of tables."""


@dataclass(frozen=True)
class Summary:
    """What the file holds; `config_sha256` is what it says of its configuration.

    `off_nominal`: what its tables do off nominal, by label and target of the case; None where it need not say so, as
    only a tune with radar must.
    """

    path: Path
    config: Mapping[str, Any]
    config_sha256: str
    cases: Mapping[str, Mapping[str, Any]]
    files: Mapping[str, str]
    off_nominal: Mapping[tuple[Any, Any], list[Any]] | None

    def config_fault(self) -> str | None:
        """Why the configuration is not the one that the tables were made from, if it is not."""
        try:
            found = config_sha256(self.config)
        except (ValueError, OverflowError, RecursionError):
            found = "none"
        if found == self.config_sha256:
            return None
        return f"its configuration hashes to {found[:16]}…, but it says {self.config_sha256[:16]}…"

    def prediction_ratio(self) -> PredictionRatio:
        """The limits that predicted rms / simulated rms must keep."""
        at = Reader(self.config)
        try:
            low, high = (
                at.number("acceptance.prediction_ratio_low", 0.1, 1.0),
                at.number("acceptance.prediction_ratio_high", 1.0, 10.0),
            )
        except UnusableConfigError:
            return DEFAULT_PREDICTION_RATIO
        return PredictionRatio(low, high)

    @property
    def estimating(self) -> bool:
        """Whether the tables are to have an estimator."""
        regulator = self.config.get("regulator")
        return isinstance(regulator, dict) and regulator.get("estimator") is True

    def command_faults(self, table: Table) -> Iterator[str]:
        """Where the regulator of the configuration commands at other times than `table`, or has another gauge.

        Without such keys it commands at rest.
        """
        section = self.config.get("regulator")
        regulator = section if isinstance(section, dict) else {}
        wanted = regulator.get("commands", "at_rest"), regulator.get("pressure", "gauge")
        own = "any_time" if table.at_any_time else "at_rest", "gauge" if table.has_gauge else "none"
        if wanted[0] != own[0]:
            yield f"its configuration asks for commands {shown(wanted[0])}, but it is for commands {shown(own[0])}"
        elif table.at_any_time and wanted[1] != own[1]:
            yield f"its configuration says of the pressure {shown(wanted[1])}, but it says {shown(own[1])}"

    def plant(self, table: Table | PassageTable) -> Plant:
        """The plant that `table` is for; `UnusableConfigError` if the configuration has none that fits it.

        A table for point sensors says itself where the regulator begins to act.
        """
        cuts = self.config.get("cut")
        for cut in cuts if isinstance(cuts, list) else []:
            if not isinstance(cut, dict) or cut.get("category") != table.category:
                continue
            plant = plant_of(self.config, cut)
            if isinstance(table, PassageTable):
                plant = replace(plant, approach_m=table.approach_m, initial_stage=table.initial_stage)
            if (plant.mass_t, plant.axle_offsets_m) == (table.mass_t, table.axle_offsets_m):
                require_fit(plant, table)
                return plant
        raise UnusableConfigError("the configuration beside it has no cut of its category, mass and axles")

    def case_faults(self, table: Table | PassageTable) -> Iterator[str]:
        """Where the summary states other figures than the table, or of its off-nominal plants what cannot be."""
        case = self.cases.get(table.id)
        if case is None:
            yield "summary.json does not tell of it"
            return
        predicted = table.document["predicted"]
        for name in FIGURES:
            said, other = predicted.get(name), case.get(f"predicted_{name}")
            if said != other:
                yield f"its predicted {name} is {shown(said)}, but summary.json says {shown(other)}"
        stated = rms_of(case)
        for name, value in (table.document["validated"] or {}).items():
            if stated.get(name) != value:
                yield f"its validated {name} is {shown(value)}, but summary.json says {shown(stated.get(name))}"
        if self.off_nominal is not None:
            rows = self.off_nominal.get((case.get("label"), case.get("target_speed_m_s")), [])
            yield from off_nominal_faults(rows, stated.get("passes"))

    def file_faults(self) -> Iterator[tuple[str, str]]:
        """(file, sentence) for each file with tables that is not what the summary lists."""
        for name, sha256 in sorted(self.files.items()):
            path = self.path.parent / name
            if not name.startswith(CARRIERS):
                continue
            if not path.is_file():
                yield name, "summary.json lists it, but it is not there"
            elif hashlib.sha256(content_of(path)).hexdigest() != sha256:
                yield name, "its SHA-256 is not the one in summary.json"


def require_fit(plant: Plant, table: Table | PassageTable) -> None:
    """Raise `UnusableConfigError` where plant and table differ in what both state."""
    clock: list[tuple[str, float, float]] = []
    if isinstance(table, Table):  # one for point sensors has all about its clock itself
        clock.append(("sampling period", plant.period_s, table.sample_period_s))
        clock.append(("computing delay", plant.computing_s, table.computing_delay_s))
    for name, one, other in (
        *clock,
        ("zones", plant.zones_m, table.zones_m),
        ("stage pressures", plant.stages_kpa, table.pressures_kpa),
        ("dead band", plant.drive.band_kpa, table.dead_band_kpa),
        ("approach", plant.approach_m, table.approach_m),
    ):
        if one != other:
            raise UnusableConfigError(f"the configuration beside it has other {name}: {shown(one)}, not {shown(other)}")
    if plant.approach_m > 0.0 and plant.entrance_stage != table.entrance_stage:
        raise UnusableConfigError(
            f"the configuration beside it allows stage {plant.entrance_stage} before the entrance, not "
            f"{table.entrance_stage}"
        )
    low, high = plant.entry.low_m_s, plant.entry.high_m_s
    flat = [edge for zone in plant.zones_m for edge in zone]
    if low > high or sorted(flat) != flat or sorted(plant.axle_offsets_m) != list(plant.axle_offsets_m):
        raise UnusableConfigError("the configuration beside it describes no possible plant")


class OtherSummaryError(Exception):
    """A summary of a command whose figures the checker knows nothing of."""


def read_summary(path: Path) -> Summary:
    """The summary in the file `path`; `DamagedError` for what is no summary, `OtherSummaryError`."""
    document = parse_json(content_of(path), 64 * 2**20)
    match document:
        case {
            "format": "retarder-synth-summary",
            "command": str(command),
            "config": dict(config),
            "generator": {"config_sha256": str(sha256)},
            "tables": {"cases": list(cases)} as tables,
            "files": dict(files),
        } if command in MAKERS:
            canonical_form(document)  # nothing in it that JSON cannot hold faithfully
            named = {case["id"]: case for case in cases if isinstance(case, dict) and isinstance(case.get("id"), str)}
            hashes = {name: sha for name, sha in files.items() if isinstance(sha, str) and is_inside(name)}
            with_radar = command == TUNE and "sensors" not in config
            off_nominal = by_case(tables.get("off_nominal")) if with_radar else None
            return Summary(path, config, sha256, named, hashes, off_nominal)
        case {"format": "retarder-synth-summary", "command": str(command)} if command not in MAKERS:
            raise OtherSummaryError(command)
    raise DamagedError("it is no summary of a tune")


def rms_of(case: Mapping[str, Any]) -> dict[str, Any]:
    """The simulated rms of a case in the names of a table: passes, rms and its interval."""
    rms = case.get("rms_m_s")
    if not isinstance(rms, dict):
        return {}
    ends = [rms.get("low95"), rms.get("high95")]
    return {"passes": rms.get("n"), "rms_m_s": rms.get("value"), "rms_ci95_m_s": ends}


def by_case(rows: Any) -> dict[tuple[Any, Any], list[Any]]:
    """The rows of a table by the case that they tell of."""
    found: dict[tuple[Any, Any], list[Any]] = {}
    for row in rows if isinstance(rows, list) else []:
        of = row if isinstance(row, dict) else {}
        label, target = of.get("label"), of.get("target_speed_m_s")
        if isinstance(label, str) and isinstance(target, int | float):
            found.setdefault((label, target), []).append(row)
    return found


def is_inside(name: str) -> bool:
    """Whether a file name stays in its directory."""
    return not Path(name).is_absolute() and ".." not in Path(name).parts and "\0" not in name
