"""The hierarchical calibration: rows of one block, interface and laboratory have common deviations."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import Any

import numpy as np

from rocking.answers import Answer
from rocking.conventions import FloatArray
from rocking.evidence.calibration import (
    FIELDS,
    LEVEL,
    Calibration,
    Nodes,
    arrays_of,
    fingerprint,
    log_prior,
    normalised,
    summarised,
)
from rocking.evidence.measurements import DataSet, all_measurements
from rocking.restitution import ImpactGeometry
from rocking.restitution.calibrated import KEPT, kept
from rocking.restitution.shifted_impulse import shifted

LEVELS = ("laboratory", "interface", "block", "measurement")
"""Levels of the variance, from groups with the most rows to single rows."""

NODES = Nodes(
    np.linspace(0.9655, 0.9999, 17),
    np.linspace(0.30, 0.80, 14),
    np.linspace(math.log(0.02), math.log(0.80), 12),
    np.linspace(0.20, 1.50, 8),
)
"""Grid, coarser than for independent rows. Integrals of a posterior as wide as a step or more have an error of 1e-4."""
_SHARES, _PARTS = 10, 4  # numbers of nodes of the variance fraction between groups, and of its subdivision


@dataclass(frozen=True, eq=False)
class HierarchicalCalibration(Calibration):
    """Posterior of the calibrated default for a body on a new interface."""

    # Expected fractions of the variance of a new measurement: laboratory, interface, block and measurement [-]. If no
    # laboratory has two groups, the first fraction is part of the next level. If no block has two rows, the third is.
    shares: dict[str, float]


@dataclass(frozen=True, eq=False)
class LeftOut:
    """A group of measurements compared with predictions from all other groups."""

    name: str  # group and interface
    measurements: int  # number of measurements
    inside: int  # number of measurements within their intervals for a single measured body
    interval_width: float  # mean width of these intervals [-]
    probability: float  # predicted probability of a mean below the mean of the group [-]

    def answer(self) -> Answer:
        """Return the results of the group."""
        return Answer({**vars(self), "within": self.within})

    @property
    def within(self) -> bool:
        """True if the group's mean is within its 95 % interval."""
        return 0.5 * (1.0 - LEVEL) <= self.probability <= 0.5 * (1.0 + LEVEL)


def hierarchy_answer(calibration: "HierarchicalCalibration", left_out: Sequence[LeftOut]) -> Answer:
    """Return the results of a calibration with groups."""
    return Answer({
        "model": calibration.model().label,
        "calibration": calibration.summary,
        "shares": calibration.shares,
        "left_out_groups": [group.answer() for group in left_out],
    })  # fmt: skip


def calibrate_hierarchy(measurements: DataSet | None = None) -> HierarchicalCalibration:
    """Return the calibration with scatter between laboratories, interfaces and blocks.

    Parameters
    ----------
    measurements : DataSet, optional
        Measurements; default: the 39 published coefficients.

    Returns
    -------
    HierarchicalCalibration
        Posterior on a fixed grid, without random numbers. Its predictions apply to a body on a new interface.

    Examples
    --------
    >>> calibration = calibrate_hierarchy()
    >>> 0.3 < calibration.shares["laboratory"] + calibration.shares["interface"] < 0.9
    True
    """
    data = all_measurements() if measurements is None else measurements
    return _calibrated(data)


@lru_cache(maxsize=8)
def _calibrated(data: DataSet) -> HierarchicalCalibration:
    stored = kept(KEPT)
    if stored["inputs"] == hierarchy_fingerprint(data):
        shares = dict(zip(LEVELS, stored["shares"].tolist(), strict=True))
        return HierarchicalCalibration(**{name: stored[name] for name in FIELDS}, shares=shares)
    return _Posterior(data, NODES).whole({})


def hierarchy_fingerprint(data: DataSet) -> str:
    """Return the hash of the inputs of the hierarchical posterior."""
    nodes = [[f"{value:.12g}" for value in axis.tolist()] for axis in vars(NODES).values()]
    return fingerprint(data, repr((tree(data), data.coefficient.tolist(), nodes, _SHARES, _PARTS)))


def keep_hierarchy() -> None:
    """Compute and write the stored values of `calibrate_hierarchy` and of the model `calibrated`."""
    data = all_measurements()
    posterior, expected = _Posterior(data, NODES).whole({}), unseen(data)
    shares = np.array(list(posterior.shares.values()))
    np.savez_compressed(
        KEPT, inputs=hierarchy_fingerprint(data), shares=shares, unseen=expected, **arrays_of(posterior)
    )


