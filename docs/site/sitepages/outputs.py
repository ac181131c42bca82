"""Reference of the outputs of a run, made from the table of their kinds."""

from __future__ import annotations

from mascarin.building.outputs.kinds import KINDS


def page() -> str:
    """The page: a table of all kinds."""
    lines = [
        "# Outputs",
        "",
        f"All {len(KINDS)} kinds of outputs. `mascarin outputs building.yaml` lists those of one building by "
        "name; `mascarin run --output NAME`, `mc.simulate(outputs=[...])` and the sensors of a study take "
        "these names. Words in capitals stand for names of the description, N for a number counted from "
        "outside.",
        "",
        "A *mean* is that of the interval that ends at the time of the record; a *state* is that at the time "
        "of the record. *Recorded* says whether a run records it without being asked.",
        "",
        "| name | unit | meaning | exists for | value | recorded |",
        "|---|---|---|---|---|---|",
    ]
    for one in KINDS.values():
        names = ", ".join(f"`{name}`" for name in one.patterns)
        value = "mean" if one.mean else "state"
        recorded = "yes" if one.usual else ""
        lines.append(f"| {names} | {one.unit} | {one.meaning} | {one.exists} | {value} | {recorded} |")
    return "\n".join(lines) + "\n"
