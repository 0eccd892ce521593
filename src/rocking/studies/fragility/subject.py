"""Common parts of fragility analyses: a body under motions, limit states of its responses, and curves."""

import json
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from rocking import checks, conventions, portable
from rocking.bodies import PLANE_BODIES, Body, Restrained
from rocking.bodies.restrained import facts_of
from rocking.bodies.restraints import Restraint
from rocking.conventions import BoolArray, FloatArray, IntArray
from rocking.dynamics.mechanics import mechanics_of, study_settings
from rocking.dynamics.parameters import RockingParameters, sides_of
from rocking.dynamics.plane.fast_engine import Arrays
from rocking.dynamics.restrained.settings import RestrainedStudySettings
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError, extra
from rocking.messages import Message, plain_texts
from rocking.motions.intensity import IntensityMeasure, RockingScale, measure
from rocking.motions.pulse import Motion
from rocking.motions.summary import GROUND, provenance_of, support_of, words_on
from rocking.outcome import Outcome, contact_words, lost_contact, of_results, overturned
from rocking.quantities import attributes
from rocking.restitution.from_file import origin_of
from rocking.statistics.counts import pooled
from rocking.statistics.lognormal import LognormalFit, fit_counts
from rocking.statistics.maximum_likelihood import Separation
from rocking.studies.fragility.limit_states import DAMAGES, NAMED, LimitState
from rocking.studies.histories import HistoryTable, Product
from rocking.studies.motion_sets import MotionList, MotionSet, digest
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    import xarray as xr

Motions = MotionSet | Motion | Sequence[Motion]
Progress = Callable[[int], None] | None


_ROCKED = Outcome.ROCKED, Outcome.ROCKED_AND_SLID, Outcome.FLEW, Outcome.HELD


