"""The comparison of Gaibor and Lopez (2026), arXiv:2606.14288: harmonic rocking by restitution model and slenderness.

The parameters of the paper are unknown; this module uses its own parameters.
"""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import stats

from rocking.answers import Answer
from rocking.bodies import Block
from rocking.conventions import FloatArray
from rocking.evidence.claims_of_errors import FAILS, HOLDS, IN_PART, UNRESOLVED, Claim
from rocking.quantities import Quantity
from rocking.studies.longrun import (
    Bifurcation,
    HarmonicRocking,
    Numerics,
    branch_off,
    continue_orbit,
    ends_of,
    lyapunov_exponents,
    start_states,
    symmetric_orbit,
)
from rocking.studies.longrun.attractors import IRREGULAR, KINDS, LOST, PERIODIC, diagram
from rocking.studies.longrun.basins import LOST as OVERTURNED_CELL
from rocking.studies.longrun.basins import cells
from rocking.studies.longrun.system import STEP_ERROR

SLENDERNESS, MODELS = (2, 3, 4, 6, 8, 10), ("housner", "ked", "calibrated")
LOWEST, HIGHEST, TOP_SPEED = 0.2, 6.0, 2.0  # range of amplitude ratios; largest start speed / (alpha p)
BASIN_FREQUENCY, BASIN_AMPLITUDE = 3.0, 1.5
# smallest peak / alpha of a motion with an exponent; a smaller motion is rest after slow last impacts
SMALLEST_PEAK = 0.01
BIFURCATIONS = ("fold", "pitchfork", "first_doubling", "second_doubling")
_LIMITS = (0.0, 100.0)  # range of amplitudes in continuations


@dataclass(frozen=True)
class ComparisonEffort:
    """Effort of a reproduction: frequency ratios, amplitude steps, starts, amplitudes of a cascade, basin cells."""

    frequencies: tuple[float, ...] = (2.0, 5.0)
    step: float = 0.1  # step of amplitudes with several starts
    step_at_rest: float = 0.04  # step of amplitudes with a start at rest
    starts: int = 4  # number of start phases, and of start speeds
    cascade: int = 100
    cells: int = 50  # number of phases, and of speeds, of a basin

    def amplitudes(self, step: float) -> FloatArray:
        return np.round(np.arange(round(LOWEST / step), round(HIGHEST / step) + 1) * step, 6)


FAST, FULL = ComparisonEffort(), ComparisonEffort((2.0, 3.0, 5.0), 0.05, 0.01, 8, 400, 100)


QUANTITIES_OF_CASES = {
    name: Quantity(name, "1", meaning, digits=digits)
    for digits, table in {
        ".4f": {
            "restitution": "coefficient of restitution",
            "fold": "smallest amplitude ratio of the symmetric orbit",
            "pitchfork": "amplitude ratio of the loss of symmetry",
            "first_doubling": "amplitude ratio of the first period doubling",
            "second_doubling": "amplitude ratio of the second period doubling",
            "first_overturning": "smallest amplitude ratio that overturns the body from rest with two step errors",
            "overturned_starts": "fraction of starts that overturn",
            "one_period_starts": "fraction of starts with the period of the ground motion",
            "multi_period_starts": "fraction of starts with several periods of the ground motion",
            "chaotic_starts": "fraction of starts with chaos",
            "complex_amplitudes": "fraction of amplitudes with an attractor of several periods or chaos",
            "chaotic_amplitudes": "fraction of amplitudes with chaos",
            "overturned_cells": "fraction of the cells of a basin that overturn",
        },
        ".3g": {
            "amplitude_step": "step of the amplitude ratios",
            "starts_per_amplitude": "starts per amplitude",
            "cells_per_basin": "cells per basin",
            "chaos_step": "step of the amplitude ratios after the second period doubling",
            "chaos_width": "number of amplitudes with chaos after the period doublings times their step",
            "largest_exponent": "largest Lyapunov exponent after the period doublings over p",
            "largest_exponent_error": "standard error of the largest Lyapunov exponent over p",
        },
    }.items()
    for name, meaning in table.items()
}


