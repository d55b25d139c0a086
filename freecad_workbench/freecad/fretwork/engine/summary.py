"""The run report (docs/report.schema.json) in words."""

from __future__ import annotations

from typing import Any, Mapping


def _count(number: int, one: str, many: str) -> str:
    return f"{number:,} {one if number == 1 else many}"


def _pieces(report: Mapping[str, Any]) -> str:
    return _count(report["mesh"]["components"], "piece", "pieces")


def _stress(structure: Mapping[str, Any]) -> str:
    worst, allowable = structure["p99_pa"] / 1e6, structure["allowable_pa"] / 1e6
    return f"stress {structure['verdict']}: {worst:.2g} of {allowable:.3g} MPa at the 99th percentile"


def _strength(strength: Mapping[str, Any]) -> str:
    return f"factor of safety {strength['factor_of_safety']:.2f} by the full analysis"


def summary_lines(report: Mapping[str, Any]) -> list[str]:
    """What came of a run, a line each; warnings are left to warning_lines."""
    lines = [f"{_pieces(report)}, {report['pattern']['solid_fraction']:.0%} solid, "
             f"{_count(report['mesh']['triangles'], 'triangle', 'triangles')}"]  # fmt: skip
    if report.get("structure"):
        lines.append(_stress(report["structure"]))
    if report.get("strength", {}).get("factor_of_safety"):
        lines.append(_strength(report["strength"]))
    print_facts = report.get("printability", {})
    wall = f"wall {report['shell']['thickness_mm']:.2f} mm"
    if "material_mm3" in print_facts:
        lines.append(f"{print_facts['material_mm3'] / 1000:.1f} cm³ of material, {wall}")
    else:
        lines.append(wall)
    lines.append(f"{report['seconds']['total']:.1f} s")
    return lines


def warning_lines(report: Mapping[str, Any]) -> list[str]:
    """What the user should know: warnings of the run and faults of the print."""
    return [*report.get("warnings", []), *report.get("printability", {}).get("faults", [])]
