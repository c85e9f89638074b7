"""A table of a configuration file, and a numerical setting in it."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ConfigDict, Field


def setting(default: float, unit: str, low: float, high: float, meaning: str) -> Any:
    """A numerical setting with its unit, its limits (both allowed) and what it means."""
    return Field(default, ge=low, le=high, description=meaning, json_schema_extra={"unit": unit})


class Section(BaseModel):
    """A table of the file: unknown keys, wrong types, inf and nan are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)