@dataclass(frozen=True, eq=False)
class HarmonicCase:
    """One slenderness, model and frequency."""

    slenderness: int
    model: str
    frequency: float
    numbers: dict[str, float]  # values by the names of `QUANTITIES_OF_CASES`; NaN without a value
    from_rest: dict[str, float]  # fraction of amplitudes by kind
    is_complex: Any  # amplitudes with an attractor of several periods or chaos
    is_chaotic: Any  # amplitudes with chaos
    attractors: FloatArray  # amplitude and rotation / alpha, shape (points, 2)
    exponents: FloatArray  # amplitude and largest exponent / p after a start at rest, shape (amplitudes, 2)
    cascade: FloatArray  # amplitude, rotation / alpha and largest exponent / p, shape (points, 3)


@dataclass(frozen=True, eq=False)
class GaiborReproduction:
    """The comparison: one case per slenderness, model and frequency, basins, and the statements of the abstract."""

    effort: ComparisonEffort
    cases: tuple[HarmonicCase, ...]
    basins: dict[tuple[int, str], Any]  # final states by slenderness and model, shape (phases, speeds)

    def case(self, slenderness: int, model: str, frequency: float) -> HarmonicCase:
        requested = (slenderness, model, frequency)
        return next(case for case in self.cases if (case.slenderness, case.model, case.frequency) == requested)

    def pairs(self, frequencies: Iterable[float] = ()) -> "list[tuple[HarmonicCase, HarmonicCase]]":
        """Return the cases of Housner and KED with equal slenderness and frequency."""
        return [
            (self.case(slenderness, "housner", frequency), self.case(slenderness, "ked", frequency))
            for frequency in frequencies or self.effort.frequencies
            for slenderness in SLENDERNESS
        ]

    def lost(self, slenderness: int, model: str) -> float:
        """Return the fraction of the cells of a basin that overturn."""
        return float((self.basins[slenderness, model] == OVERTURNED_CELL).mean())

    def claims(self) -> tuple[Claim, ...]:
        """Return the statements of the abstract in their possible meanings, with verdicts."""
        return (*_onset(self), *_prevalence(self), *_convergence(self))

    def answer(self) -> Answer:
        """Return the numbers of all cases, the basins and the claims."""
        effort, claims = self.effort, self.claims()
        basins = [
            {"slenderness_ratio": slenderness, "model": model, "overturned_cells": self.lost(slenderness, model)}
            for slenderness, model in self.basins
        ]
        cases = [
            {"slenderness_ratio": case.slenderness, "model": case.model, "frequency_ratio": case.frequency}
            | case.numbers
            for case in self.cases
        ]
        return Answer({
            "source": "arXiv:2606.14288", "amplitude_step": effort.step, "starts_per_amplitude": effort.starts**2,
            "cells_per_basin": effort.cells**2, "cases": cases, "basins": basins,
            "claims": [
                {"statement": c.quote, "sense": c.test, "verdict": c.verdict, "evidence": c.evidence} for c in claims
            ],
        }, QUANTITIES_OF_CASES)  # fmt: skip


def steps(effort: ComparisonEffort = FAST) -> int:
    """Return the number of steps of a reproduction."""
    return len(SLENDERNESS) * len(MODELS) * (len(effort.frequencies) + 1)


def reproduce(effort: ComparisonEffort = FAST, step: Callable[[str], None] = lambda name: None) -> GaiborReproduction:
    """Compute the comparison; `step` is called before each step."""
    cases, basins = [], {}
    for slenderness in SLENDERNESS:
        for model in MODELS:
            for frequency in effort.frequencies:
                step(f"h/b {slenderness}, {model}, frequency {frequency:g}")
                cases.append(case(slenderness, model, frequency, effort))
            step(f"h/b {slenderness}, {model}, basin")
            system = _system(slenderness, model, BASIN_FREQUENCY, BASIN_AMPLITUDE)
            phase, speed = np.meshgrid(*cells(effort.cells, effort.cells, TOP_SPEED), indexing="ij")
            basins[slenderness, model] = ends_of(system, phase.ravel(), speed.ravel()).reshape(phase.shape)
    return GaiborReproduction(effort, tuple(cases), basins)