def left_out_groups(measurements: DataSet | None = None) -> tuple[LeftOut, ...]:
    """Return each group of measurements compared with predictions from the other groups."""
    data = all_measurements() if measurements is None else measurements
    posterior = _Posterior(data, NODES)
    terms = {laboratory: posterior.term(groups) for laboratory, groups in posterior.tree.items()}
    log_posterior, left_out = posterior.log_prior + sum(terms.values()), []
    for laboratory, groups in posterior.tree.items():
        for name, blocks in groups.items():
            others = {other: blocks_of_group for other, blocks_of_group in groups.items() if other != name}
            log_remaining = log_posterior - terms[laboratory] + (posterior.term(others) if others else 0.0)
            left_out.append(posterior.left_out(name, list(blocks.values()), log_remaining))
    return tuple(left_out)


@lru_cache(maxsize=8)
def unseen(data: DataSet) -> FloatArray:
    """Return the expected coefficients of all rows, each row from a calibration without its group [-]."""
    stored = kept(KEPT)
    if stored["inputs"] == hierarchy_fingerprint(data):
        return np.array(stored["unseen"])
    groups, expected, posterior = _groups(data), np.empty(len(data)), _Posterior(data, NODES)
    terms = {laboratory: posterior.term(members) for laboratory, members in posterior.tree.items()}
    for name in dict.fromkeys(groups):
        rows = np.array(groups) == name
        others = _Posterior(data.rows(~rows), NODES)
        is_kept = others.shares == posterior.shares
        unchanged = {other: terms[other] for other in others.tree if is_kept and name not in posterior.tree[other]}
        expected[rows] = others.whole(unchanged).predict(data.slenderness[rows]).coefficient
    return expected


def sentence_of(calibration: HierarchicalCalibration, groups: tuple[LeftOut, ...]) -> str:
    """Return a sentence on the scatter of new interfaces, and on predictions of omitted groups."""
    shares = ", ".join(f"{100.0 * share:.0f} % by {name}" for name, share in calibration.shares.items() if share > 0.0)
    rows, inside = sum(group.measurements for group in groups), sum(group.inside for group in groups)
    width = sum(group.measurements * group.interval_width for group in groups) / rows
    return (
        f"For a body on a new interface the variance consists of {shares}. Of {len(groups)} groups, each left out, the "
        f"means of {sum(group.within for group in groups)} are within their {100.0 * LEVEL:.0f} % intervals. Of "
        f"their {rows} measurements, {inside} are within their intervals, with a mean width of {width:.3f}."
    )


def tree(data: DataSet) -> dict[str, dict[str, dict[Any, list[int]]]]:
    """Return the rows by laboratory, group with interface, and block: a label with its slenderness."""
    by_laboratory: dict[str, dict[str, dict[Any, list[int]]]] = {}
    for i, name in enumerate(_groups(data)):
        blocks = by_laboratory.setdefault(data.laboratory[i] or name, {}).setdefault(name, {})
        blocks.setdefault((data.labels[i], float(data.slenderness[i])), []).append(i)
    return by_laboratory


def _groups(data: DataSet) -> list[str]:
    """Return the group of each row: its data set and interface."""
    pairs = zip(data.group, data.interface, strict=True)
    return [f"{group}: {interface}" if interface else group for group, interface in pairs]


def _shares(tree: dict[str, dict[str, dict[Any, list[int]]]]) -> list[tuple[float, ...]]:
    """Return the nodes of the variance fractions. The variance is not divided between indistinguishable levels."""
    groups = [group for laboratory in tree.values() for group in laboratory.values()]
    has_groups = any(len(laboratory) > 1 for laboratory in tree.values())
    has_repeats = any(len(rows) > 1 for group in groups for rows in group.values())
    middle = [((np.arange(n) + 0.5) / n).tolist() for n in (_SHARES, _PARTS)]
    parts = product(middle[0], middle[1] if has_groups else [0.0], middle[1] if has_repeats else [0.0])
    return [(a * b, a * (1.0 - b), (1.0 - a) * c, (1.0 - a) * (1.0 - c)) for a, b, c in parts]  # Eq. 288


@dataclass(frozen=True)
class _Sums:
    """Sums over rows with a common effect, as arrays on the grid of (eta, k, s, gamma)."""

    precision: Any = 0.0
    moment: Any = 0.0
    square: Any = 0.0
    logarithm: Any = 0.0

    def __add__(self, other: "_Sums") -> "_Sums":
        pairs = zip(vars(self).values(), vars(other).values(), strict=True)
        return _Sums(*(left + right for left, right in pairs))

    def integrated(self, variance: FloatArray) -> "_Sums":
        """Return the sums after integration over a normal effect with a variance."""
        widened = 1.0 + variance * self.precision
        return _Sums(
            self.precision / widened, self.moment / widened, self.square - variance * self.moment**2 / widened,
            self.logarithm + np.log(widened),
        )  # fmt: skip  # Eq. 290


