"""Bodies in space: our engines and general-purpose peers on twenty cases, and how fast each is."""

import sys
import time

from benchmarks import spatial_mujoco, spatial_speed, spatial_studies, table
from benchmarks.spatial_agreement import FLOOR, PEERS, Finding, beyond, finding, read, reason
from benchmarks.spatial_cases import CASES, Case
from benchmarks.spatial_friction import demands
from benchmarks.spatial_tracks import Measures, Windows, windows
from benchmarks.table import Row
from rocking.dynamics.rolling import SpatialResponse

PACKAGES = ("numpy", "mujoco", "pybullet")
COMMAND = "python -m benchmarks spatial"
LOOSE = 3.0  # a peer whose own runs differ by more than so many floors does not decide

INTRODUCTION = f"""
Boxes on corners in our engine (housner-3d: plastic impacts without slip, contact by complementarity), in MuJoCo (soft
contacts, friction as a convex problem) and in Bullet (rigid contacts by sequential impulses). The coefficient of
restitution is put into neither peer: it comes out of their contacts. A moving ground is, in the peers, a gravity field
the other way (in MuJoCo a force on the centre of mass, which is the same), at the middle of each step. MuJoCo: friction
0.8, damping ratio 3, contacts of four steps, runs at 0.1 ms, at 0.1 ms with softer contacts and at 0.05 ms; Bullet:
friction 20, runs at 0.2, 0.1 and 0.05 ms. Shown is the finest run of each; its own error is the largest distance of its
other runs from it. "agrees" means: all within that and {1e3 * FLOOR["landing"]:g} ms, {FLOOR["kept"]:g} of the energy
kept, {FLOOR["peak"]:.1%} of the peak, {FLOOR["lost"]:g} of the energy lost, {FLOOR["direction"]:g} degrees, which is
what reading costs.
"""

FINDINGS = """
What differs and why:

- Shrinks with the step: all differences from Bullet, with the first power of it, and from MuJoCo with enough damping.
- Does not shrink: MuJoCo with friction 10. Its friction is a convex problem, in which a sliding contact rises at least
  as fast as mu times its slip; a corner that leaves at a smaller slope is held and takes energy (and the body hops).
  With friction below all those slopes and above what impacts need (both are told beside ours) it agrees. Bullet's
  friction is not convex, and it agrees at 20 too.
- Does not shrink: MuJoCo with its default damping ratio of 1. A corner that lands between two steps is thrown back at
  a few per cent of its speed, and lands again some 10 ms later; where the next corner lands before, the energy kept
  differs.
- Does not shrink: MuJoCo with all defaults, whose contacts last 0.02 s whatever the step.
- Three corners at once (the diagonal): the order in which a solver takes contacts matters. MuJoCo keeps the symmetry as
  we do; Bullet's own runs differ after the second landing.
- Bodies lifted from rest by two components: the end of an edge that is about to lift slides first where friction is
  finite, so that MuJoCo at 0.8 yaws by another amount than ours, which never slips, and Bullet at 20.
"""


def main() -> bool:
    """Measure all, print the page and keep it; whether the goal was met."""
    began = time.perf_counter()
    agreement = _agreement()
    study = spatial_studies.lines()
    rows = speed()
    text = [
        "# Bodies in space, beside general-purpose peers",
        "",
        f"Made by `{COMMAND}` in {(time.perf_counter() - began) / 60.0:.0f} minutes; peers that are not installed are"
        " left out.",
        "",
        f"- Machine: {table.machine()}",
        f"- Versions: {table.versions(*PACKAGES)}",
        "",
        "## Twenty cases",
        INTRODUCTION,
        *agreement,
        FINDINGS,
        "## Step and stiffness",
        "",
        *study,
        "",
        "## Speed",
        "",
        *_conditions(),
        "",
        *table.lines(rows),
    ]
    table.keep("RESULTS-spatial.md", text)
    return all(row.met is not False for row in rows)


# ---- agreement -------------------------------------------------------------------------------------------------------


