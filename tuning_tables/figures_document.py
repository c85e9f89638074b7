"""What was predicted and what was confirmed of a table, as sections of a JSON document, and back."""

from __future__ import annotations

from tuning_tables.figures import Predicted, Validated
from tuning_tables.section import Section


def predicted_document(predicted: Predicted) -> dict[str, object]:
    """The section "predicted"; what was not computed is left out."""
    document: dict[str, object] = {
        "rms_m_s": float(predicted.rms_m_s),
        "bias_m_s": float(predicted.bias_m_s),
        "p_overspeed": float(predicted.p_overspeed),
        "switchings": float(predicted.switchings),
    }
    if predicted.p_stall is not None:
        document["p_stall"] = float(predicted.p_stall)
    if predicted.passes is not None:
        document["passes"] = predicted.passes
    return document


def validated_document(validated: Validated | None) -> dict[str, object] | None:
    """The section "validated", null before a closed loop was run."""
    if validated is None:
        return None
    low, high = validated.rms_ci95_m_s
    return {
        "passes": validated.passes,
        "rms_m_s": float(validated.rms_m_s),
        "rms_ci95_m_s": [float(low), float(high)],
    }


def read_predicted(top: Section, optional: tuple[str, ...]) -> Predicted:
    """The section "predicted" of the document, which may hold `optional` besides."""
    section = top.section("predicted", ("rms_m_s", "bias_m_s", "p_overspeed", "switchings"), optional)
    return Predicted(
        section.number("rms_m_s"),
        section.number("bias_m_s"),
        section.number("p_overspeed"),
        section.number("switchings"),
        section.number("p_stall") if "p_stall" in section else None,
        section.count("passes") if "passes" in section else None,
    )


def read_validated(top: Section) -> Validated | None:
    """The section "validated" of the document, None for null."""
    if top.value("validated") is None:
        return None
    section = top.section("validated", ("passes", "rms_m_s", "rms_ci95_m_s"))
    return Validated(section.count("passes"), section.number("rms_m_s"), section.pair("rms_ci95_m_s"))