@dataclass(frozen=True, eq=False)
class Subject:
    """A body with its restitution, a set of motions, and the intensity measure."""

    parameters: RockingParameters  # parameters of the equations of the body
    motions: MotionSet
    measure: IntensityMeasure
    settings: Settings  # settings of the integration
    engine: str = "auto"  # name of the engine

    @classmethod
    def of(
        cls, body: Body | Restrained, motions: Motions, restitution: Any, measure_name: Any, options: dict[str, Any]
    ) -> Self:
        """Return the subject of an analysis. Options are gravity [m/s2], engine and other fields of `Settings`."""
        remaining = dict(options)
        engine = remaining.pop("engine", "auto")
        settings = study_settings(body, remaining, remaining.pop("gravity", conventions.g))
        parameters = mechanics_of(settings).parameters(body, restitution, settings)
        in_plane = isinstance(body, PLANE_BODIES)
        all_motions = motions if isinstance(motions, MotionSet) else MotionList(motions, plane=in_plane)
        return cls(parameters, all_motions, measure(measure_name), settings, engine)

    @cached_property
    def uplift_accelerations(self) -> FloatArray:
        """Ground accelerations of uplift about the right and the left foot [m/s2]."""
        tangent = partial(portable.each, math.tan)  # the levels have the same bits on every processor
        return mechanics_of(self.settings).uplift_accelerations(self.settings, self._sides, tangent)[:, 0]

    @cached_property
    def scale(self) -> RockingScale:
        """Quantities of the body for the measures, taken from the side that lifts first."""
        right, left = self.uplift_accelerations.tolist()
        side = self.parameters.left if left < right else self.parameters.right
        return RockingScale(min(right, left), side.frequency_parameter, self.settings.gravity)

    @cached_property
    def intensities(self) -> FloatArray:
        """Measures of the motions as recorded [unit of the measure]."""
        return self.measure.values(self.motions, self.scale)

    @cached_property
    def uplift_threshold(self) -> float | None:
        """Level above which all motions lift the body and below which no motion does; None if there is no such level.

        This level exists for a body with a `lowest_uplift` that is equal for both sides.
        """
        equal = math.isclose(*self.uplift_accelerations.tolist(), rel_tol=1e-12)
        return self.lowest_uplift if equal else None

    @cached_property
    def lowest_uplift(self) -> float | None:
        """Level below which no motion causes uplift of the body (its weaker side); None if there is no such level.

        This level exists for PGA, absolute or normalised, under horizontal motions, for a body that does not slide
        before uplift.
        """
        settings = self.settings
        if not mechanics_of(settings).in_plane:
            return None  # the level depends on the direction
        if self.measure.uplift is None or settings.friction * settings.gravity <= self.scale.threshold:
            return None
        return self.measure.uplift(self.scale) if self.are_horizontal else None

    @cached_property
    def names(self) -> list[str]:
        names, horizontal = [], True
        for k in range(len(self.motions)):
            motion = self.motions[k]
            names.append(motion.name)
            horizontal &= getattr(motion, "vertical", None) is None
        self.__dict__.setdefault("are_horizontal", horizontal)  # avoids a second pass over the motions
        return names

    @cached_property
    def are_horizontal(self) -> bool:
        # names are omitted, because the names of ten million motions need more memory than all results
        return all(getattr(self.motions[k], "vertical", None) is None for k in range(len(self.motions)))

    @cached_property
    def clusters(self) -> IntArray:
        """For every motion, index of the first motion with equal samples."""
        # only motions with equal intensity are compared, because generating all motions of a large set again takes long
        _, group, size = np.unique(self.intensities, return_inverse=True, return_counts=True)
        clusters, first = np.arange(len(self.motions)), dict[str, int]()
        for k in np.flatnonzero(size[group] > 1).tolist():
            clusters[k] = first.setdefault(digest(self.motions[k]), k)
        return clusters

    @cached_property
    def support(self) -> str:
        """Support of the motions: "ground", a floor, or several supports."""
        if not isinstance(self.motions, MotionList):
            return GROUND  # motions of families are motions of the ground
        return ", ".join(dict.fromkeys(support_of(self.motions[k]) for k in range(len(self.motions))))

    @property
    def measure_words(self) -> str:
        """Description of the measure, with the floor of the motions."""
        return words_on(self.support, self.measure.description)

    @property
    def label(self) -> dict[str, str]:
        """Unit and description of the measure, for labelled datasets."""
        unit = self.measure.unit
        return {"units": "1" if unit == "-" else unit, "long_name": self.measure_words}

    @property
    def restraints(self) -> tuple[str, ...]:
        """Names of the restraints; empty for a body without restraints."""
        return tuple(restraint.name for restraint in self._restraints)

    @property
    def _restraints(self) -> tuple[Restraint, ...]:
        settings = self.settings
        return settings.body.restraints if isinstance(settings, RestrainedStudySettings) else ()

    @property
    def _restraint_facts(self) -> dict[str, str]:
        facts = [facts_of(restraint) for restraint in self._restraints]
        return {"restraints": json.dumps(facts)} if facts else {}

    def check_states(self, states: Sequence[LimitState]) -> None:
        """Raise an error for a state that no restraint of the body can reach."""
        for state in states:
            able = [item.name for item in self._restraints if state.damage in item.damages]
            if state.damage and not [name for name in able if name == (state.restraint or name)]:
                raise InvalidValueError(
                    "no restraint of the body can reach {value}; {damage} is possible for {names}",
                    parameter="limit_states", value=state.name, damage=state.damage, names=", ".join(able) or "none",
                )  # fmt: skip

    @property
    def _sides(self) -> dict[str, FloatArray]:
        return sides_of([self.parameters])

    def product(self, factors: FloatArray) -> Product:
        """Return the histories of every motion with factors [-]."""
        sides = {name: values[:, None] for name, values in self._sides.items()}
        return Product(
            self.motions, sides, factors, law=self.parameters.law, settings=self.settings, engine=self.engine
        )

    def table(self, motion: np.ndarray, factors: FloatArray) -> HistoryTable:
        """Return a table of histories from indices of motions and scale factors [-]."""
        return HistoryTable(
            self.motions, motion, self._sides | {"scale": factors},
            law=self.parameters.law, settings=self.settings, engine=self.engine,
        )  # fmt: skip

    @property
    def _provenance(self) -> str:
        """Source and processing of the motions, or description of a family."""
        if not isinstance(self.motions, MotionList):
            return json.dumps(self.motions.description())
        return json.dumps([list(provenance_of(self.motions[k])) for k in range(len(self.motions))])

    def about(self) -> dict[str, Any]:
        """Return body, measure, restitution and settings as plain values, for the attributes of a file."""
        return {
            "software": SOFTWARE,
            "im": self.measure.name,
            "im_description": self.measure_words,
            "im_unit": self.measure.unit,
            "restitution": self.parameters.label,
            **({} if self.support == GROUND else {"support": self.support}),
            "motion_provenance": self._provenance,
            **origin_of(self.parameters.label),
            **{f"body_{name}": float(values[0]) for name, values in self._sides.items()},
            **self._restraint_facts,
            **{f"setting_{k}": int(v) if isinstance(v, bool) else v for k, v in self.settings.stated.items()},
        }


