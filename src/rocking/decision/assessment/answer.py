"""Result of an assessment: outcome and margin with each model, and the sentences on them."""

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from rocking.answers import Answer
from rocking.bodies import Body, Solid
from rocking.bodies.equilibria import Pass, StablePose
from rocking.conventions import FEET, FloatArray, IntArray, g, percent
from rocking.decision.code_methods.comparison import AT_MOST
from rocking.decision.prediction import Prediction
from rocking.decision.prediction.forecast import input_label
from rocking.decision.remedies import CALIBRATED, Remedies, millimetres, rounded_up
from rocking.messages import Message
from rocking.motions.summary import peak_name, support_of

_IN_PLANE = "The plane body along {direction}, without sliding, has a margin of {factor:.3g}."
_IN_PLANE_STANDS = "The plane body along {direction}, without sliding, does not overturn at any computed factor."
_LOWEST_PASS = (
    "Toppling requires a rise of the centre of mass of at least {rise:.3g} mm ({energy:.3g} J), towards {direction}."
)
_WEAKEST = (
    "The weakest direction is {direction}, counter-clockwise from the x axis of the body. The base edge there is "
    "{reach:.3g} m from the projection of the centre of mass, which is {height:.3g} m high."
)
_LIFTS_FIRST = (
    "At this azimuth, uplift begins towards {direction}, counter-clockwise from the x axis of the body. The base edge "
    "there is {reach:.3g} m from the projection of the centre of mass, which is {height:.3g} m high."
)
_NEVER_LIFTS = "No uplift and no overturning: 0 of {motions}, {models}, both polarities."
_STANDS = "The body rocks but does not overturn: 0 of {motions}, {models}, both polarities."
_DEPENDS = (
    "The result depends on the restitution model: under {with_some} of {motions} the body overturns with at least one "
    "of {models}, under {with_all} with all of them."
)
_DEPENDS_UNDER_ONE = "The result depends on the restitution model: the body overturns with {count} of {models}."
_MARGINS = {  # keys: (True for a single motion, True if the factor is a margin)
    (True, True): "{factor:.3g} times this record ({model}), a {peak} of {acceleration:.3g} g.",
    (False, True): "{factor:.3g} times {motion} ({model}), a {peak} of {acceleration:.3g} g.",
    (True, False): (
        "{factor:.3g} times this record ({model}), a {peak} of {acceleration:.3g} g. The body does not overturn under "
        "the unscaled motion, so this factor is not a margin."
    ),
    (False, False): (
        "{factor:.3g} times {motion} ({model}), a {peak} of {acceleration:.3g} g. The body does not overturn under "
        "the unscaled motion, so this factor is not a margin."
    ),
}
_SIDES = {
    "left": "The left side is weaker: the centre of mass is {reach:.3g} m from and {height:.3g} m above that foot.",
    "right": "The right side is weaker: the centre of mass is {reach:.3g} m from and {height:.3g} m above that foot.",
    "either": "The centre of mass is {reach:.3g} m from and {height:.3g} m above each foot.",
}
_UPLIFT = "Uplift begins at {limit:.3g} g, at {factor:.3g} times {motion}."
_UPLIFT_WITH_VERTICAL = (
    "Without vertical acceleration, uplift begins at {limit:.3g} g. With the vertical acceleration of {motion}, uplift "
    "begins at {factor:.3g} times this motion."
)
_MARGIN_RANGE = "The margin is {low:.3g} ({lower}) to {high:.3g} ({higher}), depending on the restitution model."
_SAME = "The margin is {low:.3g} with each of {models}."
_SLIDES_FIRST = (
    "With a friction coefficient of {friction:.3g} (b/h = {slope:.3g}), the body slides before uplift: {result}."
)
_SLIDES_LATER = (
    "With a friction coefficient of {friction:.3g} (b/h = {slope:.3g}), the body can slide only during rocking: "
    "{result}."
)
_MAIN_INPUT = "{input} ({share:.0f} % of the variance)."
_NO_MAIN_INPUT = (
    "No single uncertain input is distinguishable (95 %) as the main one. The largest total index of overturning is "
    "that of {input}, {share:.2f}."
)
_ANCHORS = {
    ("left", "right"): (
        "Anchors that prevent uplift under {motion}: {left:.3g} kN along the left edge and {right:.3g} kN along the "
        "right edge; total shear {shear:.3g} kN."
    ),
    ("left",): (
        "Anchors that prevent uplift under {motion}: {left:.3g} kN along the left edge; total shear {shear:.3g} kN."
    ),
    ("right",): (
        "Anchors that prevent uplift under {motion}: {right:.3g} kN along the right edge; total shear {shear:.3g} kN."
    ),
}
_WIDER = (
    "Base wider: not found, {reason}.",
    "Base wider by {length} mm on each side: no history overturns.",
    "Base wider by {length} mm on each side: no uplift.",
)
_LOWER = (
    "Centre of mass lower: not found, {reason}.",
    "Centre of mass lower by {length} mm: no history overturns.",
    "Centre of mass lower by {length} mm: no uplift.",
)
_ISOLATORS = (
    "Isolators with a period of {period:.3g} s or more prevent uplift; their displacement at that period is "
    "{distance} mm."
)