def _system(slenderness: float, model: str, frequency: float, amplitude: float = 1.0) -> HarmonicRocking:
    body = Block(width=1.0, height=float(slenderness))
    return HarmonicRocking.of_ratios(body, amplitude, frequency, restitution=model)


def case(slenderness: int, model: str, frequency: float, effort: ComparisonEffort = FAST) -> HarmonicCase:
    """Return one case."""
    system = _system(slenderness, model, frequency)
    at_rest, amplitudes = effort.amplitudes(effort.step_at_rest), effort.amplitudes(effort.step)
    at_rest_results, rest_kind, _ = _attractors(system, at_rest, [[math.nan, math.nan]], (300, 200))
    is_small = at_rest_results["peak_ratio"][:, 0] < SMALLEST_PEAK
    overturning = at_rest[rest_kind[:, 0] == LOST]
    centres = (np.arange(effort.starts) + 0.5) / effort.starts
    states = np.stack(np.meshgrid(centres * 2.0 * math.pi, centres * TOP_SPEED, indexing="ij"), axis=2).reshape(-1, 2)
    r = float(system.sides[2])
    cycles = (max(150, math.ceil(11.0 / abs(math.log(r)))), 130)
    diagram, kind, period = _attractors(system, amplitudes, states, cycles)
    shares = {
        "overturned": kind == LOST, "one_period": (kind == PERIODIC) & (period == 1),
        "multi_period": (kind == PERIODIC) & (period > 1), "chaotic": kind == IRREGULAR,
    }  # fmt: skip
    is_complex, is_chaotic = (shares["chaotic"] | shares["multi_period"]).any(axis=1), shares["chaotic"].any(axis=1)
    branch = main_branch(system)
    cascade, after_doublings = _cascade(branch, effort.cascade)
    numbers = {
        "restitution": r, **dict(zip(BIFURCATIONS, (item.value for item in branch), strict=True)),
        "first_overturning": first_overturning(system, overturning),
        **{f"{name}_starts": float(mask.mean()) for name, mask in shares.items()},
        "complex_amplitudes": float(is_complex.mean()), "chaotic_amplitudes": float(is_chaotic.mean()),
        **after_doublings,
    }  # fmt: skip
    is_kept = (kind == PERIODIC) | (kind == IRREGULAR)
    return HarmonicCase(
        slenderness, model, frequency, numbers,
        {name: float((rest_kind == number).mean()) for number, name in enumerate(KINDS)},
        is_complex, is_chaotic, _points(amplitudes, diagram["rotation_ratio"], is_kept),
        np.column_stack([at_rest, np.where(is_small, np.nan, at_rest_results["exponent"][:, 0] / system.p)]), cascade,
    )  # fmt: skip


def first_overturning(system: HarmonicRocking, amplitudes: FloatArray) -> float:
    """Return the smallest amplitude that overturns a body from rest with both step errors; NaN without overturning."""
    numerics = Numerics(step_error=10.0 * STEP_ERROR)  # after long chaotic motion the rounding decides
    for amplitude in amplitudes.tolist():
        if (
            ends_of(system.changed("amplitude", amplitude), 0.0, 0.0, impacts=5000, numerics=numerics)[0]
            == OVERTURNED_CELL
        ):
            return float(amplitude)
    return math.nan


def _diagram(
    system: HarmonicRocking, amplitudes: FloatArray, states: Any, cycles: tuple[int, int], memory: str = "none"
) -> dict[str, Any]:
    """Return the attractors over the amplitude, from starts with several phases and speeds after an impact."""
    systems = [system.changed("amplitude", value) for value in amplitudes.tolist()]
    starts = np.tile(start_states(system, states), (len(systems), 1, 1))
    return diagram(systems, starts, memory=memory, cycles=cycles, exponents=True)


