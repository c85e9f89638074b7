"""The end of a plan of point sensors in words and figures, on stdout."""

from __future__ import annotations

from pathlib import Path

from synth.book.sensors.layout_results import LayoutResults
from synth.book.sensors.layout_summary import all_places


def print_plan(results: LayoutResults, directory: Path) -> None:
    """A line for each number of sensors, what stands beside them, and which were chosen."""
    for plan in results.plans:
        places = "  ".join(f"{place:g}" for place in all_places(results, plan.best))
        print(
            f"{plan.deciding + 1} sensors: rms {plan.best.rms_m_s:.4f} m/s "
            f"(equal sections {plan.equal.rms_m_s:.4f}) at {places} m"
        )
    print(f"by the rule, {len(results.rule.deciding_m) + 1} sensors: rms {results.rule.rms_m_s:.4f} m/s")
    print(f"radar: rms {results.radar_mean_rms_m_s:.4f} m/s")
    if results.wanted_rms_m_s is None:
        wanted = "an rms of at most 1.1 times the radar's"
    else:
        wanted = f"an rms of at most {results.wanted_rms_m_s:g} m/s"
    if results.chosen is None:
        print(f"not accepted: none of these numbers of sensors gives {wanted}")
    else:
        print(f"accepted: {results.chosen.deciding + 1} sensors are the fewest that give {wanted}")
    print(f"{directory}: plots/, {'sensors.toml, ' * (results.chosen is not None)}summary.json")
