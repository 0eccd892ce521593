"""Run the benchmarks, print their tables and keep them in benchmarks/.

`python -m benchmarks` runs all; `python -m benchmarks restitution`, `engine [--full]`, `studies`, `bed`, `spatial`,
`hull` or `longrun` one part. `python -m benchmarks house` measures the code instead: its size, names, circles, paths.
"""

import argparse
import platform
import sys

import numpy as np

from benchmarks import bed, engine, house, hull, ked, longrun, section, spatial, start, studies, table
from benchmarks.table import Row

PARTS = ("restitution", "engine", "studies", "bed", "spatial", "hull", "longrun")
PARTS_ALONE = ("house",)  # not of speed


def rows() -> list[Row]:
    """Every benchmark of bodies and restitution."""
    table_rows = []
    for comparison in ked.comparisons():
        faster = comparison.ratio >= 1.0
        measured = f"{comparison.ratio:,.0f} times faster" if faster else f"{1.0 / comparison.ratio:.2f} times its cost"
        goal = _goal(comparison.goal)
        cost = f"{comparison.ours * 1e9:.2f} ns against {comparison.theirs * 1e9:,.2f} ns a {comparison.unit}"
        table_rows.append(Row(comparison.subject, comparison.against, f"{measured} ({cost})", goal, comparison.met))
    spent = section.seconds()
    table_rows.append(
        Row(
            f"Section of {section.VERTICES:,} vertices, checks and KED",
            "-",
            f"{spent * 1e3:.1f} ms",
            f"< {section.GOAL * 1e3:.0f} ms",
            spent < section.GOAL,
        )
    )
    table_rows += [
        Row(description, "-", f"{spent:.3f} s", f"< {goal} s", spent < goal)
        for description, spent, goal in start.starts()
    ]
    return table_rows


def _goal(goal: float | None) -> str:
    if goal is None:
        return "for information"
    return f">= {goal:,.0f} times" if goal >= 1.0 else f"<= {1.0 / goal:.0f} times"


def restitution() -> bool:
    """Print and keep the table of bodies and restitution; whether every goal was met."""
    table_rows = rows()
    text = [
        "# Speed",
        "",
        "Medians of interleaved repeats, CPU time, one run; made by `make bench`.",
        "",
        f"Python {platform.python_version()}, numpy {np.__version__}, {platform.machine()}.",
        "",
        *table.lines(table_rows),
    ]
    table.keep("RESULTS.md", text)
    return all(row.met is not False for row in table_rows)


def main() -> None:
    """Run the selected benchmarks; exit with status 1 if a goal is missed."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description="Speed, as ratios in one run.")
    parser.add_argument("part", nargs="?", choices=("all", *PARTS, *PARTS_ALONE), default="all")
    parser.add_argument("--full", action="store_true", help="engine: more repeats, more histories of slow peers")
    parser.add_argument("--histories", type=int, default=10_000, help="engine: fewer for a trial, not kept")
    options = parser.parse_args()
    good = True
    if options.part in {"all", "restitution"}:
        good = restitution()
    if options.part in {"all", "engine"}:
        good = engine.main(full=options.full, count=options.histories) and good
    if options.part in {"all", "studies"}:
        good = studies.main() and good
    for name, module in (("bed", bed), ("spatial", spatial), ("hull", hull), ("longrun", longrun)):
        if options.part in {"all", name}:
            good = module.main() and good
    if options.part == "house":
        good = house.main()
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
