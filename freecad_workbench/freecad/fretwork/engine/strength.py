"""What `fretwork verify` says of the strength of a result, in words."""

from __future__ import annotations

from typing import Any, Mapping


def strength_lines(facts: Mapping[str, Any]) -> list[str]:
    """The facts of `verify --json`: whether it holds, each load, the weakest places."""
    strength = facts.get("strength")
    if not strength:
        return ["whether it holds is not known: the analysis could not be made"]
    verdict = "holds" if strength["holds"] else "does not hold as asked"
    lines = [f"{verdict}: factor of safety {strength['factor_of_safety']:.3g}, asked is {strength['safety_factor']:.3g}"]
    for case in strength["cases"]:
        lines.append(f"{case['name']}: factor {case['factor_of_safety']:.3g}, "
                     f"moves by {case['max_displacement_mm']:.2g} mm")  # fmt: skip
    for place in strength["weakest"][:3]:
        x, y, z = place["at_mm"]
        lines.append(f"weak at ({x:.1f}, {y:.1f}, {z:.1f}) mm: factor {place['factor_of_safety']:.3g}, {place['case']}")
    if "stress_scale_mpa" in strength:
        low, high = strength["stress_scale_mpa"]
        lines.append(f"colours: from {low:g} MPa (dark blue) to {high:g} MPa (yellow)")
    return lines
