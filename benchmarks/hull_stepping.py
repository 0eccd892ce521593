"""Random hulls under ground motion: the compiled engine compared with Moreau's time stepping and with other settings.

`python -m benchmarks.hull_stepping` prints the agreement of outcomes, the histories with a contact held by the engine,
and the outcomes that settings change. 480 histories; ten minutes of CPU time.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy import stats

from benchmarks import hull, time_stepping
from rocking.conventions import BoolArray, FloatArray
from rocking.dynamics.frictional.body import HullBody
from rocking.dynamics.frictional.ground import HullGround
from rocking.dynamics.frictional.histories import hull_histories
from rocking.dynamics.frictional.settings import HullSettings
from rocking.motions import GroundMotion
from rocking.outcome import Outcome

STEPS = (2e-3, 1e-3)
MOVES = 0.01
"""Peak tilt from which a history counts as one that rocks [rad]."""

SETTINGS = HullSettings(tolerance=1e-8)
CHANGES = {
    "tolerance times 10": replace(SETTINGS, tolerance=1e-7),
    "tolerance over 10": replace(SETTINGS, tolerance=1e-9),
    "rest speed times 10": replace(SETTINGS, rest_speed=1e-4),
    "rest speed over 10": replace(SETTINGS, rest_speed=1e-6),
}


@dataclass
class Verdicts:
    """Outcomes of histories: overturning, last pose, peak tilt [rad], number of held contacts."""

    overturned: BoolArray
    pose: FloatArray
    peak: FloatArray
    held: FloatArray

    @property
    def ranked(self) -> FloatArray:
        """Peak tilts, those that overturn above all others and those at rest below."""
        return np.where(self.overturned, np.inf, np.where(self.peak > MOVES, self.peak, 0.0))


@dataclass
class Histories:
    """Bodies, ground motion (samples, 3) every `spacing` [m/s2, s], friction, and durations [s]."""

    bodies: list[HullBody]
    grounds: list[FloatArray]
    spacing: float
    friction: FloatArray
    duration: float

    def ours(self, settings: HullSettings = SETTINGS, scale: float = 1.0) -> Verdicts:
        """By the compiled engine of hulls, with Housner's impacts."""
        rows = []
        for body, ground, friction in zip(self.bodies, self.grounds, self.friction, strict=True):
            shaking = HullGround(*(GroundMotion(a, self.spacing) for a in ground.T))
            choices = {"horizon": self.duration, "settings": settings, "engine": "fast", "threads": 1}
            batch = hull_histories(body, shaking, friction=friction, scales=scale, **choices)
            rows.append([batch[name].item() for name in ("outcome", "pose", "peak_tilt", "held")])
        outcome, pose, peak, held = np.array(rows).T
        return Verdicts(outcome == Outcome.OVERTURNED.code, pose, peak, held)

    def stepped(self, step: float, friction: float = 1.0) -> Verdicts:
        """By time stepping; friction: a factor on it."""
        bodies = time_stepping.Bodies.of(self.bodies, friction * self.friction)
        up = time_stepping.tracks(bodies, np.stack(self.grounds), self.spacing, step, self.duration).up
        last = [
            body.poses[body.under(tuple(direction))]
            for body, direction in zip(self.bodies, up[-1].tolist(), strict=True)
        ]
        first = [body.poses[body.under((0.0, 0.0, 1.0))] for body in self.bodies]
        peak = np.arccos(np.clip(up[..., 2].min(axis=0), -1.0, 1.0))
        return Verdicts(np.not_equal(last, first), np.array(last, dtype=float), peak, np.zeros(len(last)))


def smooth(count: int = 50, scales: tuple[float, ...] = (0.6, 1.0, 1.5), selection: slice = slice(None)) -> Histories:
    """The hulls and sines of `benchmarks.hull` under two frictions; part: of the record."""
    rows = [(c, s, mu) for c in hull.cases()[:count] for mu in (0.3, 0.6) for s in scales]
    grounds = [s * case.acceleration[selection] for case, s, _ in rows]
    after = hull.DURATION - hull.SHAKEN
    friction = np.array([mu for *_, mu in rows])
    return Histories([c.body for c, *_ in rows], grounds, hull.DT, friction, len(grounds[0]) * hull.DT + after)


