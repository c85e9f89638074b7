"""A watch that goes on from run to run: what is kept of a position, its file (arrays of numpy under a seal), and
what the passes of a night make of it.
"""

from __future__ import annotations

import hashlib
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from types import MappingProxyType
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.frame.damaged_archive import NO_ARCHIVE
from synth.logs.drift.causes import Cause, causes_of
from synth.logs.drift.charts import Charts, kinds_of, limit_of, page_sums, steps_of
from synth.logs.drift.diagnosis import BACK, FURTHER
from synth.logs.drift.evidence import configured, evidence_of
from synth.logs.drift.watch import Watch, explained
from synth.logs.fitting_passes import fitting_passes
from synth.retarder.configuration.resolved_config import ResolvedConfig
from tuning_tables import DamagedTable
from tuning_tables.pass_log.pass_log import ROWS, PassLog, join_logs
from tuning_tables.whole_file import seal_of, unsealed

LEAST_KEPT: Final = 100
"""Passes that are kept at least: those ahead of a drift tell what exits were in order."""

MOST_KEPT: Final = 400
"""And at most, while nothing has drifted."""


@frozen_arrays
class KeptWatch:
    """What is kept of a position between two runs.

    `values`: the numbers that drifts are counted from. `log`: the last passes, of which the first is number `first`
    of all that were watched; None before there are any. `sums` (m, charts) after each, by `names`. `limit`: where a
    sum gave the alarm; NaN while none has. `seen`: digests of all passes that were ever read, each once, rising.
    `run`: the number of the run that read the last `new` of them; `repaired`: of the last one told of a repair.
    """

    seen: NDArray[np.uint64] = field(default_factory=lambda: np.empty(0, np.uint64))
    values: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))
    log: PassLog | None = None
    first: int = 0
    names: tuple[str, ...] = ()
    sums: Floats = field(default_factory=lambda: np.empty((0, 0)))
    limit: float = float("nan")
    run: int = 0
    new: int = 0
    repaired: int = -1

    @property
    def watched(self) -> int:
        """Passes that were watched so far, until the cause of a drift was sought no longer."""
        return self.first + len(self.sums)

    @property
    def alarm(self) -> int | None:
        """The kept pass after which a sum reached the limit."""
        over = np.flatnonzero((self.sums >= self.limit).any(axis=1))
        return int(over[0]) if len(over) else None

    def anew(self) -> KeptWatch:
        """After a repair, or with other numbers: passes that were read stay read, and nothing else is kept."""
        return KeptWatch(self.seen, run=self.run, repaired=self.repaired)

    def in_run(self, run: int, is_repaired: bool) -> KeptWatch:
        """What run number `run` begins with; it has read something where it was killed and goes on."""
        begun = self.anew() if is_repaired and self.repaired != run else self
        repaired = run if is_repaired else self.repaired
        return replace(begun, run=run, new=begun.new if self.run == run else 0, repaired=repaired)

    def sums_by(self, names: Sequence[str]) -> Floats:
        """The sums of charts `names`, 0 of those that are new, (m, charts)."""
        found = np.zeros((len(self.sums), len(names)))
        for column, name in enumerate(names):
            if name in self.names:
                found[:, column] = self.sums[:, self.names.index(name)]
        return found


@dataclass(frozen=True, eq=False)
class WatchedNight:
    """What a run makes of a position: what is `kept`, and what has drifted, if anything."""

    kept: KeptWatch
    limit: float
    found: Watch | None

    @property
    def new(self) -> int:
        """How many passes were new."""
        return self.kept.new

    @property
    def highest(self) -> float:
        """The highest sum of now."""
        return float(self.kept.sums[-1].max(initial=0.0)) if len(self.kept.sums) else 0.0


def chart_names(causes: Sequence[Cause]) -> tuple[str, ...]:
    """A name for each chart that stays the same from run to run."""
    return tuple(f"{causes[number].name} {size!r}" for number, size in kinds_of(causes))


def digests(log: PassLog) -> NDArray[np.uint64]:
    """What tells each pass from all others, (m,): a hash of its rows; a name may be given twice."""
    found = np.empty(len(log), np.uint64)
    for number in range(len(log)):
        digest = hashlib.sha256()
        for name in ROWS:
            digest.update(np.ascontiguousarray(getattr(log, name)[log.rows(number)]).tobytes())
        found[number] = np.frombuffer(digest.digest()[:8], np.uint64)[0]
    return found


def watched_night(
    kept: KeptWatch, log: PassLog | None, config: ResolvedConfig, place: str, run_length: float
) -> WatchedNight:
    """`kept` with those passes of `log` that it has not seen; `place`: what messages call the configuration.

    `run_length`: passes of this position between two false alarms, at least. After an alarm passes are taken only until
    its cause is sought no longer. `InputError` for cuts that no class of `config` fits.
    """
    alarm = kept.alarm
    if log is not None:
        own = digests(log)
        _, once = np.unique(own, return_index=True)
        is_new = np.isin(np.arange(len(log)), once) & ~np.isin(own, kept.seen)
        kept = replace(kept, seen=np.union1d(kept.seen, own), new=kept.new + int(is_new.sum()))
        numbers = np.flatnonzero(is_new & ~log.stopped_by_hand)
        if alarm is not None:
            numbers = numbers[: max(0, alarm + FURTHER + 1 - len(kept.sums))]
        kept = with_passes(kept, log.taken(numbers), config, place) if len(numbers) else kept
    limit = limit_of(len(kept.names), run_length) if alarm is None and kept.names else kept.limit
    kept = replace(kept, limit=limit)
    if kept.alarm is None:
        return WatchedNight(trimmed(replace(kept, limit=float("nan"))), limit, None)
    return WatchedNight(kept, limit, found_in(kept, config, place))