def _cases(names: Collection[str]) -> Message:
    """Return the number of restitution cases, and of the models, coefficients and interval ends among them."""
    models, values, ends = map(len, cases_by_kind(names).values())
    counts = [
        (models, Message("{count} model", {"count": models}, "{count} models")),
        (values, Message("{count} coefficient", {"count": values}, "{count} coefficients")),
        (ends, Message("{count} ends of the 95 % interval of the calibrated model", {"count": ends})),
    ]
    first, *others = (text for count, text in counts if count)
    for other in others:
        first = Message("{first}, {second}", {"first": first, "second": other})
    facts = {"count": len(names), "parts": first}
    return Message("{count} restitution case ({parts})", facts, "{count} restitution cases ({parts})")


def cases_by_kind(names: Iterable[str]) -> dict[str, list[str]]:
    """Return the restitution cases: models, coefficients, and ends of the interval of the calibrated model."""
    kinds: dict[str, list[str]] = {"model": [], "coefficient": [], "end": []}
    for name in names:
        is_end, is_coefficient = name.startswith(f"{CALIBRATED}, "), name.startswith("r = ")
        kinds["end" if is_end else "coefficient" if is_coefficient else "model"].append(name)
    return kinds


def just_above(factor: float) -> float:
    """Return a factor that is certain to overturn, from a smallest factor with a tolerance of 0.1 %; 1 is unchanged."""
    return factor if factor == 1.0 else 1.001 * factor


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle) % 360.0:.0f} deg"


def _source(name: str) -> Message | str:
    """Return the label of an input or of the choice of the motion."""
    return Message("the choice of motion") if name == "case" else input_label(name)


@dataclass(frozen=True, eq=False)
class ModelMargin:
    """Outcomes and smallest overturning factors with one restitution.

    Parameters
    ----------
    coefficients : dict of str to float
        Coefficient of restitution, by landing foot [-].
    overturned : ndarray, shape (motions,)
        1 if the body overturns under the unscaled motion in at least one polarity; NaN without a result.
    min_factors_by_polarity : ndarray, shape (polarities, motions)
        Smallest overturning factor on each motion, as recorded and reversed; infinite if no factor overturns [-].
    """

    coefficients: Mapping[str, float]
    overturned: FloatArray
    min_factors_by_polarity: FloatArray

    def answer(self) -> Answer:
        """Return the result with this restitution.

        Returns
        -------
        Answer
            Coefficients, outcomes and smallest scale factors.
        """
        return Answer({
            "coefficient": self.coefficients, "overturned": self.overturned, "factors": self.min_factors_by_polarity,
            "min_factor": self.min_factor,
        })  # fmt: skip

    @property
    def min_factor(self) -> float:
        """Smallest overturning factor of all motions [-]."""
        computed = self.min_factors_by_polarity[~np.isnan(self.min_factors_by_polarity)]
        return float(computed.min()) if computed.size else math.nan

    @property
    def governing_case(self) -> tuple[int, int]:
        """Indices of polarity and motion of the smallest factor."""
        polarity, motion = np.unravel_index(
            int(np.argmin(np.nan_to_num(self.min_factors_by_polarity, nan=np.inf))), self.min_factors_by_polarity.shape
        )
        return int(polarity), int(motion)


