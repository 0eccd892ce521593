"""Model error: factors on the uplift acceleration and on the energy barrier of a body, from tests of real bodies.

A body with the factors f on its uplift acceleration and F on the energy barrier of its lowest pass is similar to the
body without factors: its size is s = F / f**2 times larger, and its angles are f times larger. The body without factors
has the same response under gravity g / s, with the motion multiplied by 1 / (s f) and friction divided by f. Thus no
other shape is necessary for the factors. Lengths are then s f times longer.
"""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cache
from pathlib import Path
from typing import Any, TypeGuard

import numpy as np
from scipy.special import expit, logit, ndtri

from rocking import checks
from rocking.conventions import FloatArray, percent
from rocking.errors import InvalidValueError
from rocking.messages import Message

KEPT = Path(__file__).parent / "data" / "shaking_tests.json"
"""File with posteriors and scores of tests of real bodies, written by `make shaking-tests`."""

MODEL_ERROR = "model_error"  # name of the input
OFF = "off"
ORDERS = np.array([1.0, 2.0])
"""Orders in an angle of uplift acceleration (proportional) and energy barrier (square), and of their errors."""


@dataclass(frozen=True)
class BodyClass:
    """Class of bodies with one prior of the factors."""

    text: str
    deviation: float  # deviation of ln of the uplift factor, for the mean of the class and between bodies [-]


CLASSES = {
    "machined": BodyClass(Message("machined or cast block"), 0.05),
    "object": BodyClass(Message("object such as a statue or a cabinet"), 0.1),
    "natural": BodyClass(Message("natural rough body or scan"), 0.2),
}
"""Classes in the order of their errors. The deviations are assumptions with reasons in docs/theory/prediction.md."""

DEVIATIONS = np.linspace(0.1, 4.0, 40)
"""Grid of the standard deviation between bodies over the deviation of the class [-]."""

SCATTERS = np.array([0.05, 0.1, 0.15, 0.2])
"""Grid of the standard deviation between repeated tests of one natural body, with equal prior probabilities [-]."""

MOST_FACTOR, STEEPEST_SLOPE = 20.0, 10.0
_HOW = (
    '"off", "machined", "object", "natural", a file of `rocking validate-predictions --update`, or a table with mean '
    "and covariance of ln of the factors"
)


@dataclass(frozen=True)
class ModelError:
    """Lognormal factors on the uplift acceleration and on the energy barrier, and their source."""

    mean: tuple[float, float]  # mean of ln of both factors [-]
    covariance: tuple[tuple[float, float], tuple[float, float]]  # covariance of ln of both factors [-]
    source: str
    # calibration slope: factor on the log-odds of the probability of overturning, above 1 if it is too cautious [-]
    slope: float = 1.0

    def __post_init__(self) -> None:
        mean = checks.finite("mean", self.mean, "-", (2,))
        matrix = checks.finite("covariance", self.covariance, "-", (2, 2))
        limit = math.log(MOST_FACTOR)
        if not (np.abs(mean) <= limit).all() or not (matrix.diagonal() <= limit**2).all():
            raise InvalidValueError(
                parameter="model_error", allowed=f"factors up to {MOST_FACTOR:g}", value=mean.tolist()
            )
        checks.within("slope", self.slope, 1.0 / STEEPEST_SLOPE, STEEPEST_SLOPE)
        if matrix[0, 1] != matrix[1, 0] or not matrix[0, 0] > 0.0 or not np.linalg.det(matrix) > 0.0:
            raise InvalidValueError(
                "the covariance of {parameter} must be symmetric and positive definite, got {value}",
                parameter="model_error", value=matrix.tolist(),
            )  # fmt: skip

    @classmethod
    def of_moments(cls, mean: FloatArray, covariance: FloatArray, source: str, slope: float = 1.0) -> "ModelError":
        """Return the model error with a mean and a covariance of ln of the factors."""
        (first, both), (_, second) = covariance.tolist()
        return cls((float(mean[0]), float(mean[1])), ((first, both), (both, second)), source, slope)

    def factors(self, levels: FloatArray) -> FloatArray:
        """Return the factors at points of the unit square, shape (n, 2)."""
        root = np.linalg.cholesky(np.array(self.covariance))
        return np.asarray(np.exp(np.array(self.mean) + ndtri(levels) @ root.T))

    @property
    def text(self) -> str:
        """95 % intervals of both factors, and the calibration slope, as text."""
        deviations = np.sqrt(np.array(self.covariance).diagonal())
        ends = np.exp(np.array(self.mean) + 1.96 * np.outer([-1.0, 1.0], deviations))
        facts = {
            "low": float(ends[0, 0]), "high": float(ends[1, 0]), "lower": float(ends[0, 1]), "higher": float(ends[1, 1])
        }  # fmt: skip
        factors = Message(
            "uplift acceleration times {low:.2f} to {high:.2f}, energy barrier times {lower:.2f} to {higher:.2f} in "
            "95 % of samples", facts,
        )  # fmt: skip
        if self.slope == 1.0:
            return factors
        return Message(
            "{factors}; log-odds of overturning times {slope:.2f}", {"factors": factors, "slope": self.slope}
        )

    def save(self, path: Path) -> None:
        """Write the model error to a file that `predict` accepts."""
        table = {"mean": self.mean, "covariance": self.covariance, "slope": self.slope, "source": self.source}
        path.write_text(json.dumps(table, indent=1) + "\n", "utf-8")