class _Posterior:
    """The posterior on nodes, by laboratory; groups can be omitted without a complete new computation."""

    def __init__(self, data: DataSet, nodes: Nodes) -> None:
        self.data, self.nodes, self.tree = data, nodes, tree(data)
        self.shares = _shares(self.tree)
        base = shifted(ImpactGeometry.of_slenderness(data.slenderness), nodes.k[:, None])
        self.mean = np.moveaxis(nodes.eta[:, None, None] * base, -1, 0)[..., None, None]  # axes: row, eta, k, 1, 1
        self.variance = np.exp(2.0 * nodes.log_s)[:, None]  # axes: s, 1
        self.rounding = (data.high - data.low) ** 2 / 12.0
        self.log_prior = log_prior(nodes)[..., None]

    def loading(self, row: int) -> FloatArray:
        """Return the scatter of a row / s, on the grid of (eta, k, 1, gamma) [-]."""
        return np.asarray(np.maximum(1.0 - self.mean[row], 1e-6) ** self.nodes.gamma)  # Eq. 133

    def term(self, groups: dict[str, dict[Any, list[int]]]) -> FloatArray:
        """Return the logarithm of the likelihood of a laboratory's rows, on the grid and for all variance fractions."""
        rows = [i for group in groups.values() for block in group.values() for i in block]
        residuals = {i: (self.data.coefficient[i] - self.mean[i], self.loading(i)) for i in rows}  # Eq. 287

        @lru_cache(maxsize=_PARTS)  # the division between laboratory and interface changes nothing here
        def group_sums(block: float, alone: float) -> list[_Sums]:
            sums = []
            for group in groups.values():
                inner = _Sums()
                for members in group.values():
                    block_sums = sum((self.row(i, self.variance * alone, *residuals[i]) for i in members), _Sums())
                    inner += block_sums if block == 0.0 else block_sums.integrated(self.variance * block)
                sums.append(inner)
            return sums

        terms = []
        for share in self.shares:
            laboratory, interface = (self.variance * fraction for fraction in share[:2])
            total = _Sums()
            for inner in group_sums(*share[2:]):
                total += inner.integrated(interface)
            total = total if share[0] == 0.0 else total.integrated(laboratory)
            terms.append(-0.5 * (total.square + total.logarithm + len(rows) * math.log(2.0 * math.pi)))  # Eq. 291
        return np.stack(terms, axis=-1)

    def row(self, row: int, variance: FloatArray, residual: FloatArray, loading: FloatArray) -> _Sums:
        own = variance * loading**2 + self.rounding[row]
        scaled = loading / own
        return _Sums(loading * scaled, residual * scaled, residual**2 / own, np.log(own))  # Eq. 289

    def whole(self, terms: Mapping[str, FloatArray]) -> HierarchicalCalibration:
        """Return the calibration on all rows; the terms of some laboratories may be stated."""
        shape = (*map(len, vars(self.nodes).values()), len(self.shares))
        summed = sum(terms[name] if name in terms else self.term(groups) for name, groups in self.tree.items())
        return self.calibration(np.broadcast_to(self.log_prior + summed, shape))

    def calibration(self, logarithm: FloatArray) -> HierarchicalCalibration:
        """Return the calibration from logarithms of weights."""
        weight = normalised(logarithm)
        calibration, expected = (
            summarised(weight.sum(axis=-1), self.nodes),
            weight.sum(axis=(0, 1, 2, 3)) @ np.array(self.shares),
        )
        return HierarchicalCalibration(**vars(calibration), shares=dict(zip(LEVELS, expected.tolist(), strict=True)))

    def left_out(self, name: str, blocks: list[list[int]], logarithm: FloatArray) -> LeftOut:
        """Return a group compared with predictions from the other groups; the group counts as a new laboratory."""
        rows = [i for block in blocks for i in block]
        prediction = self.calibration(logarithm).predict(self.data.slenderness[rows])
        measured = self.data.coefficient[rows]
        inside = int(((prediction.low <= measured) & (measured <= prediction.high)).sum())
        probability = self._below_mean(normalised(logarithm), blocks)
        return LeftOut(name, len(rows), inside, float((prediction.high - prediction.low).mean()), probability)

    def _below_mean(self, weight: FloatArray, blocks: list[list[int]]) -> float:
        """Return the predicted probability that the mean of rows is below the measured mean."""
        from scipy.special import ndtr

        rows = [i for block in blocks for i in block]
        loadings = {i: self.loading(i) for i in rows}
        sums = [sum(loadings[i] for i in block) for block in blocks]
        common, by_block, alone = (
            sum(sums) ** 2,
            sum(block_sum**2 for block_sum in sums),
            sum(x**2 for x in loadings.values()),
        )
        gap = self.data.coefficient[rows].sum() - self.mean[rows].sum(axis=0)
        rounding, probability = self.rounding[rows].sum(), 0.0
        for k, (laboratory, interface, block, own) in enumerate(self.shares):
            variance = self.variance * ((laboratory + interface) * common + block * by_block + own * alone) + rounding
            probability += float((weight[..., k] * ndtr(gap / np.sqrt(variance))).sum())  # Eq. 292
        return probability