@dataclass(frozen=True, eq=False)
class StandingSolid:
    """A solid in its initial pose, its plane body, and its overturning at the smallest factor."""

    solid: Solid
    pose: StablePose
    # outward normal of the edge where uplift begins, from the x axis of the solid [rad]
    plane_azimuth: float
    edge_distance: float  # horizontal distance between this edge and the centre of mass [m]
    is_weakest: bool  # True if this edge is the nearest edge
    lowest_pass: Pass | None  # lowest pass into another pose
    min_factor_in_plane: float = math.nan  # smallest overturning factor of the plane body, without sliding [-]
    overturning_direction: float = math.nan  # direction of overturning, from the solid's x axis [rad]
    sliding_distance: float = math.nan  # sliding distance in the history with overturning [m]
    restitution: Any = None  # restitution of this history, as for `simulate`
    azimuth: float = 0.0  # azimuth of the solid's x axis in this history [rad]

    @property
    def sentences(self) -> tuple[Message, str]:
        """Sentences on the weakest direction, and on energy barrier and overturning."""
        lowest_pass = self.lowest_pass
        facts = {"direction": _degrees(self.plane_azimuth), "reach": self.edge_distance, "height": self.pose.height}
        sentences = [
            Message(
                _IN_PLANE_STANDS if math.isinf(self.min_factor_in_plane) else _IN_PLANE,
                {**facts, "factor": self.min_factor_in_plane},
            )
        ]
        if lowest_pass is not None:
            rise = {
                "rise": 1e3 * lowest_pass.rise,
                "energy": lowest_pass.energy,
                "direction": _degrees(lowest_pass.azimuth),
            }
            sentences.insert(0, Message(_LOWEST_PASS, rise))
        if not math.isnan(self.overturning_direction):
            sentences.insert(
                0,
                Message(
                    "At the margin the body overturns towards {direction}.",
                    {"direction": _degrees(self.overturning_direction)},
                ),
            )
        return Message(_WEAKEST if self.is_weakest else _LIFTS_FIRST, facts), Message.joined(sentences)

    def answer(self) -> Answer:
        """Return the results of the 3D body."""
        lowest_pass, pose = self.lowest_pass, self.pose
        return Answer({
            "plane_azimuth": self.plane_azimuth, "plane_is_weakest": self.is_weakest, "centre_height": pose.height,
            "nearest_edge": self.edge_distance, "barrier": pose.barrier,
            "barrier_energy": math.nan if lowest_pass is None else lowest_pass.energy,
            "barrier_azimuth": math.nan if lowest_pass is None else lowest_pass.azimuth,
            "min_factor_in_plane": self.min_factor_in_plane, "direction": self.overturning_direction,
            "sliding_distance": self.sliding_distance,
        })  # fmt: skip


class Lowest(NamedTuple):
    """Smallest overturning factor, its model, motion and polarity."""

    factor: float
    model: str
    motion: int
    mirrored: bool