@dataclass(frozen=True, eq=False)
class Similarity:
    """Factors on motion, friction and gravity of histories with a model error, and on their lengths."""

    motion: FloatArray
    friction: FloatArray
    gravity: FloatArray
    length: FloatArray

    @classmethod
    def of_factors(cls, factors: FloatArray) -> "Similarity":
        """Return the similarity of factors on uplift acceleration and energy barrier, shape (n, 2)."""
        uplift, barrier = factors.T
        size = barrier / uplift**2
        return cls(1.0 / (size * uplift), 1.0 / uplift, 1.0 / size, size * uplift)


def model_error_of(stated: Any, kind: str) -> ModelError | None:
    """Return the stated model error, by default that of a further body of a class; None for "off"."""
    if stated is None or is_class(stated):
        return kept_error(stated or kind)
    if isinstance(stated, ModelError):
        return stated
    if isinstance(stated, str) and stated == OFF:
        return None
    if isinstance(stated, (str, Path)):
        return _in_file(Path(stated))
    if isinstance(stated, Mapping) and {"mean", "covariance"} <= set(stated) <= {f.name for f in fields(ModelError)}:
        mean = checks.finite("mean", stated["mean"], "-", (2,))
        covariance = checks.finite("covariance", stated["covariance"], "-", (2, 2))
        slope = checks.within("slope", stated.get("slope", 1.0), 1.0 / STEEPEST_SLOPE, STEEPEST_SLOPE)
        return ModelError.of_moments(mean, covariance, str(stated.get("source", Message("given"))), slope)
    raise InvalidValueError(parameter="model_error", allowed=_HOW, value=stated)


def sharpened(probability: FloatArray, slope: float) -> FloatArray:
    """Return probabilities with their log-odds multiplied by a calibration slope; 0 and 1 are unchanged."""
    return np.asarray(expit(slope * logit(probability)))


def is_class(stated: Any) -> TypeGuard[str]:
    """Return True for the name of a class of bodies."""
    return isinstance(stated, str) and stated in CLASSES


def _in_file(path: Path) -> ModelError:
    try:
        table = json.loads(path.read_text("utf-8"))
    except (OSError, ValueError) as error:
        raise InvalidValueError(parameter="model_error", allowed=_HOW, value=str(path)) from error
    if not isinstance(table, dict):
        raise InvalidValueError(parameter="model_error", allowed=_HOW, value=str(path))
    return model_error_of(table, "natural") or _refused(path)


def _refused(path: Path) -> ModelError:
    raise InvalidValueError(parameter="model_error", allowed=_HOW, value=str(path))


@dataclass(frozen=True)
class BodyEvidence:
    """Factors of one tested body, only from its own tests: mean and covariance of ln of the factors, and scatter."""

    name: str
    kind: str  # name of the class
    tests: int
    earthquakes: int
    mean: FloatArray  # shape (2,)
    covariance: FloatArray  # shape (2, 2)
    scatter: float  # mean square of ln of the uplift acceleration between repeated tests [-]


@dataclass(frozen=True)
class FurtherBody:
    """Distribution of ln of the factors of a further body of a class, and its scatter between repeated tests."""

    mean: FloatArray  # shape (2,)
    covariance: FloatArray  # shape (2, 2)
    scatter: float  # mean square of ln of the uplift acceleration [-]

    def error(self, source: str, slope: float = 1.0) -> ModelError:
        """Return the model error of a test of this body."""
        return ModelError.of_moments(self.mean, self.covariance + self.scatter * np.diag(ORDERS**2), source, slope)