def _attractors(system: HarmonicRocking, amplitudes: FloatArray, states: Any, cycles: tuple[int, int]) -> Any:
    """Return diagram, kinds and periods, shape (amplitudes, starts); chaos is irregular after 2,000 more periods."""
    diagram = _diagram(system, amplitudes, states, cycles)
    kind, period = diagram["attractor"].copy(), diagram["periods"].copy()
    doubtful = np.flatnonzero((kind == IRREGULAR).any(axis=1))
    if len(doubtful):
        longer = _diagram(system, amplitudes[doubtful], states, (cycles[0] + 2000, 512))
        rows, new = kind[doubtful] == IRREGULAR, longer["attractor"]
        new[(new == IRREGULAR) & ~(longer["exponent"] > 0.0)] = PERIODIC
        kind[doubtful] = np.where(rows, new, kind[doubtful])
        period[doubtful] = np.where(rows, longer["periods"], period[doubtful])
    return diagram, kind, period


def _points(amplitudes: FloatArray, rotation: FloatArray, is_kept: Any) -> FloatArray:
    """Return amplitude and rotation of the last 32 periods of attractors, each point once."""
    rows, columns = np.nonzero(is_kept)
    last = np.round(rotation[rows, columns, -32:], 3)
    return np.unique(np.column_stack([np.repeat(amplitudes[rows], last.shape[1]), last.ravel()]), axis=0)


def main_branch(system: HarmonicRocking) -> list[Bifurcation]:
    """Return the amplitudes of fold, pitchfork and two period doublings of the symmetric orbit."""
    scale = (1.0 + system.frequency_ratio**2) / 5.0
    orbit = symmetric_orbit(system.changed("amplitude", 1.2 * scale))
    fold = continue_orbit(orbit, _LIMITS, increasing=False, stop=_is("fold")).first("fold")
    bifurcations = [fold, continue_orbit(orbit, _LIMITS, step=0.05, stop=_is("pitchfork")).first("pitchfork")]
    for step in (0.03, 0.01):
        branch = branch_off(bifurcations[-1], _LIMITS, step=step, stop=_is("period doubling"))
        bifurcations.append(branch.first("period doubling"))
    return bifurcations


def _is(kind: str) -> Callable[[Bifurcation], bool]:
    return lambda item: item.kind == kind


def _cascade(branch: list[Bifurcation], number: int) -> tuple[FloatArray, dict[str, float]]:
    """Follow the attractor from the second period doubling until overturning; return points and numbers."""
    first, second = branch[2:]
    values = second.value + np.linspace(0.0, second.value - first.value, number + 1)[1:]
    orbit = second.orbit
    diagram = _diagram(orbit.system, values, [[orbit.phase, orbit.speed]], (200, 200), "up")
    kind, exponent = diagram["attractor"][:, 0], diagram["exponent"][:, 0]
    end = int(np.argmax(np.append(kind == LOST, True)))
    is_chaotic = (kind == IRREGULAR) & (exponent > 0.0) & (np.arange(number) < end)
    rotation = diagram["rotation_ratio"][:end, 0, -64:]
    p = orbit.system.p
    points = np.column_stack([np.repeat(column[:end], 64) for column in (values, exponent / p)])
    cascade = np.insert(points, 1, rotation.ravel(), axis=1)
    step, exponents = float(values[1] - values[0]), (math.nan, math.nan)
    for at in np.argsort(np.where(is_chaotic, -exponent, np.inf))[: min(8, is_chaotic.sum())]:
        last = [diagram[name][at, 0, -1] * orbit.system.alpha for name in ("rotation_ratio", "velocity_ratio")]
        time = start_states(orbit.system, [[orbit.phase, 0.0]])[0, 0]
        rows = np.tile([time, last[0], last[1] * p], (16, 1))
        rows[:, 2] *= 1.0 + 1e-9 * np.arange(16)  # nearly equal starts, which chaos makes independent
        system = orbit.system.changed("amplitude", float(values[at]))
        result = lyapunov_exponents(system, starts=rows, settled=500, kept=1000)
        if len(result.finite) > 3:  # with fewer remaining orbits, the chaos is transient: orbits overturn later
            exponents = (float(result.values[0] / p), float(result.standard_errors[0] / p))
            break
    names = ("chaos_step", "chaos_width", "largest_exponent", "largest_exponent_error")
    return cascade, dict(zip(names, (step, float(is_chaotic.sum()) * step, *exponents), strict=True))


_ONSET = "complex oscillation begins earlier with KED"
_PREVALENCE = "complex oscillation is more widespread with KED"
_CONVERGENCE = "the difference between the models fades as slenderness grows"