def checked_levels(name: str, values: Any, unit: str) -> FloatArray:
    """Return levels of a measure. Raise an error if they are not above zero or do not increase."""
    levels = np.atleast_1d(checks.positive_array(name, values, unit)).copy()
    if levels.ndim != 1 or not levels.size:
        raise InvalidValueError(parameter=name, allowed=f"a row of numbers [{unit}]", value=values)
    checks.increasing(name, levels, unit)
    return levels


@dataclass(frozen=True, eq=False)
class Responses:
    """Results of histories, with any shape, for the evaluation of limit states."""

    outcome: np.ndarray  # codes of `Outcome`
    # largest rotation / alpha of its side [-]; infinite if overturned, NaN if the history failed
    rotation: FloatArray
    sides: np.ndarray  # side of overturning: 1 right, -1 left, 0 without overturning
    # 1 for a tensile contact force, as in `lost_contact` [-]; None if not computed
    lost: FloatArray | None = None
    restraints: tuple[str, ...] = ()  # names of the restraints
    # sums of 2^k over the restraints k with a damage, by the names in `DAMAGES`
    damaged: dict[str, IntArray] = field(default_factory=dict)

    @classmethod
    def of(cls, arrays: Arrays, parameters: Any, shape: tuple[int, ...], restraints: Sequence[str] = ()) -> "Responses":
        """Return the responses of one body from results, with a given shape. `restraints` are their names."""
        missing = {"outcome", "peak_rotation"} - set(arrays)
        sizes = {np.size(arrays[name]) for name in ("outcome", "peak_rotation") if name in arrays}
        if missing or sizes != {math.prod(shape)}:
            raise InvalidValueError(
                "{parameter} must be outcome and peak_rotation of {count} histories, got {names} of {sizes}",
                parameter="results", count=math.prod(shape), names=sorted(arrays), sizes=sorted(sizes),
                hint="Check that the results belong to this study.",
            )  # fmt: skip
        outcome = np.asarray(arrays["outcome"], dtype=np.int8).reshape(shape)
        peak = np.asarray(arrays["peak_rotation"], dtype=np.float64).reshape(shape)
        right, left = parameters.right.slenderness_angle, parameters.left.slenderness_angle
        over, to_right = outcome == Outcome.OVERTURNED.code, peak > 0.0
        rotation = np.abs(peak)  # there may be ten million values, so that copies are avoided
        rotation /= right if right == left else np.where(to_right, right, left)
        rotation[over], rotation[outcome == Outcome.FAILED.code] = math.inf, math.nan
        lost = lost_contact(arrays).reshape(shape) if "least_force" in arrays else None
        columns = zip(DAMAGES, ("yielded_restraints", "broken_restraints"), strict=True)
        damaged = {name: np.asarray(arrays[column]).reshape(shape) for name, column in columns if column in arrays}
        side = over * np.where(to_right, np.int8(1), np.int8(-1))
        return cls(outcome, rotation, side, lost, tuple(restraints), damaged)

    @property
    def contact(self) -> str:
        """Number of histories with a tensile contact force, as a sentence; empty if 0."""
        if self.restraints:
            return Message("the contact force is not computed in studies of bodies with restraints")
        return "" if self.lost is None else contact_words(self.lost)

    @property
    def good(self) -> BoolArray:
        """True for histories with a result."""
        return np.asarray(self.outcome != Outcome.FAILED.code)

    @property
    def rocked(self) -> BoolArray:
        """True for histories that rocked without overturning. A flat hop is not rocking."""
        hopped = (self.outcome == Outcome.FLEW.code) & ~(self.rotation > 0.0)
        return np.asarray(np.isin(self.outcome, [outcome.code for outcome in _ROCKED]) & ~hopped)

    @property
    def overturned(self) -> FloatArray:
        """1 if overturned, 0 if not, NaN without a result [-]."""
        return overturned(self.outcome)

    def exceed(self, state: LimitState) -> FloatArray:
        """Return 1 for histories that reached a limit state, 0 for other histories, NaN without a result [-].

        An overturned body has reached every state of its restraints.
        """
        if state.damage:
            bits = 1 << self.restraints.index(state.restraint) if state.restraint else -1
            return of_results(self.outcome, ((self.damaged[state.damage] & bits) != 0) | (self.overturned == 1.0))
        if state.level == 0.0:
            return of_results(self.outcome, self.rocked | (self.overturned == 1.0))
        if math.isinf(state.level):
            return self.overturned
        with np.errstate(invalid="ignore"):
            return of_results(self.outcome, self.rotation > state.level)

    def labelled(self, dimensions: Any) -> dict[str, Any]:
        """Return outcome and rotation as variables of a labelled dataset."""
        meaning = "largest rotation / alpha; infinite if overturned, NaN if the history failed"
        variables: dict[str, Any] = {
            "outcome": (dimensions, self.outcome, attributes("outcome")),
            "rotation": (dimensions, self.rotation, {"units": "1", "long_name": meaning}),
        }
        if self.lost is not None:
            variables["lost_contact"] = (dimensions, self.lost, attributes("lost_contact"))
        return variables

    def counts(self) -> dict[Outcome, int]:
        """Return the number of histories by outcome, without failed histories."""
        counts = {outcome: int((self.outcome == outcome.code).sum()) for outcome in Outcome}
        del counts[Outcome.FAILED]
        always = Outcome.NO_UPLIFT, Outcome.ROCKED, Outcome.OVERTURNED
        return {outcome: n for outcome, n in counts.items() if n or outcome in always}


