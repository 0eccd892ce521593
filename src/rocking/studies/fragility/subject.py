"""One body under a set of motions: what all fragility analyses ask about."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np

from rocking import checks, conventions
from rocking.bodies import Body
from rocking.conventions import FloatArray, IntArray
from rocking.dynamics.parameters import RockingParameters
from rocking.dynamics.plane.batch import PIECE, SIDES
from rocking.dynamics.plane.fast_engine import Arrays, empty_results
from rocking.dynamics.response import Motion
from rocking.dynamics.settings import Settings, settings_of
from rocking.errors import InvalidValueError
from rocking.motions.intensity import IntensityMeasure, RockingScale, measure
from rocking.studies.histories import Histories, HistoryTable, Product
from rocking.studies.motion_set import MotionList, MotionSet, digest
from rocking.version import SOFTWARE

Motions = MotionSet | Motion | Sequence[Motion]
Progress = Callable[[int], None] | None


@dataclass(frozen=True, eq=False)
class Subject:
    """A body with its restitution, a set of motions, and the measure of their intensity."""

    rocker: RockingParameters  # the body as the equations see it
    motions: MotionSet
    measure: IntensityMeasure
    settings: Settings  # how to integrate
    engine: str = "auto"  # which engine

    @classmethod
    def of(cls, body: Body, motions: Motions, restitution: Any, measure_name: Any, options: dict[str, Any]) -> Self:
        """Return the subject of an analysis.

        options: ``gravity`` [m/s2], ``engine`` and other fields of `Settings`.
        """
        rest = dict(options)
        engine = rest.pop("engine", "auto")
        settings = settings_of(rest.pop("gravity", conventions.g), rest)
        rocker = RockingParameters.of_body(body, restitution, settings.gravity)
        given = motions if isinstance(motions, MotionSet) else MotionList(motions)
        return cls(rocker, given, measure(measure_name), settings, engine)

    @cached_property
    def scale(self) -> RockingScale:
        """What of the body the measures know: of the side that lifts first."""
        side = min(self.rocker.right, self.rocker.left, key=lambda s: s.slenderness_angle)
        alpha, gravity = side.slenderness_angle, self.settings.gravity
        tangent = alpha if self.settings.linear else math.tan(alpha)  # Eq. 25
        return RockingScale(gravity * tangent, side.frequency_parameter, gravity)

    @cached_property
    def intensities(self) -> FloatArray:
        """Measure of each motion as it is given [unit of the measure]."""
        return self.measure.values(self.motions, self.scale)

    @cached_property
    def uplift_threshold(self) -> float | None:
        """Level of the measure above which every motion lifts the body, and below which none does, if there is one.

        There is one for PGA, absolute or normalised, of a body with equal sides under horizontal motions.
        """
        if self.measure.uplift is None:
            return None
        equal = math.isclose(self.rocker.right.slenderness_angle, self.rocker.left.slenderness_angle, rel_tol=1e-12)
        return self.measure.uplift(self.scale) if equal and self._are_horizontal else None

    @cached_property
    def names(self) -> list[str]:
        """Names of the motions."""
        found, horizontal = [], True
        for k in self._all:
            motion = self.motions[k]
            found.append(motion.name)
            horizontal &= getattr(motion, "vertical", None) is None
        self.__dict__.setdefault("_are_horizontal", horizontal)  # no motion is made twice for both
        return found

    @cached_property
    def _are_horizontal(self) -> bool:
        # without the names: those of ten million motions take more room than all results
        return all(getattr(self.motions[k], "vertical", None) is None for k in self._all)

    @property
    def _all(self) -> range:
        return range(len(self.motions))

    @cached_property
    def clusters(self) -> IntArray:
        """Number of the first motion that is the same as each motion, sample by sample.

        Only motions of equal intensity are compared: to make all those of a large set once more would take long.
        """
        _, group, size = np.unique(self.intensities, return_inverse=True, return_counts=True)
        found, first = np.arange(len(self.motions)), dict[str, int]()
        for k in np.flatnonzero(size[group] > 1).tolist():
            found[k] = first.setdefault(digest(self.motions[k]), k)
        return found

    @property
    def label(self) -> dict[str, str]:
        """Unit and words of the measure, for labelled datasets."""
        unit = self.measure.unit
        return {"units": "1" if unit == "-" else unit, "long_name": self.measure.words}

    @property
    def _sides(self) -> dict[str, float]:
        return {
            f"{short}_{foot}": getattr(getattr(self.rocker, foot), name)
            for short, name in SIDES
            for foot in ("right", "left")
        }

    def product(self, factors: FloatArray) -> Product:
        """Return the histories of every motion with factors.

        factors: factors on the motions [-].
        """
        sides = {name: np.array([[value]]) for name, value in self._sides.items()}
        return Product(self.motions, sides, factors, law=self.rocker.law, settings=self.settings, engine=self.engine)

    def table(self, motion: np.ndarray, factors: FloatArray) -> HistoryTable:
        """Return histories given one by one.

        factors: factor on it [-].
        """
        values = {name: np.array([value]) for name, value in self._sides.items()}
        return HistoryTable(
            self.motions, motion, values | {"scale": factors},
            law=self.rocker.law, settings=self.settings, engine=self.engine,
        )  # fmt: skip

    def about(self) -> dict[str, Any]:
        """Return what was asked about, as plain values for the attributes of a file."""
        sides = {f"body_{name}": value for name, value in self._sides.items()}
        return {
            "software": SOFTWARE,
            "measure": self.measure.name,
            "measure_words": self.measure.words,
            "measure_unit": self.measure.unit,
            "restitution": self.rocker.label,
            **sides,
            **{f"setting_{k}": int(v) if isinstance(v, bool) else v for k, v in self.settings.stated.items()},
        }


def checked_levels(name: str, given: Any, unit: str) -> FloatArray:
    """Return levels of a measure if they are above zero and increase.

    given: the levels [unit of the measure].
    """
    levels = np.atleast_1d(checks.positive_array(name, given, unit)).copy()
    if levels.ndim != 1 or not levels.size or np.any(np.diff(levels) <= 0.0):
        raise InvalidValueError(f"{name} must be numbers [{unit}], each above the one before, got {given!r:.60}")
    return levels


def results_of(histories: Histories, *, threads: int | None = None, progress: Progress = None) -> Arrays:
    """Return the results of all histories, computed piece by piece."""
    check_progress(progress)
    results = empty_results(histories.count)
    for first in range(0, histories.count, PIECE):
        last = min(first + PIECE, histories.count)
        for name, values in histories.run(first, last, threads=threads).items():
            results[name][first:last] = values
        if progress is not None:
            progress(last - first)
    return results


def check_progress(progress: Any) -> None:
    """Refuse what cannot be told how far the work is."""
    if progress is not None and not callable(progress):
        raise InvalidValueError(f"progress must be a function of the histories done, or None, got {progress!r:.60}")