def noisy(count: int = 60) -> Histories:
    """Hulls under 4 s of white noise of 3 to 9 m/s2, with the most held contacts."""
    rng = np.random.default_rng(17)
    bodies = [hull._hull(rng) for _ in range(count)]
    sizes = np.resize(np.linspace(3.0, 9.0, 10), count)
    noise = [rng.normal(size=(200, 3)) * [a, a, a / 3.0] for a in sizes]
    rows = [(b, np.vstack([n, np.zeros((1, 3))]), mu) for b, n in zip(bodies, noise, strict=True) for mu in FRICTIONS]
    return Histories([b for b, *_ in rows], [a for _, a, _ in rows], 0.02, np.array([mu for *_, mu in rows]), 8.0)


FRICTIONS = (0.3, 0.7, 2.0)


def share(same: BoolArray) -> str:
    """Return count, total and 95 % interval of Wilson."""
    if not same.size:
        return "none"
    low, high = stats.binomtest(int(same.sum()), same.size).proportion_ci(0.95, "wilson")
    return f"{same.sum()} of {same.size} ({low:.3f} to {high:.3f})"


def mcnemar(left: Verdicts, right: Verdicts) -> float:
    """How likely flips are as unequal by chance (exact)."""
    gained, lost = (int((a.overturned & ~b.overturned).sum()) for a, b in ((left, right), (right, left)))
    return float(stats.binomtest(gained, gained + lost).pvalue) if gained + lost else 1.0


def apart(left: Verdicts, right: Verdicts) -> FloatArray:
    """Ratio of peaks, less one, of histories that rock and do not overturn in either."""
    rock = ~left.overturned & ~right.overturned & (np.minimum(left.peak, right.peak) > MOVES)
    return np.asarray(right.peak[rock] / left.peak[rock] - 1.0)


def compare(name: str, histories: Histories) -> None:
    """Print the agreement of a family of histories."""
    ours, steps = histories.ours(), [histories.stepped(step) for step in STEPS]
    is_held = ours.held > 0
    print(f"\n{name}: {is_held.size} histories, {ours.overturned.sum()} overturn, held in {is_held.sum()}")
    print("| against | never held | held | last pose | peaks apart, median and 90 % | McNemar p | KS p |")
    print("|---|---|---|---|---|---|---|")
    wrong = histories.stepped(STEPS[0], 0.5)
    rows = {f"step {s * 1e3:g} ms": v for s, v in zip(STEPS, steps, strict=True)}
    for label, other in (rows | {f"step {STEPS[0] * 1e3:g} ms, half the friction": wrong}).items():
        same, gaps = ours.overturned == other.overturned, np.quantile(apart(ours, other), (0.05, 0.5, 0.95))
        poses = share(ours.pose == other.pose)
        ks = stats.ks_2samp(ours.ranked, other.ranked, method="asymp").pvalue
        cells = f"{gaps[1]:+.3f} ({gaps[0]:+.3f} to {gaps[2]:+.3f}) | {mcnemar(ours, other):.2g} | {ks:.2g}"
        print(f"| {label} | {share(same[~is_held])} | {share(same[is_held])} | {poses} | {cells} |")
    own = steps[0].overturned == steps[1].overturned
    print(f"time stepping with both steps: {share(own[~is_held])} never held, {share(own[is_held])} held", flush=True)


def sensitivity(histories: Histories) -> None:
    """Print the number of outcomes that other settings change."""
    ours = histories.ours()
    print("| changed | verdicts that differ | last poses that differ | peaks 1 % apart | held |")
    print("|---|---|---|---|---|")
    changed = {name: histories.ours(settings) for name, settings in CHANGES.items()}
    for name, other in ({"nothing": ours} | changed | {"motion by 1e-6": histories.ours(scale=1.0 + 1e-6)}).items():
        flips, poses = (int((a != b).sum()) for a, b in ((ours.overturned, other.overturned), (ours.pose, other.pose)))
        off = int((np.abs(apart(ours, other)) > 0.01).sum())
        print(f"| {name} | {flips} of {ours.pose.size} | {poses} | {off} | {int((other.held > 0).sum())} |", flush=True)


def main() -> None:
    """Print everything."""
    for name, family in (("sines", smooth()), ("noise", noisy())):
        sensitivity(family)
        compare(name, family)


if __name__ == "__main__":
    main()
