"""Effect of the settings of peers: differences that decrease with time step and stiffness, and others."""

import math
import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from benchmarks import spatial_bullet, spatial_mujoco
from benchmarks.spatial_agreement import distance, read
from benchmarks.spatial_bullet import Rules
from benchmarks.spatial_cases import CASES, Case
from benchmarks.spatial_mujoco import Contact
from benchmarks.spatial_tracks import Measures, Track, Windows, measured, windows

FREE = tuple(case for case in CASES if not case.shaken)
GENERIC = FREE[1:]  # the first one lands on three corners at once
Run = Callable[[Case], Track]


@dataclass(frozen=True)
class Setting:
    """One way to run a peer."""

    peer: str
    words: str
    step: float
    run: Run
    installed: bool


def _mujoco(description: str, contact: Contact) -> Setting:
    version = spatial_mujoco.installed()
    return Setting("MuJoCo", description, contact.step, lambda case: spatial_mujoco.run(case, contact), version)


def _bullet(description: str, rules: Rules) -> Setting:
    version = spatial_bullet.installed()
    return Setting("Bullet", description, rules.step, lambda case: spatial_bullet.run(case, rules), version)


def settings() -> list[Setting]:
    """Ways to run the peers, each at falling steps."""
    good, loose = Contact(), Contact(steps=2.0, damping=1.0)
    slippery = replace(good, friction=10.0)
    candidates = [_mujoco("damping 3, friction 0.8", good.at(step)) for step in (2e-3, 1e-3, 4e-4, 2e-4, 1e-4, 5e-5)]
    candidates += [
        _mujoco("damping 3, 4 times softer", replace(good.at(step), steps=8.0)) for step in (2e-4, 1e-4, 5e-5)
    ]
    candidates += [_mujoco("damping 1 (default)", loose.at(step)) for step in (2e-4, 1e-4, 5e-5)]
    candidates += [_mujoco("damping 3, friction 10", slippery.at(step)) for step in (2e-4, 1e-4, 5e-5)]
    candidates += [_mujoco("all defaults but friction 0.8", defaults(step)) for step in (2e-3, 1e-3)]
    candidates += [_bullet("friction 20", Rules(step=step)) for step in (1e-3, 4e-4, 2e-4, 1e-4)]
    candidates += [_bullet("friction 0.8", Rules(step=step, friction=0.8)) for step in (4e-4, 2e-4, 1e-4)]
    return [setting for setting in candidates if setting.installed]


def defaults(step: float) -> Contact:
    """Default settings of a user with a stated friction: contacts of 0.02 s, a pyramid of friction."""
    return Contact(
        step, stiff=0.95, steps=0.02 / step, damping=1.0, friction=0.8, ratio=1.0, cone="pyramidal", tolerance=1e-8
    )


def shown(setting: Setting, cases: Sequence[Case]) -> list[dict[str, float]]:
    """Differences from ours, case by case."""
    rows = []
    for case in cases:
        ours, when = known(case)
        rows.append(distance(measured(setting.run(case), when), ours))
    return rows


_KNOWN: dict[str, tuple[Measures, Windows]] = {}


def known(case: Case) -> tuple[Measures, Windows]:
    """Our history of a case, read once."""
    if case.name not in _KNOWN:
        response = case.ours()
        _KNOWN[case.name] = read(case, response), windows(response)
    return _KNOWN[case.name]


def lines() -> list[str]:
    """The table in Markdown."""
    text = [
        f"Differences from ours over {len(GENERIC)} free cases, median (largest). Verdicts: how many of them end"
        " otherwise.",
        "",
        "| peer | setting | step [ms] | energy kept at first landing | peak tilt after it | lost up to third landing"
        " | verdicts |",
        "|---|---|---|---|---|---|---|",
    ]
    for setting in settings():
        measured = shown(setting, GENERIC)
        good = [row for row in measured if math.isfinite(row["peak"])]
        cells = [_spread([row[name] for row in good], share=name == "peak") for name in ("kept", "peak", "lost")]
        row = (setting.peer, setting.words, f"{1e3 * setting.step:g}", *cells, str(len(measured) - len(good)))
        text.append(f"| {' | '.join(row)} |")
    return text


def _spread(values: list[float], *, share: bool) -> str:
    middle, most = statistics.median(values), max(values)
    return f"{100.0 * middle:.2f} % ({100.0 * most:.2f} %)" if share else f"{middle:.5f} ({most:.4f})"
