"""The file in which a watch keeps a position from run to run: arrays of numpy under a seal."""

from __future__ import annotations

import io
from dataclasses import fields
from types import MappingProxyType
from typing import Any, Final

import numpy as np

from synth.frame.damaged_archive import NO_ARCHIVE
from synth.logs.drift.kept_watch import KeptWatch
from tuning_tables import DamagedTable
from tuning_tables.pass_log.pass_log import PassLog
from tuning_tables.seal import seal_of, unsealed

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