Pairs = list[tuple[HarmonicCase, HarmonicCase]]


def _values(pairs: Pairs, name: str) -> FloatArray:
    """Return a number of the cases of Housner and KED, shape (2, pairs)."""
    return np.array([[case.numbers[name] for case in pair] for pair in pairs]).T


def _onset(result: GaiborReproduction) -> list[Claim]:
    pairs, effort = result.pairs(), result.effort
    names = ("the symmetric orbit begins (fold)", "the symmetric orbit loses symmetry", "first period doubling")
    exact = zip(BIFURCATIONS, names, strict=False)
    claims = [_earlier(pairs, title, _values(pairs, name), 1e-9) for name, title in exact]
    overturning = _values(pairs, "first_overturning")
    claims.append(_earlier(pairs, "first overturning from rest", overturning, effort.step_at_rest))
    amplitudes = effort.amplitudes(effort.step)
    for frequency in effort.frequencies:
        pairs = result.pairs([frequency])
        first = [[min(amplitudes[case.is_complex], default=math.nan) for case in pair] for pair in pairs]
        title = f"first attractor of several periods or chaos, frequency {frequency:g}"
        claims.append(_earlier(pairs, title, np.array(first).T, effort.step))
    return claims


def _earlier(pairs: Pairs, title: str, values: FloatArray, resolution: float) -> Claim:
    """Test if the amplitudes are smaller with KED than with Housner's model; one step is no difference."""
    housner, ked = np.nan_to_num(values, nan=1e9)  # NaN means no event
    gap = (ked - housner) / (1.01 * resolution)
    earlier, later, first = int((gap < -1.0).sum()), int((gap > 1.0).sum()), pairs[0][0]
    texts = [f"{value:.4f}" if value < 1e9 else "none" for value in (ked[0], housner[0])]
    evidence = (
        f"KED earlier in {earlier}, later in {later} of {len(pairs)} pairs; slenderness {first.slenderness}, frequency "
        f"{first.frequency:g}: {texts[0]} with KED, {texts[1]} with Housner"
    )
    return Claim("1", _ONSET, _verdict(earlier, later, len(pairs)), evidence, title)


def _verdict(agreeing: int, opposite: int, total: int) -> str:
    if not agreeing:
        return FAILS if opposite else UNRESOLVED
    return HOLDS if not opposite and 3 * agreeing >= total else IN_PART


def _prevalence(result: GaiborReproduction) -> list[Claim]:
    pairs, several = result.pairs(), "attractors of several periods or chaos"
    claims = [
        _more(result.pairs([frequency]), "is_complex", f"{several}, frequency {frequency:g}")
        for frequency in result.effort.frequencies
    ]
    width, noise = _values(pairs, "chaos_width"), _values(pairs, "chaos_step").max(axis=0)
    gap = (width[1] - width[0]) / (1.01 * noise)
    wider, narrower = int((gap > 1.0).sum()), int((gap < -1.0).sum())
    exponent, error = _values(pairs, "largest_exponent"), _values(pairs, "largest_exponent_error")
    evidence = (
        f"KED wider in {wider}, narrower in {narrower} of {len(pairs)} pairs, others equal within one amplitude; "
        f"slenderness {SLENDERNESS[0]}, frequency {pairs[0][0].frequency:g}: {width[1, 0]:.2g} with KED, "
        f"{width[0, 0]:.2g} with Housner; largest exponents {exponent[1, 0]:.4f} +- {error[1, 0]:.4f} and "
        f"{exponent[0, 0]:.4f} +- {error[0, 0]:.4f} per p t"
    )
    title = "width of the amplitudes with chaos after the period doublings"
    last = Claim("2", _PREVALENCE, _verdict(wider, narrower, len(pairs)), evidence, title)
    return [*claims, _more(pairs, "is_chaotic", "chaos, all frequencies"), last]


