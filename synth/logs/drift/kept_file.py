"""The file in which a watch keeps a position from run to run: arrays of numpy under a seal."""

from __future__ import annotations

import io
import zipfile
from dataclasses import fields
from types import MappingProxyType
from typing import Any, Final

import numpy as np

from synth.logs.drift.kept_watch import KeptWatch
from tuning_tables import DamagedTable
from tuning_tables.pass_log.pass_log import PassLog
from tuning_tables.seal import seal_of, unsealed

DEPENDS: Final = "config_sha256"
OF_LOG: Final = "log."


def to_npz(kept: KeptWatch, config_sha256: str) -> bytes:
    """The content of the file; `config_sha256`: of the configuration that drifts are counted from."""
    arrays: dict[str, Any] = {
        DEPENDS: np.array(config_sha256),
        "seen": kept.seen,
        "value_keys": np.array(list(kept.values), dtype=np.str_),
        "values": np.array(list(kept.values.values()), dtype=np.float64),
        "first": np.array(kept.first),
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
                first=int(arrays["first"]),
                names=tuple(arrays["names"].tolist()),
                sums=arrays["sums"],
                limit=float(arrays["limit"]),
            )
            return kept if str(arrays[DEPENDS]) == config_sha256 else kept.anew()
    except (KeyError, ValueError, zipfile.BadZipFile) as fault:
        raise DamagedTable(
            f"{source}: this is not what a watch keeps of a position ({str(fault)[:100]}); remove it, and the watch on "
            "this position begins anew."
        ) from None


def log_in(arrays: Any) -> PassLog | None:
    """The passes of the file, None where there are none."""
    if f"{OF_LOG}time_s" not in arrays:
        return None
    found: dict[str, Any] = {each.name: arrays[f"{OF_LOG}{each.name}"] for each in fields(PassLog)}
    texts = {name: tuple(found[name].tolist()) for name in ("cut_id", "category")}
    return PassLog(**{**found, **texts, "path_is_independent": bool(found["path_is_independent"])})
