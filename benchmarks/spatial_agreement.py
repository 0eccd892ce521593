"""This engine and two peers on equal cases: their results, their own errors, and the agreement within these errors."""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields

from benchmarks import spatial_bullet, spatial_mujoco
from benchmarks.spatial_cases import Case
from benchmarks.spatial_friction import demands
from benchmarks.spatial_tracks import Measures, Track, Windows, measured, track_of, windows
from rocking.dynamics.rolling import ContactMode, SpatialResponse

FLOOR = {"landing": 1e-3, "kept": 2e-3, "peak": 5e-3, "lost": 1e-2, "direction": 0.5}
"""What the reading itself may cost, beside a peer's own spread: landings last up to 4 steps and energies are read two
steps before them; an impact more or less within the window of the third landing takes about 1 % of the energy.
Peaks are relative, the others absolute [s, -, -, -, degrees]."""


@dataclass(frozen=True)
class Peer:
    """A general-purpose code: its runs of a case, the last one the finest, its friction, convex friction or not."""

    name: str
    runs: Callable[[Case], list[Track]]
    installed: Callable[[], bool]
    friction: float
    convex: bool


PEERS = (
    Peer(
        "MuJoCo",
        lambda case: [spatial_mujoco.run(case, run) for run in spatial_mujoco.RUNS],
        spatial_mujoco.installed,
        spatial_mujoco.RUNS[-1].friction,
        True,
    ),
    Peer(
        "Bullet",
        lambda case: [spatial_bullet.run(case, run) for run in spatial_bullet.RUNS],
        spatial_bullet.installed,
        spatial_bullet.RUNS[-1].friction,
        False,
    ),
)


@dataclass(frozen=True)
class Finding:
    """Results of the finest run of a peer, and the differences of its other runs."""

    best: Measures
    spread: dict[str, float]


def distance(left: Measures, right: Measures) -> dict[str, float]:
    """Differences in the units of `FLOOR`; infinite where one falls and the other does not."""
    if left.fell != right.fell:
        return dict.fromkeys(FLOOR, math.inf)
    differences = {
        f.name: abs(getattr(left, f.name) - getattr(right, f.name)) for f in fields(Measures) if f.name in FLOOR
    }
    differences["peak"] /= right.peak
    differences["direction"] = min(differences["direction"], 360.0 - differences["direction"])
    return differences


def finding(peer: Peer, case: Case, when: Windows) -> Finding:
    """Run a peer."""
    shown = [measured(track, when) for track in peer.runs(case)]
    others = [distance(run, shown[-1]) for run in shown[:-1]]
    return Finding(shown[-1], {name: max(run[name] for run in others) for name in FLOOR})


def beyond(ours: Measures, comparison: Finding) -> dict[str, float]:
    """Differences above a peer's own spread and the floor, in multiples of these; empty where we agree."""
    apart = distance(ours, comparison.best)
    allowed = {name: comparison.spread[name] + floor for name, floor in FLOOR.items()}
    return {
        name: apart[name] / allowed[name] for name in FLOOR if math.isnan(apart[name]) or apart[name] > allowed[name]
    }


def reason(peer: Peer, response: SpatialResponse, when: Windows) -> str:
    """Return the reason for a difference of a peer, from the friction demand up to the third landing, or ""."""
    impacts = demands(response, until=when.third)
    pulled = response.impacts["pull"][: len(impacts)] > 0.0
    if pulled.any():
        return "a corner grazes the ground and would stick only if pulled: ours holds it and says so"
    if any(impact.needed > peer.friction for impact in impacts):
        return f"an impact needs friction {max(impact.needed for impact in impacts):.2f}: the peer slips"
    if peer.convex and any(impact.slope < peer.friction for impact in impacts):
        return f"a corner leaves at slope {min(impact.slope for impact in impacts):.2f}: convex friction holds it"
    released = any(
        a[2] is ContactMode.EDGE
        and b[2] is ContactMode.VERTEX
        and a[1] < when.third
        and a[1] not in response.impacts["time"]
        for a, b in zip(response.intervals, response.intervals[1:], strict=False)
    )
    return "the end of an edge slides before it lifts, as friction is finite" if released else ""


def symmetric(case: Case) -> bool:
    """Whether three corners land at once, so that the order in which a solver takes them matters."""
    width, depth, _ = case.size
    return width == depth and case.lean > 0.0 and case.azimuth % 90.0 == 45.0 and not case.shaken


def read(case: Case, response: SpatialResponse) -> Measures:
    """Return the results of this engine, by the rules of the peers."""
    return measured(track_of(case, response), windows(response))