def _more(pairs: Pairs, name: str, title: str) -> Claim:
    """Compare paired counts of amplitudes by a sign test."""
    signs, shares, has_frequencies = [], [], len({ked.frequency for _, ked in pairs}) > 1
    for housner, ked in pairs:
        first, second = getattr(ked, name), getattr(housner, name)
        more, fewer = int((first & ~second).sum()), int((second & ~first).sum())
        is_resolved = more != fewer and stats.binomtest(more, more + fewer).pvalue < 0.05
        signs.append(int(np.sign(more - fewer)) if is_resolved else 0)
        if first.any() or second.any():
            frequency = f" at frequency {ked.frequency:g}" if has_frequencies else ""
            shares.append(f"{ked.slenderness}{frequency}: {first.mean():.3f} and {second.mean():.3f}")
    more, fewer = signs.count(1), signs.count(-1)
    evidence = (
        f"more with KED in {more}, fewer in {fewer} of {len(pairs)} pairs, others not resolved (95 %); KED and Housner "
        f"by slenderness: {'; '.join(shares) or 'none'}; counting noise: one amplitude, {1.0 / len(first):.4f}"
    )
    return Claim("2", _PREVALENCE, _verdict(more, fewer, len(pairs)), evidence, f"fraction of amplitudes with {title}")


def _convergence(result: GaiborReproduction) -> list[Claim]:
    claims, frequencies = [], result.effort.frequencies
    for name, title in (("pitchfork", "loss of symmetry"), ("first_doubling", "first period doubling")):
        gaps = [np.abs(np.divide(*_values(result.pairs([frequency]), name)[::-1]) - 1.0) for frequency in frequencies]
        fades = all((np.diff(gap) < 0.0).all() and gap[-1] < 1e-3 for gap in gaps)
        powers = [np.polyfit(np.log(SLENDERNESS[2:]), np.log(gap[2:]), 1)[0] for gap in gaps]
        evidence = "; ".join(
            f"frequency {frequency:g}: {', '.join(f'{100.0 * value:.2g}' for value in gap)} %, slenderness^{power:.1f}"
            for frequency, gap, power in zip(frequencies, gaps, powers, strict=True)
        )
        claims.append(Claim("3", _CONVERGENCE, HOLDS if fades else FAILS, evidence, f"amplitudes of the {title}"))
    housner, ked = _values(result.pairs(frequencies[:1]), "fold")
    evidence = (
        f"difference {housner[0] - ked[0]:.4f} at slenderness {SLENDERNESS[0]}, {housner[-1] - ked[-1]:.4f} at "
        f"{SLENDERNESS[-1]}; ratio {ked[0] / housner[0]:.3f} and {ked[-1] / housner[-1]:.3f}, with the limit 2/3"
    )
    verdict = IN_PART if housner[-1] - ked[-1] < 0.1 * (housner[0] - ked[0]) else FAILS
    claims.append(Claim("3", _CONVERGENCE, verdict, evidence, "amplitudes of the fold: difference, but not ratio"))
    return [*claims, *(_basin_claim(result, other) for other in ("ked", "calibrated"))]


def _basin_claim(result: GaiborReproduction, other: str) -> Claim:
    """Test if the difference in overturning cells decreases after its maximum, within the counting noise."""
    gap, noise = [], []
    for slenderness in SLENDERNESS:
        first, second = (result.basins[slenderness, model] == OVERTURNED_CELL for model in (other, "housner"))
        gap.append((int(first.sum()) - int(second.sum())) / first.size)
        noise.append(2.0 * math.sqrt((first != second).sum()) / first.size)
    sizes = np.abs(gap[int(np.argmax(np.abs(gap))) :])
    fades = len(sizes) > 1 and bool((np.diff(sizes) < noise[-1]).all())
    verdict = FAILS if not fades else HOLDS if sizes[-1] < noise[-1] else IN_PART
    r = [result.case(SLENDERNESS[-1], model, result.effort.frequencies[0]).numbers for model in (other, "housner")]
    evidence = (
        f"by slenderness: {', '.join(f'{value:+.3f}' for value in gap)}; counting noise (95 %) {max(noise):.3f}; "
        f"coefficients at slenderness {SLENDERNESS[-1]}: {r[0]['restitution']:.4f} and {r[1]['restitution']:.4f}"
    )
    return Claim("3", _CONVERGENCE, verdict, evidence, f"overturning cells of the basin, {other} and housner")