@dataclass(frozen=True)
class UpliftCheck:
    """Check of the histories against theory: rocking above PGA = g tan(alpha), and no rocking below."""

    # uplift level [unit of the measure]; None if the measure has no uplift level
    threshold: float | None
    checked: int  # number of compared histories; histories within 1e-9 of the threshold are not compared
    contradictions: int  # number of histories that rocked below the threshold or did not rock above it

    @property
    def verdict(self) -> str:
        """The result of the check as a sentence."""
        if self.threshold is None:
            return "no level of this measure alone decides whether the body rocks"
        return (
            f"rocking is certain above {self.threshold:.6g} and impossible below: "
            f"{self.contradictions} of {self.checked} histories contradict it"
        )


def uplift_check(subject: Subject, levels: FloatArray, responses: Responses) -> UpliftCheck:
    """Return the check of histories at levels [unit of the measure] against the threshold of uplift."""
    threshold = subject.uplift_threshold
    if threshold is None:
        return UpliftCheck(None, 0, 0)
    clear = responses.good & (np.abs(levels / threshold - 1.0) > 1e-9)
    rocked = responses.exceed(LimitState("rocking", 0.0))
    return UpliftCheck(threshold, int(clear.sum()), int((clear & (rocked != (levels > threshold))).sum()))


