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
    found = []
    for each in ked.comparisons():
        faster = each.ratio >= 1.0
        measured = f"{each.ratio:,.0f} times faster" if faster else f"{1.0 / each.ratio:.2f} times its cost"
        goal = _goal(each.goal)
        cost = f"{each.ours * 1e9:.2f} ns against {each.theirs * 1e9:,.2f} ns a {each.unit}"
        found.append(Row(each.subject, each.against, f"{measured} ({cost})", goal, each.met))
    spent = section.seconds()
    found.append(
        Row(
            f"Section of {section.VERTICES:,} vertices, checks and KED",
            "-",
            f"{spent * 1e3:.1f} ms",
            f"< {section.GOAL * 1e3:.0f} ms",
            spent < section.GOAL,
        )
    )
    found += [Row(what, "-", f"{spent:.3f} s", f"< {goal} s", spent < goal) for what, spent, goal in start.starts()]
    return found


def _goal(goal: float | None) -> str:
    if goal is None:
        return "for information"
    return f">= {goal:,.0f} times" if goal >= 1.0 else f"<= {1.0 / goal:.0f} times"


def restitution() -> bool:
    """Print and keep the table of bodies and restitution; whether every goal was met."""
    found = rows()
    text = [
        "# Speed",
        "",
        "Medians of interleaved repeats, CPU time, one run; made by `make bench`.",
        "",
        f"Python {platform.python_version()}, numpy {np.__version__}, {platform.machine()}.",
        "",
        *table.lines(found),
    ]
    table.keep("RESULTS.md", text)
    return all(row.met is not False for row in found)


def main() -> None:
    """Run what was asked for; leave with 1 if a goal is missed."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description="Speed, as ratios in one run.")
    parser.add_argument("part", nargs="?", choices=("all", *PARTS, *PARTS_ALONE), default="all")
    parser.add_argument("--full", action="store_true", help="engine: more repeats, more histories of slow peers")
    parser.add_argument("--histories", type=int, default=10_000, help="engine: fewer for a trial, not kept")
    asked = parser.parse_args()
    good = True
    if asked.part in {"all", "restitution"}:
        good = restitution()
    if asked.part in {"all", "engine"}:
        good = engine.main(full=asked.full, count=asked.histories) and good
    if asked.part in {"all", "studies"}:
        good = studies.main() and good
    for part, made in (("bed", bed), ("spatial", spatial), ("hull", hull), ("longrun", longrun)):
        if asked.part in {"all", part}:
            good = made.main() and good
    if asked.part == "house":
        good = house.main()
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
