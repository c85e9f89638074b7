"""Tables in an HDF5 book, as the documents that their JSON files would hold; the only part that needs h5py."""

from __future__ import annotations

import hashlib
import io
import math
import re
from collections.abc import Mapping
from typing import Any, Final

from synth.checker.book_layout import (
    NUMBER,
    axes_of,
    datasets_of,
    require_axes,
    require_filled_up,
    require_stored,
)
from synth.checker.canonical import canonical_form
from synth.checker.document_shape import (
    ESTIMATOR_COUNTS,
    ESTIMATOR_NUMBERS,
    ESTIMATOR_ROWS,
    GAUGE,
    NO_GAUGE,
    SLOPES,
    TEXT,
    is_a,
)
from synth.checker.finding import DamagedError, shown
from synth.checker.source_file import LARGEST_BYTES

SIGNATURE: Final = b"\x89HDF\r\n\x1a\n"
SEAL: Final = b"\n# sealed, sha256 of all before this line: "
NUMBERED: Final = frozenset({"schema_version", "complete"})
ATTRIBUTES: Final = NUMBERED | {"format", "tool_version", "config_sha256", "payload_sha256"}
SHA256: Final = re.compile("[0-9a-f]{64}")

Row = Mapping[str, Any]


def read_documents(content: bytes) -> list[dict[str, Any]]:
    """The documents of the tables in a book, less their checksums, in their order; `DamagedError` otherwise."""
    body = unsealed(content)
    try:
        import h5py
    except ImportError:
        raise DamagedError("it is an HDF5 book, which cannot be checked without h5py; install h5py") from None
    try:
        with h5py.File(io.BytesIO(body), "r") as book:
            columns = checked_columns(book)
            rows = range(len(columns["id"]))
            documents = [document_of({name: column[row] for name, column in columns.items()}) for row in rows]
            require_filled_up(columns, documents)
            return documents
    except DamagedError:
        raise
    except Exception as fault:  # h5py tells what it finds wrong in a dozen types
        raise DamagedError(f"it is no readable book ({type(fault).__name__}: {fault})") from None


def unsealed(content: bytes) -> bytes:
    """What stands before the seal, which must fit."""
    if not content.startswith(SIGNATURE):
        raise DamagedError("it is no HDF5 file")
    body, mark, rest = content.rpartition(SEAL)
    if not mark or rest != hashlib.sha256(body).hexdigest().encode("ascii") + b"\n":
        raise DamagedError("its seal is missing or broken: it was cut off, edited, or made by another program")
    return body


def checked_columns(book: Any) -> dict[str, list[Any]]:
    """All columns as lists, once attributes, names and `payload_sha256` are right."""
    attributes = root_attributes(book)
    version = attributes["schema_version"]
    names = datasets_of(version, set(book))
    unlike = set(book) ^ (names.keys() | axes_of(names))
    if unlike:
        raise DamagedError(f"the datasets {shown(sorted(unlike))} are missing or unknown")
    stored = attributes.pop("payload_sha256")
    for name in book:
        require_own(book, name)
    for name in names:
        require_stored(name, book[name], names[name])
    values = {name: book[name][()] for name in names}
    described = {
        name: {
            "dtype": array.dtype.str,
            "shape": list(array.shape),
            "units": book[name].attrs["units"],
            "meaning": book[name].attrs["meaning"],
            "sha256": hashlib.sha256(array.tobytes()).hexdigest(),
        }
        for name, array in values.items()
    }
    payload = canonical_form({"attributes": attributes, "datasets": described})
    if stored != hashlib.sha256(payload.encode("utf-8")).hexdigest():
        raise DamagedError("its payload_sha256 does not fit its content")
    if NUMBER in values and not values[NUMBER].any():
        raise DamagedError(f"it holds {NUMBER}, but none of its tables states one")
    require_axes(book, values, names)
    if "estimator_breaks" in values and not values["estimator_breaks"].any():
        raise DamagedError("it holds estimators, but none of its tables has one")
    if version == 3 and not (values["approach_entrance_stage"] >= 0).any():
        raise DamagedError("its schema_version is 3, but none of its tables has an approach")
    if version == 5 and not values["at_any_time"].any():
        raise DamagedError("its schema_version is 5, but none of its tables decides at any time")
    return {name: array.tolist() for name, array in values.items()}


def require_own(book: Any, name: str) -> None:
    """Raise `DamagedError` unless the dataset lies in this very file, for HDF5 can point anywhere, and is not huge."""
    import h5py

    if not isinstance(book.get(name, getlink=True), h5py.HardLink) or not isinstance(book[name], h5py.Dataset):
        raise DamagedError(f"{name} is no dataset of its own")
    dataset = book[name]
    if dataset.is_virtual or dataset.external or dataset.nbytes > LARGEST_BYTES:
        raise DamagedError(f"{name} does not lie in the file, or is larger than {LARGEST_BYTES} bytes")


def root_attributes(book: Any) -> dict[str, Any]:
    """The attributes of the book itself, each a single text or whole number as documented."""
    found = {name: value.item() if getattr(value, "shape", None) == () else value for name, value in book.attrs.items()}
    whole = found.keys() == ATTRIBUTES and found["format"] == "retarder-book" and found["complete"] == 1
    whole = whole and all(type(value) is (int if name in NUMBERED else str) for name, value in found.items())
    whole = whole and is_a(TEXT, found["tool_version"]) and bool(SHA256.fullmatch(found["config_sha256"]))
    if not whole:
        raise DamagedError(f"its attributes {shown(found)} are not those of a complete book")
    return found


