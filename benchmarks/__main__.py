"""Run every benchmark, print the table and keep it in benchmarks/RESULTS.md."""

import platform
import sys
from pathlib import Path

import numpy as np

from benchmarks import ked, section, start


def rows() -> list[tuple[str, str, str, str, bool]]:
    """(subject, against, measured, goal, met) of every benchmark."""
    found = []
    for each in ked.comparisons():
        faster = each.ratio >= 1.0
        measured = f"{each.ratio:,.0f} times faster" if faster else f"{1.0 / each.ratio:.2f} times its cost"
        goal = _goal(each.goal)
        cost = f"{each.ours * 1e9:.2f} ns against {each.theirs * 1e9:,.2f} ns a {each.unit}"
        found.append((each.subject, each.against, f"{measured} ({cost})", goal, each.met))
    spent = section.seconds()
    found.append(
        (
            f"Section of {section.VERTICES:,} vertices, checks and KED",
            "-",
            f"{spent * 1e3:.1f} ms",
            f"< {section.GOAL * 1e3:.0f} ms",
            spent < section.GOAL,
        )
    )
    found += [(what, "-", f"{spent:.3f} s", f"< {goal} s", spent < goal) for what, spent, goal in start.starts()]
    return found


def _goal(goal: float | None) -> str:
    if goal is None:
        return "for information"
    return f">= {goal:,.0f} times" if goal >= 1.0 else f"<= {1.0 / goal:.0f} times"


def main() -> None:
    """Print and keep the table; leave with 1 if a goal is missed."""
    table = rows()
    lines = [
        "# Speed",
        "",
        "Medians of interleaved repeats, CPU time, one run; made by `make bench`.",
        "",
        f"Python {platform.python_version()}, numpy {np.__version__}, {platform.machine()}.",
        "",
        "| what | against | measured | goal | met |",
        "|---|---|---|---|---|",
    ]
    lines += [f"| {a} | {b} | {c} | {d} | {'yes' if met else 'NO'} |" for a, b, c, d, met in table]
    print("\n".join(lines))
    (Path(__file__).parent / "RESULTS.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    sys.exit(0 if all(row[-1] for row in table) else 1)


if __name__ == "__main__":
    main()