@dataclass(frozen=True, eq=False, repr=False)
class BodyAssessment:
    """Overturning of a body: outcome, margin, probability, causes and measures.

    Parameters
    ----------
    body : Body
        The body, or the plane body of a solid.
    motions : tuple of GroundMotion, or of Components
        The motions in its plane; for two components or a solid, one entry per computed direction.
    records : ndarray, shape (motions,)
        Index of the input motion of each direction.
    models : dict of str to ModelMargin
        Results by name of the restitution; plane bodies without sliding, solids with friction.
    refused : dict of str to str
        Models that do not apply to the body, with the reason.
    friction : float
        Coefficient of friction of `sliding` [-].
    sliding : ModelMargin
        Result with sliding, hopping and flight, for the model of the smallest margin.
    uplift_factors : ndarray, shape (motions,)
        Smallest factor on each motion with uplift [-].
    capacities : dict of str to ndarray
        Largest factor on each motion rated safe by a code method; NaN outside the method's domain [-].
    prediction : Prediction
        Probability of overturning, with uncertain inputs sampled.
    remedies : Remedies
        Retrofit measures.
    gravity : float
        Acceleration of gravity [m/s2].
    standing : StandingSolid, optional
        The assessed solid; None for a plane body.
    outside : dict of str to str
        Reason why a code method does not apply to the body or motions, by method.
    vertical : int
        Number of motions with a vertical component.
    """

    body: Body
    motions: tuple[Any, ...]
    records: IntArray
    models: Mapping[str, ModelMargin]
    refused: Mapping[str, str]
    friction: float
    sliding: ModelMargin
    uplift_factors: FloatArray
    capacities: Mapping[str, FloatArray]
    prediction: Prediction
    remedies: Remedies
    gravity: float = g
    standing: StandingSolid | None = None
    outside: Mapping[str, str] = field(default_factory=dict)
    vertical: int = 0

    def exclusion(self, method: str) -> str:
        """Return the reason why a code method does not apply.

        Parameters
        ----------
        method : str
            Name of the method.

        Returns
        -------
        str
            Text for a table or a picture.
        """
        reason = self.outside.get(method)
        return f"outside its domain: {reason}" if reason else "outside its domain"

    @cached_property
    def lowest(self) -> Lowest:
        """Smallest overturning factor of all motions and models, without sliding."""
        name = min(
            self.models, key=lambda label: (math.isnan(self.models[label].min_factor), self.models[label].min_factor)
        )
        polarity, motion = self.models[name].governing_case
        return Lowest(self.models[name].min_factor, name, motion, bool(polarity))

    def by_record(self, values: FloatArray, worst: np.ufunc = np.fmax) -> FloatArray:
        """Return the worst value of all directions of each input motion.

        Parameters
        ----------
        values : ndarray, shape (motions,)
            One value per direction; NaN without a value.
        worst : ufunc
            Function that returns the worse of two values.

        Returns
        -------
        ndarray
            One value per input motion.
        """
        return np.array([worst.reduce(values[self.records == k]) for k in np.unique(self.records)])

    def count_overturned(self, margin: ModelMargin) -> int:
        """Return the number of input motions with overturning in at least one direction.

        Parameters
        ----------
        margin : ModelMargin
            Result with one restitution.

        Returns
        -------
        int
            Number of input motions.
        """
        return int(np.nansum(self.by_record(margin.overturned)))

    @property
    def overturning_fraction(self) -> FloatArray:
        """Fraction of models with overturning under each input motion, in at least one direction [-]."""
        rows = np.array([self.by_record(margin.overturned) for margin in self.models.values()])
        computed = (~np.isnan(rows)).sum(axis=0)
        return np.where(computed > 0, np.nansum(rows, axis=0) / np.maximum(computed, 1), np.nan)

    @property
    def verdict(self) -> str:
        """Outcome as a sentence, with a caution if a stated depth is the weaker side."""
        caution = self.body.caution
        return Message.joined([self._outcome, caution]) if caution else self._outcome

    @property
    def _outcome(self) -> str:
        with_all, with_some = (
            int((self.overturning_fraction == 1.0).sum()),
            int((self.overturning_fraction > 0.0).sum()),
        )
        facts = {
            "motions": self.motion_count, "models": _cases(self.models),
            "with_all": with_all, "with_some": with_some,
        }  # fmt: skip
        if math.isnan(self.lowest.factor):
            return "No history has a result; overturning cannot be assessed."
        if not with_some:
            return Message(_NEVER_LIFTS if (self.uplift_factors > 1.0).all() else _STANDS, facts)
        if with_all == with_some:
            return Message(
                "The body overturns under {count} of {motions} with all of {models}.", {"count": with_all, **facts}
            )
        if self.overturning_fraction.size == 1:
            count = sum(self.by_record(margin.overturned)[0] == 1.0 for margin in self.models.values())
            return Message(_DEPENDS_UNDER_ONE, {"count": int(count), **facts})
        return Message(_DEPENDS, {"with_some": with_some, "with_all": with_all, **facts})

    @property
    def margin_sentence(self) -> str:
        """Margin to overturning as a sentence."""
        if math.isinf(self.lowest.factor):
            return self.margin_value
        return Message("Margin to overturning: {margin}", {"margin": self.margin_value})

    @property
    def margin_value(self) -> str:
        """Value, restitution model and peak acceleration of the margin as text."""
        factor, model, motion, mirrored = self.lowest
        if math.isnan(factor):
            return Message("not available.")
        if math.isinf(factor):
            return Message("No computed scale factor on {records} overturns the body.", {"records": self._this})
        mirrored_model = "{model}, mirrored" if self.standing is None else "{model}, rotated by 180 deg"
        facts = {
            "factor": factor,
            "motion": self.motions[motion].name,
            "model": Message(mirrored_model, {"model": model}) if mirrored else model,
            "peak": peak_name(support_of(self.motions[motion])),
            "acceleration": factor * self.motions[motion].peak / g,
        }
        required, overturned = self.remedies.margin, self.models[model].overturned[motion]
        is_margin = factor >= 1.0 or overturned != 0.0
        sentences = [Message(_MARGINS[len(self.motions) == 1, is_margin], facts)]
        if required > max(factor, 1.0):
            sentences.append(Message("The required margin of {margin:g} is not reached.", {"margin": required}))
        return Message.joined(sentences)

    @property
    def probability_sentence(self) -> str:
        """Probability of overturning, under all motions and under the worst, as sentences."""
        chance = self.prediction.chances["overturning"]
        sentence = Message("With uncertain inputs sampled: {verdict}", {"verdict": self.prediction.verdict})
        if len(self.prediction.motions) == 1:
            return sentence
        worst = int(np.nanargmax(chance.per_motion))
        largest = percent(round(float(chance.per_motion[worst]), 3))
        name = self.prediction.motions[worst].name
        return Message.joined([
            sentence,
            Message(
                "All motions are equally likely. The largest probability is {probability}, under {motion}.",
                {"probability": largest, "motion": name},
            ),
        ])  # fmt: skip

    @property
    def governing_factors(self) -> tuple[str, ...]:
        """Sentences on the causes of the result."""
        sides = {foot: self.body.side(foot, self.gravity) for foot in FEET}
        weaker = min(sides, key=lambda foot: sides[foot].slenderness_angle)
        side, first_lifting = sides[weaker], int(np.argmin(self.uplift_factors))
        text = _SIDES["either" if self.body.is_symmetric else weaker]
        position = Message(text, {"reach": side.half_width, "height": side.centre_height})
        if self.standing is not None:
            position = self.standing.sentences[0]
        motion = self.motions[first_lifting]
        facts = {
            "limit": side.uplift_acceleration / g,
            "factor": self.uplift_factors[first_lifting],
            "motion": motion.name,
        }
        uplift = Message(_UPLIFT if motion.vertical is None else _UPLIFT_WITH_VERTICAL, facts)
        sentences = [Message.joined([position, uplift])]
        margins = {name: item.min_factor for name, item in self.models.items() if math.isfinite(item.min_factor)}
        if len(margins) > 1:
            low, high = min(margins, key=margins.__getitem__), max(margins, key=margins.__getitem__)
            facts = {"low": margins[low], "lower": low, "high": margins[high], "higher": high}
            differ = f"{margins[low]:.3g}" != f"{margins[high]:.3g}"
            sentences.append(Message(_MARGIN_RANGE if differ else _SAME, {**facts, "models": _cases(margins)}))
        if self.standing is not None:
            sentences.append(self.standing.sentences[1])
        slope = side.half_width / side.centre_height
        min_factor = self.sliding.min_factor
        result = Message("a margin of {factor:.3g}", {"factor": min_factor})
        if math.isinf(min_factor):
            result = Message("no computed factor overturns the body")
        if math.isnan(min_factor):
            result = Message("no history has a result")
        if self.standing is not None and not math.isnan(self.standing.sliding_distance):
            result = Message(
                "by {distance} mm at the smallest overturning factor",
                {"distance": millimetres(self.standing.sliding_distance)},
            )
        facts = {"friction": self.friction, "slope": slope, "result": result}
        sentences.append(Message(_SLIDES_FIRST if self.friction < slope else _SLIDES_LATER, facts))
        if self.main_uncertainty:
            sentences.append(Message("Main uncertainty: {input}", {"input": self.main_uncertainty}))
        elif shares := self._shares:
            main = max(shares, key=shares.__getitem__)
            sentences.append(Message(_NO_MAIN_INPUT, {"input": _source(main), "share": min(shares[main], 1.0)}))
        return tuple(sentences)

    @property
    def main_uncertainty(self) -> str:
        """Input with the largest contribution to the variance as text; empty if no single input is the main one."""
        shares = self._shares
        main = max(shares, key=shares.__getitem__, default="")
        inputs = self.prediction.contributions
        others = [item.total_high for name, item in inputs.items() if name != main]
        if not shares or inputs[main].total_low <= max(others, default=0.0):
            return ""
        return Message(_MAIN_INPUT, {"input": _source(main), "share": 100.0 * min(shares[main], 1.0)})

    @property
    def _shares(self) -> dict[str, float]:
        return {name: item.total for name, item in self.prediction.contributions.items() if item.total > 0.0}

    @property
    def measures(self) -> tuple[str, ...]:
        """Sentences on retrofit measures."""
        remedy = self.remedies
        demand: str = self._this
        if remedy.margin != 1.0:
            is_set = len(np.unique(self.records)) > 1
            text = "{factor:g} times these records" if is_set else "{factor:g} times this record"
            demand = Message(text, {"factor": remedy.margin})
        if self.standing is not None:
            direction = _degrees(self.standing.plane_azimuth)
            demand = Message("{motion}, plane body along {direction}", {"motion": demand, "direction": direction})
        if not remedy.needed:
            return (Message("None required: no uplift under {motion}.", {"motion": demand}),)
        forces = {edge: rounded_up(force / 1e3) for edge, force in remedy.tension.items()}
        shear = rounded_up(remedy.shear / 1e3)
        sentences: list[str] = [Message(_ANCHORS[tuple(forces)], {"motion": demand, "shear": shear, **forces})]
        for change, texts in ((remedy.wider, _WIDER), (remedy.lower, _LOWER)):
            no_uplift = millimetres(change.length_no_uplift) if math.isfinite(change.length_no_uplift) else None
            if change.reason:
                sentences.append(Message(texts[0], {"reason": change.reason}))
            elif change.length_no_overturning > 0.0:
                stands = Message(texts[1], {"length": millimetres(change.length_no_overturning)})
                sentences.append(Message.joined([stands, Message("By {length} mm: no uplift.", {"length": no_uplift})]))
            elif no_uplift is not None:
                without = "The unchanged body does not overturn." if self.lowest.factor > remedy.margin else ""
                sentences.append(Message.joined([Message(texts[2], {"length": no_uplift}), without]))
        if remedy.isolation is None:
            sentences.append("Isolators: no period up to 6 s prevents uplift.")
        else:
            period, displacement = remedy.isolation
            sentences.append(Message(_ISOLATORS, {"period": period, "distance": millimetres(displacement)}))
        if self.standing is not None:
            sentences.append("These measures apply to the plane body; the 3D body may overturn over another edge.")
        return tuple(sentences)

    @property
    def headline(self) -> str:
        """Restitution models of margin and probability and the reason for them, as a sentence."""
        return self.prediction.headline_with(self.lowest.model)

    @property
    def model_rows(self) -> list[dict[str, Any]]:
        """Result of each restitution without friction, by quantity; the last row includes sliding."""
        sliding = {} if self.standing else {f"{self.lowest.model}, friction {self.friction:.3g}": self.sliding}
        return [
            {
                "restitution": name, **{f"coefficient_{foot}": r for foot, r in margin.coefficients.items()},
                "overturned": f"{self.count_overturned(margin)} of {self.overturning_fraction.size}",
                "min_factor": margin.min_factor,
            }
            for name, margin in (*self.models.items(), *sliding.items())
        ]  # fmt: skip

    @property
    def code_rows(self) -> list[dict[str, Any]]:
        """Result of each code method, by quantity: motions rated safe, safe motions with overturning, limit factor."""
        rows = []
        for name, factors in self.capacities.items():
            capacity = self.by_record(factors, np.minimum)  # NaN if one direction is outside the domain
            rated = np.isfinite(capacity)
            safe = rated & (capacity * AT_MOST >= 1.0)
            counts: dict[str, Any] = {"safe": self.exclusion(name), "overturned": None, "code_methods": None}
            if rated.any():
                overturned = int((safe & (self.overturning_fraction > 0.0)).sum())
                limit = float(capacity[rated].min())
                counts = {"safe": f"{safe.sum()} of {rated.sum()}", "overturned": overturned, "code_methods": limit}
            rows.append({"method": name, **counts})
        return rows

    @property
    def sentences(self) -> tuple[str, ...]:
        """Outcome, margin, probability, causes and measures."""
        return (self.verdict, self.margin_sentence, self.probability_sentence, *self.governing_factors, *self.measures)

    @property
    def motion_count(self) -> str:
        """Number of motions and of their directions as text."""
        count = len(np.unique(self.records))
        facts = {"count": count, "directions": len(self.motions)}
        if len(self.motions) > count:
            return Message(
                "{count} motion (in {directions} directions)", facts, "{count} motions (in {directions} directions)"
            )
        return Message("{count} motion", facts, "{count} motions")

    @property
    def _this(self) -> str:
        return Message("these records" if len(np.unique(self.records)) > 1 else "this record")

    def __str__(self) -> str:
        return "\n".join(self.sentences)

    __repr__ = __str__

    def answer(self) -> Answer:
        """Return all results.

        Returns
        -------
        Answer
            SI units; infinite without overturning, NaN without a value.
        """
        return Answer({
            "verdict": self.verdict,
            "headline": self.headline,
            "sentences": list(self.sentences),
            "body": repr(self.body if self.standing is None else self.standing.solid),
            "motions": [item.name for item in self.motions],
            "repairs": list(self.prediction.repairs),
            "record_index": self.records,
            "lowest": {
                "min_factor": self.lowest.factor, "model": self.lowest.model, "mirrored": self.lowest.mirrored,
                "motion": self.motions[self.lowest.motion].name,
            },
            "uplift_factors": self.uplift_factors,
            "models": {name: item.answer() for name, item in self.models.items()},
            "refused": dict(self.refused),
            "with_friction": self.sliding.answer() | {"friction": self.friction},
            "code_methods": dict(self.capacities),
            "code_methods_outside": dict(self.outside),
            "motions_with_vertical": self.vertical,
            "remedies": self.remedies.answer(),
            "prediction": self.prediction.answer(),
            **({} if self.standing is None else {"solid": self.standing.answer()}),
            **({"caution": self.body.caution} if self.body.caution else {}),
        })  # fmt: skip