def document_of(row: Row) -> dict[str, Any]:
    """The document of one table."""
    predicted = {name: row[f"predicted_{name}"] for name in ("rms_m_s", "bias_m_s", "p_overspeed", "switchings")}
    if not math.isnan(row["predicted_p_stall"]):
        predicted["p_stall"] = row["predicted_p_stall"]
    if row.get("predicted_passes", 0):
        predicted["passes"] = row["predicted_passes"]
    estimator, approach, any_time = estimator_section(row), approach_section(row), any_time_members(row)
    interval = {"rms_m_s": row["validated_rms_m_s"], "rms_ci95_m_s": row["validated_rms_ci95_m_s"]}
    return {
        "format": "retarder-table",
        "version": 5 if any_time else 3 if approach else 2 if estimator else 1,
        "id": text(row["id"]),
        "created": text(row["created"]),
        "generator": {
            "name": text(row["generator_name"]),
            "version": text(row["generator_version"]),
            "config_sha256": text(row["config_sha256"]),
        },
        "retarder": {
            "name": text(row["retarder"]),
            "zones_m": [zone for zone in row["zones_m"] if not math.isnan(zone[0])],
            "exit_m": row["exit_m"],
            "dead_band_kpa": row["dead_band_kpa"],
        },
        "cut": {
            "category": text(row["category"]),
            **({NUMBER: row[NUMBER]} if row.get(NUMBER) else {}),
            "mass_t": row["mass_t"],
            "axle_offsets_m": [x for x in row["axle_offsets_m"] if not math.isnan(x)],
        },
        "target_speed_m_s": row["target_speed_m_s"],
        "polynomial": {"variable": "s_m", "degree": row["degree"]},
        "stages": [stage_of(row, k) for k in range(row["n_stages"])],
        "valid": {"s_m": row["valid_s_m"], "v_m_s": row["valid_v_m_s"]},
        "predicted": predicted,
        "validated": {"passes": row["validated_passes"], **interval} if row["validated_passes"] else None,
        **({"estimator": estimator} if estimator else {}),
        **({"approach": approach} if approach else {}),
        **any_time,
    }


def any_time_members(row: Row) -> dict[str, Any]:
    """What the document of a table says of when it decides, nothing for one at rest; `DamagedError` for odd cells."""
    any_time, gauge = row.get("at_any_time", 0), row.get("has_gauge", 0)
    if any_time not in (0, 1) or gauge not in (0, any_time):
        cells = f"at_any_time {any_time} and has_gauge {gauge}"
        raise DamagedError(f"{text(row['id'])!r} has {cells}, but each is 0 or 1, and a gauge is for any time only")
    return {"decisions": "at_any_time", "pressure": GAUGE if gauge else NO_GAUGE} if any_time else {}


def approach_section(row: Row) -> dict[str, Any] | None:
    """The approach of one table, None where it has none; `DamagedError` where its two cells do not say the same."""
    length_m, stage = row.get("approach_length_m", math.nan), row.get("approach_entrance_stage", -1)
    if math.isnan(length_m) != (stage == -1):
        raise DamagedError(f"{text(row['id'])!r} has an approach of {length_m} m and the entrance stage {stage}")
    return None if stage == -1 else {"length_m": length_m, "entrance_stage": stage, "interlock": "position_clear"}


def estimator_section(row: Row) -> dict[str, Any] | None:
    """The estimator of one table, None where it has none; `DamagedError` where its rows are not that long."""
    breaks = row.get("estimator_breaks", 0)
    numbers = {name: row.get(f"estimator_{name}", math.nan) for name in ESTIMATOR_NUMBERS}
    counts = {name: row.get(f"estimator_{name}", 0) for name in ESTIMATOR_COUNTS}
    rows = {name: row.get(f"estimator_{name}", []) for name in ESTIMATOR_ROWS}
    filled = {breaks if not math.isnan(value) else 0 for value in numbers.values()}
    filled |= {breaks if value else 0 for value in counts.values()}
    filled |= {sum(not math.isnan(x) for x in values) for values in rows.values()}
    if filled != {breaks} or any(math.isnan(x) for values in rows.values() for x in values[:breaks]):
        raise DamagedError(f"the estimator of {text(row['id'])!r} has {breaks} breaks, but not as many values")
    return numbers | counts | {name: values[:breaks] for name, values in rows.items()} if breaks else None


def stage_of(row: Row, k: int) -> dict[str, Any]:
    """Stage `k` of one table."""
    powers = row["degree"] + 1
    lower, upper = (row["coefficients"][k][line][:powers] if row["has_line"][k][line] == 1 else None for line in (0, 1))
    stage = {"k": k, "pressure_kpa": row["pressure_kpa"][k], "lower": lower, "upper": upper}
    if row.get("has_gauge", 0):
        slopes = zip(SLOPES, (lower, upper), row["slopes"][k], strict=True)
        stage |= {key: None if line is None else slope for key, line, slope in slopes}
    return stage


def text(value: bytes) -> str:
    """A cell of text."""
    return value.decode("utf-8")