def _agreement() -> list[str]:
    text = [
        "| case | by | first landing [s] | energy kept | peak tilt after [degrees] | lost up to third landing |"
        " end | direction [degrees] | verdict |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for number, case in enumerate(CASES, 1):
        print(f"case {number}: {case.name}", file=sys.stderr, flush=True)
        text += _lines(number, case)
    return text


def _lines(number: int, case: Case) -> list[str]:
    response = case.ours()
    ours, when = read(case, response), windows(response)
    cells = [_cells(f"{number}. {case.name}", "ours", ours, _asked(response, when))]
    for peer in PEERS:
        if peer.installed():
            comparison = finding(peer, case, when)
            cells.append(
                _cells("", peer.name, comparison.best, verdict(ours, comparison, reason(peer, response, when)))
            )
    return cells


def _asked(response: SpatialResponse, when: Windows) -> str:
    impacts = demands(response, until=when.third)
    needed, slope = max(impact.needed for impact in impacts), min(impact.slope for impact in impacts)
    return f"needs friction {needed:.2f}; corners leave at slopes from {slope:.3g}"


def _cells(name: str, by: str, shown: Measures, remark: str) -> str:
    end = "falls" if shown.fell else "stands"
    numbers = f"{shown.landing:.4f} | {shown.kept:.4f} | {shown.peak:.3f} | {shown.lost:.4f}"
    return f"| {name} | {by} | {numbers} | {end} | {shown.direction:.1f} | {remark} |"


def verdict(ours: Measures, comparison: Finding, cause: str) -> str:
    """In words."""
    apart = beyond(ours, comparison)
    loose = {name for name, floor in FLOOR.items() if comparison.spread[name] > LOOSE * floor}
    unsure = f"; its own runs differ in {', '.join(sorted(loose))}" if loose else ""
    if not apart:
        return f"agrees{unsure}"
    return f"differs in {', '.join(apart)}{unsure}: {cause or 'not explained'}"


# ---- speed -----------------------------------------------------------------------------------------------------------


def _conditions() -> list[str]:
    x, y, z = spatial_speed.SIZE
    mujoco = spatial_mujoco.installed()
    parted = f" Medians of the relative differences of peaks: {spatial_speed.scatter()}." if mujoco else ""
    return [
        f"One record of three components, {spatial_speed.DURATION:g} s at {spatial_speed.STEP:g} s, by seed, scaled",
        f"from {spatial_speed.WEAK:g} to {spatial_speed.STRONG:g} m/s2; a box of {x:g} by {y:g} by {z:g} m;",
        f"one thread, CPU time a history, medians of {spatial_speed.REPEATS} repeats in turn. MuJoCo by one",
        f"call of `rollout` for {spatial_speed.FEW} histories, without Python between steps.",
        "A way to run it is sensible if no peak tilt",
        f"after the first landing of the free cases is off by more than {spatial_speed.SENSIBLE:.0%}, and all end",
        "rightly; the goal is set against the quickest sensible one.",
        "",
        "Under such a record, with hundreds of impacts, histories that differ by little part, MuJoCo's from its own",
        f"too: the errors in the table are therefore those of the free cases.{parted}",
    ]


def speed() -> list[Row]:
    """Times and their ratios."""
    if not spatial_mujoco.installed():
        return [Row("Histories in space", "MuJoCo", "skipped: mujoco is not installed", "-")]
    candidates = spatial_speed.modes()
    spent = spatial_speed.times(candidates)
    sensible = [candidate for candidate in candidates if candidate.sensible]
    rival = min(sensible, key=lambda candidate: spent[candidate.words]) if sensible else None
    rows = []
    if "batch" in spent:
        rows += [
            _row("Batched engine", spent["batch"], candidate, spent[candidate.words], goal=candidate is rival)
            for candidate in candidates
        ]
    if rival is not None:
        rows.append(_row("Reference engine (Python)", spent["reference"], rival, spent[rival.words], goal=False))
    return rows


def _row(name: str, mine: float, mode: spatial_speed.Mode, theirs: float, *, goal: bool) -> Row:
    ratio = theirs / mine
    return Row(
        f"{name}, {_time(mine)} a history",
        f"MuJoCo, {mode.words}, {_time(theirs)}; {mode.says}{'' if mode.sensible else ': not sensible'}",
        f"{ratio:,.0f} times faster" if ratio >= 1.0 else f"{1.0 / ratio:.1f} times its time",
        f">= {spatial_speed.GOAL:g} times" if goal else "for information",
        ratio >= spatial_speed.GOAL if goal else None,
    )


def _time(seconds: float) -> str:
    return f"{1e3 * seconds:,.2f} ms" if seconds < 1.0 else f"{seconds:.2f} s"