def fits_of(
    subject: Subject, limit_states: Sequence[LimitState], levels: FloatArray, responses: Responses
) -> dict[str, LognormalFit]:
    """Return the lognormal curves of the states, for histories at levels [unit of the measure]."""
    uncertain = [state for state in limit_states if state.level != 0.0 or subject.uplift_threshold is None]
    reached = [responses.exceed(state) == 1.0 for state in uncertain]
    counts = pooled(levels, responses.good, reached, subject.clusters)
    return {state.name: fit_counts(count) for state, count in zip(uncertain, counts, strict=True)}


@dataclass(frozen=True, eq=False, repr=False)
class FragilityAnalysis(ABC):
    """Base class of fragility analyses: histories of one subject, reached states, and curves."""

    subject: Subject
    limit_states: tuple[LimitState, ...]  # from rocking to overturned
    histories: Product  # the computed histories
    responses: Responses

    kind: ClassVar[str]
    definition: ClassVar[str]

    def __repr__(self) -> str:
        histories, measure = self.responses.outcome.size, self.subject.measure
        curves = "".join(f"\n  {name}: {fit!r}" for name, fit in self.fits.items())
        return f"<{type(self).__name__}: {histories} histories over {measure.name} [{measure.unit}]{curves}>"

    @property
    @abstractmethod
    def history_levels(self) -> FloatArray:
        """Levels of the histories, with the shape of the responses [unit of the measure]."""

    @property
    def failed(self) -> int:
        """Number of failed histories. Other counts exclude them."""
        return int((~self.responses.good).sum())

    @cached_property
    def fits(self) -> dict[str, LognormalFit]:
        """Lognormal curves of the states from the outcomes. Rocking has no curve if the uplift level decides it."""
        return fits_of(self.subject, self.limit_states, self.history_levels, self.responses)

    def fit_of(self, name: str) -> LognormalFit:
        """Return the curve of ``rocking`` or ``overturning``, even if it is not among the states."""
        state = NAMED[name]
        if state.name in self.fits:
            return self.fits[state.name]
        return fits_of(self.subject, [state], self.history_levels, self.responses)[state.name]

    @property
    def verdicts(self) -> dict[str, list[str]]:
        """Verdicts, by state, on curves that are not a maximum of the likelihood; without verdicts on intervals."""
        limit_states: dict[str, list[str]] = {}
        for name, fit in self.fits.items():
            if fit.separation is not Separation.OVERLAP or not fit.exists:
                limit_states.setdefault(fit.verdict_in("", clusters=False), []).append(name)
        return limit_states

    @cached_property
    def uplift(self) -> UpliftCheck:
        """Check of the histories against the threshold of uplift."""
        return uplift_check(self.subject, self.history_levels, self.responses)

    def _labelled(self, data: dict[str, Any], coordinates: dict[str, Any], definition: str) -> "xr.Dataset":
        xarray = extra("xarray", "a labelled dataset")
        about = self.subject.about() | {"definition": definition, "uplift": self.uplift.verdict, "failed": self.failed}
        names = {"motion_name": ("motion", self.subject.names)}
        labelled: xr.Dataset = xarray.Dataset(
            data, coords=coordinates | names, attrs=plain_texts(about | {"contact": self.responses.contact})
        )
        return labelled

    def summary(self) -> dict[str, Any]:
        """Return definition, check and curves as plain values. Medians are in the unit of the measure."""
        return {
            "analysis": self.kind,
            "definition": self.definition,
            "im": self.subject.measure.name,
            "unit": self.subject.measure.unit,
            "uplift": self.uplift.verdict,
            "failed": self.failed,
            "contact": self.responses.contact,
            **self._summary_of_kind(),
            "curves": {name: fit.summary() for name, fit in self.fits.items()},
        }

    def _summary_of_kind(self) -> dict[str, Any]:
        return {}