def hierarchy(bodies: Sequence[BodyEvidence], kind: str) -> FurtherBody:
    """Return the distribution of the factors of a further body of a class, from tested bodies.

    The mean of a class has a normal prior. The standard deviation between bodies has a half-normal prior and the
    restricted likelihood, which does not depend on this deviation for a single body: one body cannot reduce it.
    """
    prior = CLASSES[kind]
    seen = [_in_class(body, prior) for body in bodies if CLASSES[body.kind].deviation >= prior.deviation]
    weights, means, covariances = [], [], []
    for ratio in DEVIATIONS.tolist():
        between = (ratio * prior.deviation) ** 2 * np.diag(ORDERS**2)  # Eq. 357
        precisions = [np.linalg.inv(between + body.covariance) for body in seen]
        information, moment = _sums(precisions, seen)
        restricted = 0.0
        if len(seen) > 1:
            centre = np.linalg.solve(information, moment)
            off = [body.mean - centre for body in seen]
            restricted = 0.5 * sum(float(np.linalg.slogdet(matrix)[1]) for matrix in precisions)
            restricted -= 0.5 * float(np.linalg.slogdet(information)[1])
            restricted -= 0.5 * sum(float(x @ matrix @ x) for x, matrix in zip(off, precisions, strict=True))
        covariance = np.linalg.inv(information + np.diag(1.0 / (prior.deviation * ORDERS) ** 2))
        means.append(covariance @ moment)
        covariances.append(covariance + between)
        weights.append(restricted - 0.5 * ratio**2)
    return FurtherBody(*mixed(np.array(weights), np.array(means), np.array(covariances)), _scatter(bodies, kind))


def _in_class(body: BodyEvidence, prior: BodyClass) -> BodyEvidence:
    """Return a tested body as evidence for a class with smaller errors; its covariance is larger for this class."""
    further = 2.0 * (CLASSES[body.kind].deviation ** 2 - prior.deviation**2)  # sum for the mean and between bodies
    return replace(body, covariance=body.covariance + further * np.diag(ORDERS**2))


def _scatter(bodies: Sequence[BodyEvidence], kind: str) -> float:
    """Return the mean square between repeated tests, from the tested bodies of a class or from its prior."""
    tested = [body.scatter for body in bodies if body.kind == kind]
    if tested:
        return float(np.mean(tested))
    return float(np.mean(SCATTERS**2)) * (CLASSES[kind].deviation / CLASSES["natural"].deviation) ** 2


def _sums(precisions: Sequence[FloatArray], bodies: Sequence[BodyEvidence]) -> tuple[FloatArray, FloatArray]:
    """Return the information and the moment of the mean of a class with a flat prior."""
    information, moment = np.zeros((2, 2)), np.zeros(2)
    for matrix, body in zip(precisions, bodies, strict=True):
        information, moment = information + matrix, moment + matrix @ body.mean
    return information, moment


def mixed(logarithms: FloatArray, means: FloatArray, covariances: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return mean and covariance of a mixture of distributions with unnormalised logarithms of weights."""
    weights = np.exp(logarithms - logarithms.max())
    weights = weights / weights.sum()
    mean = weights @ means
    off = means - mean
    covariance = np.einsum("k,kij->ij", weights, covariances) + np.einsum("k,ki,kj->ij", weights, off, off)
    return mean, covariance


@cache
def kept() -> dict[str, Any]:
    """Return the kept posteriors and scores of tests of real bodies."""
    return dict(json.loads(KEPT.read_text("utf-8")))


def kept_bodies() -> list[BodyEvidence]:
    """Return the kept tested bodies."""
    return [
        BodyEvidence(
            item["name"], item["kind"], item["tests"], item["earthquakes"], np.array(item["mean"]),
            np.array(item["covariance"]), item["scatter"],
        )
        for item in kept()["bodies"]
    ]  # fmt: skip


@cache
def kept_error(kind: str) -> ModelError:
    """Return the model error of a further body of a class, from the kept tests."""
    bodies = kept_bodies()
    tested = [body for body in bodies if body.kind == kind]
    listed = tested or bodies
    facts = {"class": CLASSES[kind].text, "bodies": ", ".join(body.name for body in listed),
             "tests": sum(body.tests for body in listed)}  # fmt: skip
    source = Message(_TESTED_CLASS if tested else _UNTESTED_CLASS, facts)
    return hierarchy(bodies, kind).error(source)


_TESTED_CLASS = "{class}: {tests} shaking-table tests of {bodies}, with a wide prior"
_UNTESTED_CLASS = "{class}: prior of the class; {tests} shaking-table tests of {bodies} count little"
_TESTED = (
    "Shaking-table tests of real bodies ({bodies}): of {count} tests with a predicted probability of {low} to {high}, "
    "{share} overturned (95 % interval {interval_low} to {interval_high})."
)


def evidence(probability: float) -> str:
    """Return the observed fraction of overturning in kept tests with a similar predicted probability as a sentence."""
    rows = kept()["reliability"]
    row = next((row for row in rows if row["low"] <= probability <= row["high"]), None)
    if row is None or math.isnan(probability):
        return Message("No shaking-table test of a real body has a predicted probability near this one.")
    facts: dict[str, Any] = {"bodies": ", ".join(item["name"] for item in kept()["bodies"]), "count": row["count"]}
    names = {"low": "low", "high": "high", "share": "observed", "interval_low": "observed_low",
             "interval_high": "observed_high"}  # fmt: skip
    return Message(_TESTED, facts | {name: percent(row[key]) for name, key in names.items()})
