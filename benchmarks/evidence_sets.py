"""Coverage of the intervals of left-out groups of measurements, for synthetic sets of evidence; a run can be resumed.

`make evidence-sets` makes 1,000 sets of nine groups (ten minutes), stores them in build/evidence_sets.jsonl, and prints
the coverage by the fraction of the variance between groups.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.predictions import resumed
from rocking.evidence import DataSet, all_measurements
from rocking.evidence.hierarchy import left_out_groups, tree
from rocking.evidence.likelihood import scatter
from rocking.restitution import ShiftedImpulse

ROOT = Path(__file__).parents[1]
SHARES = (0.05, 0.3, 0.6, 0.9)
"""True shares of the variance between groups; the published measurements say 0.7."""

ETA, K, S, GAMMA = 0.985, 0.55, 0.12, 0.75


def made_up(number: int) -> DataSet:
    """Make nine groups up, as large and as slender as the published ones; laboratories are all others."""
    random, share, data = np.random.default_rng([39, number]), SHARES[number % len(SHARES)], all_measurements()
    groups = [name for laboratory in tree(data).values() for name in laboratory]
    names = [f"{group}: {interface}" for group, interface in zip(data.group, data.interface, strict=True)]
    effect = random.standard_normal(len(groups))[[groups.index(name) for name in names]]
    mean = ETA * ShiftedImpulse(K).of_slenderness(data.slenderness)
    deviation = np.sqrt(share) * effect + np.sqrt(1.0 - share) * random.standard_normal(len(data))
    r = np.minimum(mean + scatter(mean, S, GAMMA) * deviation, 0.9995)
    half = 0.5 * (data.high - data.low)
    return replace(data, coefficient=r, low=r - half, high=r + half, laboratory=())


def left_out(number: int) -> dict[str, Any]:
    """Return the fractions of groups and measurements within their interval, and the widths of intervals."""
    groups = left_out_groups(made_up(number))
    return {
        "share": SHARES[number % len(SHARES)],
        "groups": sum(group.within for group in groups) / len(groups),
        "measurements": sum(group.inside for group in groups) / sum(group.measurements for group in groups),
        "single": sum(group.inside for group in groups if group.measurements == 1)
        / sum(group.measurements == 1 for group in groups),
        "width": float(np.mean([group.interval_width for group in groups])),
    }


def coverage(rows: list[dict[str, Any]]) -> dict[str, float]:
    """Return the means of the results of `left_out`."""
    return {name: float(np.mean([row[name] for row in rows])) for name in rows[0]}


def main(cases: int = 1000) -> None:
    """Print the coverage."""
    rows = list(resumed(ROOT / "build" / "evidence_sets.jsonl", cases, left_out, __file__, ("evidence", "restitution")))
    kinds = {f"{share:g} between groups": [row for row in rows if row["share"] == share] for share in SHARES}
    for kind, selected in {"all": rows, **kinds}.items():
        print(f"| {kind} | {' | '.join(f'{name} {value:.4f}' for name, value in coverage(selected).items())} |")


if __name__ == "__main__":
    main()