def with_passes(kept: KeptWatch, log: PassLog, config: ResolvedConfig, place: str) -> KeptWatch:
    """`kept` with the sums along `log` behind it."""
    passes = fitting_passes(log, config.plants(), place)
    configured_values, slope_key = configured(passes, config.parameters)
    values = configured_values | dict(kept.values)
    causes = [cause.as_watched for cause in causes_of(passes, values, slope_key)]
    told = chart_names(causes)
    names = (*kept.names, *(name for name in told if name not in kept.names))
    before = kept.sums_by(names)
    steps = np.zeros((len(log), len(names)))
    steps[:, [names.index(name) for name in told]] = steps_of(evidence_of(passes, values, causes, slope_key))
    sums = page_sums(steps, before[-1] if len(before) else 0.0)
    joined = log if kept.log is None else join_logs((kept.log, log))
    return replace(kept, values=MappingProxyType(values), log=joined, names=names, sums=np.concatenate((before, sums)))


def found_in(kept: KeptWatch, config: ResolvedConfig, place: str) -> Watch:
    """What is behind the alarm, by all sizes of all causes."""
    assert kept.log is not None
    passes = fitting_passes(kept.log, config.plants(), place)
    slope_key = configured(passes, config.parameters)[1]
    causes = causes_of(passes, kept.values, slope_key)
    evidence = evidence_of(passes, kept.values, causes, slope_key)
    charts = Charts(kinds_of(causes), kept.sums_by(chart_names(causes)), kept.limit)
    return explained(passes, kept.first + np.arange(len(passes)), evidence, charts, kept.values, slope_key)


def trimmed(kept: KeptWatch) -> KeptWatch:
    """Without the passes that no later alarm goes back to."""
    count = len(kept.sums)
    if kept.log is None or count <= LEAST_KEPT:
        return kept
    is_zero = kept.sums <= 0.0
    last_zero = np.where(is_zero.any(axis=0), count - 1 - np.argmax(is_zero[::-1], axis=0), -1)
    begin = max(0, count - MOST_KEPT, min(int(last_zero.min()) + 1 - BACK, count - LEAST_KEPT))
    log = kept.log.taken(np.arange(begin, count))
    return replace(kept, log=log, first=kept.first + begin, sums=kept.sums[begin:])


DEPENDS: Final = "config_sha256"
OF_LOG: Final = "log."
WHOLE: Final = ("first", "run", "new", "repaired")


def to_npz(kept: KeptWatch, config_sha256: str) -> bytes:
    """The content of the file; `config_sha256`: of the configuration that drifts are counted from."""
    arrays: dict[str, Any] = {
        DEPENDS: np.array(config_sha256),
        "seen": kept.seen,
        "value_keys": np.array(list(kept.values), dtype=np.str_),
        "values": np.array(list(kept.values.values()), dtype=np.float64),
        **{name: np.array(getattr(kept, name)) for name in WHOLE},
        "names": np.array(kept.names, dtype=np.str_),
        "sums": kept.sums,
        "limit": np.array(kept.limit),
    }
    if kept.log is not None:
        arrays |= {f"{OF_LOG}{each.name}": np.array(getattr(kept.log, each.name)) for each in fields(PassLog)}
    content = io.BytesIO()
    np.savez(content, **arrays)
    body = content.getvalue()
    return body + seal_of(body)


def from_npz(content: bytes, source: str, config_sha256: str) -> KeptWatch:
    """What the file keeps; counted from another configuration, only which passes were read. `DamagedTable`."""
    body = io.BytesIO(unsealed(content, source))
    try:
        with np.load(body, allow_pickle=False) as arrays:
            kept = KeptWatch(
                seen=arrays["seen"],
                values=MappingProxyType(
                    dict(zip(arrays["value_keys"].tolist(), arrays["values"].tolist(), strict=True))
                ),
                log=log_in(arrays),
                names=tuple(arrays["names"].tolist()),
                sums=arrays["sums"],
                limit=float(arrays["limit"]),
                **{name: int(arrays[name]) for name in WHOLE},
            )
            require_fitting(kept)
            return kept if str(arrays[DEPENDS]) == config_sha256 else kept.anew()
    except (KeyError, TypeError, *NO_ARCHIVE) as fault:
        raise DamagedTable(
            f"{source}: this is not what a watch keeps of a position ({str(fault)[:100]}); remove it, and the watch on "
            "this position begins anew."
        ) from None


def require_fitting(kept: KeptWatch) -> None:
    """`ValueError` where the arrays do not belong together: a sum for each pass and chart, a hash for each pass."""
    passes = 0 if kept.log is None else len(kept.log)
    if kept.sums.shape != (passes, len(kept.names)) or kept.sums.dtype != np.float64:
        raise ValueError(f"{passes} passes and {len(kept.names)} charts have sums of the shape {kept.sums.shape}")
    if kept.seen.ndim != 1 or kept.seen.dtype != np.uint64 or kept.first < 0:
        raise ValueError("the hashes of passes, or their count, are none")


def log_in(arrays: Any) -> PassLog | None:
    """The passes of the file, None where there are none."""
    if f"{OF_LOG}time_s" not in arrays:
        return None
    found: dict[str, Any] = {each.name: arrays[f"{OF_LOG}{each.name}"] for each in fields(PassLog)}
    texts = {name: tuple(found[name].tolist()) for name in ("cut_id", "category")}
    return PassLog(**{**found, **texts, "path_is_independent": bool(found["path_is_independent"])})
