"""What is found of a body: with each model whether it stands and by which margin, and what to say of it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from rocking.answers import Answer
from rocking.bodies import Body, Solid
from rocking.bodies.equilibria import Pass, StablePose
from rocking.conventions import FEET, FloatArray, IntArray, g, percent
from rocking.messages import Message
from rocking.motions.summary import peak_name, support_of
from rocking.prediction import Prediction
from rocking.studies.code_methods.comparison import AT_MOST
from rocking.studies.remedies import Remedies, millimetres, rounded_up

_IN_PLANE = "As a plane body along {direction}, which does not slide: its margin is {factor:.3g}."
_IN_PLANE_STANDS = "As a plane body along {direction}, which does not slide: no factor overturns it."
_WAY_OUT = "Its centre must rise by {rise:.3g} mm ({energy:.3g} J) at least to topple it, towards {direction}."
_WEAKEST = (
    "It is weakest towards {direction}, counter-clockwise from its x axis: the edge of its base there is {reach:.3g} m "
    "from under its centre, which is {height:.3g} m high."
)
_LIFTS_FIRST = (
    "As it stands to the ground's motion it lifts first towards {direction}, counter-clockwise from its x axis: the "
    "edge of its base there is {reach:.3g} m from under its centre, which is {height:.3g} m high."
)
_NEVER_LIFTS = "It does not lift: it overturns under none of {motions}, with none of {models}, either way round."
_STANDS = "It rocks and stands: it overturns under none of {motions}, with none of {models}, either way round."
_DEPENDS = (
    "It may overturn: under {with_some} of {motions} with some of {models}, under {with_all} with all of them: what an "
    "impact costs decides."
)
_MARGINS = {  # by whether it is of the only motion, and whether it is one
    (True, True): "Margin to overturning: {factor:.3g} times this record ({model}), a {peak} of {acceleration:.3g} g.",
    (False, True): "Margin to overturning: {factor:.3g} times {motion} ({model}), a {peak} of {acceleration:.3g} g.",
    (True, False): (
        "Margin to overturning: {factor:.3g} times this record ({model}), a {peak} of {acceleration:.3g} g; it stands "
        "under the motion as it is, which is no margin."
    ),
    (False, False): (
        "Margin to overturning: {factor:.3g} times {motion} ({model}), a {peak} of {acceleration:.3g} g; it stands "
        "under the motion as it is, which is no margin."
    ),
}
_SIDES = {
    "left": "Its weaker side is the left: the centre is {reach:.3g} m from that foot and {height:.3g} m above it.",
    "right": "Its weaker side is the right: the centre is {reach:.3g} m from that foot and {height:.3g} m above it.",
    "either": "The centre is {reach:.3g} m from either foot and {height:.3g} m above it.",
}
_LIFTS = "It lifts from {limit:.3g} g, at {factor:.3g} times {motion}."
_LIFTS_WITH_VERTICAL = (
    "Without vertical acceleration it lifts from {limit:.3g} g; with that of {motion} at {factor:.3g} times this "
    "motion."
)
_MOVES = "What an impact costs moves the margin from {low:.3g} ({lower}) to {high:.3g} ({higher})."
_SAME = "The margin is {low:.3g} with each of {models}."
_SLIDES_FIRST = "With a friction of {friction:.3g} (b/h = {slope:.3g}) it slides before it lifts: {result}."
_SLIDES_LATER = (
    "With a friction of {friction:.3g} (b/h = {slope:.3g}) it slides only while it rocks, if at all: {result}."
)
_DECIDES = "Of what is not known, {input} decides most ({share:.2f} of the variance)."
_UNDECIDED = (
    "No single uncertain input is distinguishable (95 %) as the main one; the largest total index of overturning is "
    "that of {input}, {share:.2f}."
)
_ANCHORS = {
    ("left", "right"): (
        "Anchors that keep it from lifting under {motion}: {left:.3g} kN along the left edge and {right:.3g} kN along "
        "the right edge; shear {shear:.3g} kN in all."
    ),
    ("left",): (
        "Anchors that keep it from lifting under {motion}: {left:.3g} kN along the left edge; shear {shear:.3g} kN in "
        "all."
    ),
    ("right",): (
        "Anchors that keep it from lifting under {motion}: {right:.3g} kN along the right edge; shear {shear:.3g} kN "
        "in all."
    ),
}
_WIDER = (
    "Base wider: not found, {reason}.",
    "Base wider by {length} mm on each side: no history overturns any more.",
    "Base wider by {length} mm on each side: it does not lift any more.",
)
_LOWER = (
    "Centre of mass lower: not found, {reason}.",
    "Centre of mass lower by {length} mm: no history overturns any more.",
    "Centre of mass lower by {length} mm: it does not lift any more.",
)
_ISOLATORS = (
    "Isolators of a period of {period:.3g} s or more keep it from lifting; they move by {distance} mm at that period."
)


def _restitutions(count: int) -> Message:
    return Message("{count} restitution", {"count": count}, "{count} restitutions")


def just_above(factor: float) -> float:
    """Return a factor above one that was found between two that are a thousandth apart, or is that of the motion."""
    return factor if factor == 1.0 else 1.001 * factor


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle) % 360.0:.0f} deg"


@dataclass(frozen=True, eq=False)
class ModelMargin:
    """What becomes of a body with one restitution.

    Parameters
    ----------
    coefficients : dict of str to float
        Landing on the left and on the right foot [-].
    overturned : ndarray, shape (motions,)
        1 where it overturns under a motion as it is, of either way round; NaN without a result.
    least : ndarray, shape (ways round, motions)
        Least factor on each motion that overturns it, as it stands and mirrored; infinite if none did [-].
    """

    coefficients: Mapping[str, float]
    overturned: FloatArray
    least: FloatArray

    def answer(self) -> Answer:
        """Return what is shown of the restitution.

        Returns
        -------
        Answer
            Coefficients, outcomes and smallest scale factors.
        """
        return Answer({
            "coefficient": self.coefficients, "overturned": self.overturned, "factors": self.least,
            "min_factor": self.lowest,
        })  # fmt: skip

    @property
    def lowest(self) -> float:
        """Least factor of all motions [-]."""
        known = self.least[~np.isnan(self.least)]
        return float(known.min()) if known.size else math.nan

    @property
    def place(self) -> tuple[int, int]:
        """Way round and motion of the least factor."""
        way, motion = np.unravel_index(int(np.argmin(np.nan_to_num(self.least, nan=np.inf))), self.least.shape)
        return int(way), int(motion)


@dataclass(frozen=True, eq=False)
class StandingSolid:
    """A solid as it stands, the plane body beside it, and how it falls at the least factor that overturns it."""

    solid: Solid
    pose: StablePose
    # direction of the plane body, outwards over the edge over which the solid lifts first, from its x axis [rad]
    plane: float
    reach: float  # how far that edge is from under the centre [m]
    weakest: bool  # whether that is its nearest edge; one that the ground moves it towards otherwise
    way_out: Pass | None  # the lowest pass into another pose
    in_plane: float = math.nan  # least factor that overturns the plane body, which does not slide [-]
    falls_towards: float = math.nan  # in which direction it leans when it falls, from its x axis [rad]
    slides: float = math.nan  # how far its points slide in that history [m]
    restitution: Any = None  # what an impact costs in it, as `simulate` takes it
    turned: float = 0.0  # azimuth of the solid's x axis in it [rad]

    @property
    def words(self) -> tuple[Message, str]:
        """Where it is weakest and how firmly it stands, and how it falls, in words."""
        towards, out = _degrees(self.plane), self.way_out
        facts = {"direction": towards, "reach": self.reach, "height": self.pose.height}
        falls = [
            Message(_IN_PLANE_STANDS if math.isinf(self.in_plane) else _IN_PLANE, {**facts, "factor": self.in_plane})
        ]
        if out is not None:
            rise = {"rise": 1e3 * out.rise, "energy": out.energy, "direction": _degrees(out.azimuth)}
            falls.insert(0, Message(_WAY_OUT, rise))
        if not math.isnan(self.falls_towards):
            falls.insert(
                0, Message("At its margin it falls towards {direction}.", {"direction": _degrees(self.falls_towards)})
            )
        return Message(_WEAKEST if self.weakest else _LIFTS_FIRST, facts), Message.joined(falls)

    def answer(self) -> Answer:
        """Return what is shown of the body in space."""
        out, pose = self.way_out, self.pose
        return Answer({
            "plane_azimuth": self.plane, "plane_is_weakest": self.weakest, "centre_height": pose.height,
            "nearest_edge": self.reach, "barrier": pose.barrier,
            "barrier_energy": math.nan if out is None else out.energy,
            "barrier_azimuth": math.nan if out is None else out.azimuth,
            "min_factor_in_plane": self.in_plane, "direction": self.falls_towards, "sliding_distance": self.slides,
        })  # fmt: skip


class Lowest(NamedTuple):
    """The least factor of all, and whose it is."""

    factor: float
    model: str
    motion: int
    mirrored: bool


@dataclass(frozen=True, eq=False, repr=False)
class BodyAssessment:
    """Whether a body stands, how far it is from overturning, what decides that and what to do about it.

    Parameters
    ----------
    body : Body
        The body; of a solid the plane body beside it.
    motions : tuple of GroundMotion, or of Components
        The motions in its plane; of two components, and of a solid, every direction that was tried.
    records : ndarray, shape (motions,)
        Of which motion that was given each is a direction, by number.
    models : dict of str to ModelMargin
        By the name of the restitution, without sliding; of a solid with the friction.
    refused : dict of str to str
        Models that say nothing of the body, and why.
    friction : float
        Coefficient of friction of `sliding` [-].
    sliding : ModelMargin
        With the model of the least margin, where it may also slide, hop and fly, as solids always may.
    lifts : ndarray, shape (motions,)
        Factor on each motion from which on it lifts [-].
    capacities : dict of str to ndarray
        Factor on each motion up to which a code method calls it safe; NaN outside the method's domain [-].
    prediction : Prediction
        How likely it overturns, with what is not known drawn.
    remedies : Remedies
        What would help.
    gravity : float
        Acceleration of gravity [m/s2].
    standing : StandingSolid, optional
        The solid that it is about; none of a plane body.
    outside : dict of str to str
        By code method, what excludes the body or motions from its domain; empty where nothing does.
    vertical : int
        Number of motions with a vertical part.
    """

    body: Body
    motions: tuple[Any, ...]
    records: IntArray
    models: Mapping[str, ModelMargin]
    refused: Mapping[str, str]
    friction: float
    sliding: ModelMargin
    lifts: FloatArray
    capacities: Mapping[str, FloatArray]
    prediction: Prediction
    remedies: Remedies
    gravity: float = g
    standing: StandingSolid | None = None
    outside: Mapping[str, str] = field(default_factory=dict)
    vertical: int = 0

    def outside_words(self, method: str) -> str:
        """Return that a code method does not apply, and the reason.

        Parameters
        ----------
        method : str
            Name of the method.

        Returns
        -------
        str
            Text for a row of a table or a picture.
        """
        reason = self.outside.get(method)
        return f"outside its domain: {reason}" if reason else "outside its domain"

    @cached_property
    def lowest(self) -> Lowest:
        """The least factor on any motion that overturns it without sliding, with any model."""
        name = min(self.models, key=lambda each: (math.isnan(self.models[each].lowest), self.models[each].lowest))
        way, motion = self.models[name].place
        return Lowest(self.models[name].lowest, name, motion, bool(way))

    def by_record(self, values: FloatArray, worst: np.ufunc = np.fmax) -> FloatArray:
        """Return what is worst in any direction of each motion that was given.

        Parameters
        ----------
        values : ndarray, shape (motions,)
            What is known of each direction; NaN where nothing is.
        worst : ufunc
            What takes the worse one of two.

        Returns
        -------
        ndarray
            One value a motion that was given.
        """
        return np.array([worst.reduce(values[self.records == k]) for k in np.unique(self.records)])

    def falls(self, margin: ModelMargin) -> int:
        """Return under how many of the motions that were given it overturns, in any direction.

        Parameters
        ----------
        margin : ModelMargin
            With one restitution.

        Returns
        -------
        int
            Their number.
        """
        return int(np.nansum(self.by_record(margin.overturned)))

    @property
    def fallen(self) -> FloatArray:
        """Share of the models with which it overturns under each motion that was given, in any direction [-]."""
        rows = np.array([self.by_record(each.overturned) for each in self.models.values()])
        known = (~np.isnan(rows)).sum(axis=0)
        return np.where(known > 0, np.nansum(rows, axis=0) / np.maximum(known, 1), np.nan)

    @property
    def verdict(self) -> str:
        """Whether it stands, in words."""
        with_all, with_some = int((self.fallen == 1.0).sum()), int((self.fallen > 0.0).sum())
        facts = {
            "motions": self.several, "models": _restitutions(len(self.models)),
            "with_all": with_all, "with_some": with_some,
        }  # fmt: skip
        if math.isnan(self.lowest.factor):
            return "No history has a result: it cannot be said whether it stands."
        if not with_some:
            return Message(_NEVER_LIFTS if (self.lifts > 1.0).all() else _STANDS, facts)
        if with_all == with_some:
            return Message(
                "It overturns under {count} of {motions}, with all of {models}.", {"count": with_all, **facts}
            )
        return Message(_DEPENDS, {"with_some": with_some, "with_all": with_all, **facts})

    @property
    def margin_words(self) -> str:
        """How far it is from overturning, in words."""
        factor, model, motion, mirrored = self.lowest
        if math.isnan(factor):
            return "Margin to overturning: not known."
        if math.isinf(factor):
            return Message("No factor on {records} that was tried overturns it.", {"records": self._this})
        turned = "{model}, mirrored" if self.standing is None else "{model}, turned half round"
        facts = {
            "factor": factor,
            "motion": self.motions[motion].name,
            "model": Message(turned, {"model": model}) if mirrored else model,
            "peak": peak_name(support_of(self.motions[motion])),
            "acceleration": factor * self.motions[motion].peak / g,
        }
        required, here = self.remedies.margin, self.models[model].overturned[motion]
        is_margin = factor >= 1.0 or here != 0.0
        sentences = [Message(_MARGINS[len(self.motions) == 1, is_margin], facts)]
        if required > max(factor, 1.0):
            sentences.append(Message("The {margin:g} that is asked for is not reached.", {"margin": required}))
        return Message.joined(sentences)

    @property
    def probability_words(self) -> str:
        """How likely it overturns, of all motions and under the worst, in words."""
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
                "All motions are equally likely; the largest is {probability}, under {motion}.",
                {"probability": largest, "motion": name},
            ),
        ])  # fmt: skip

    @property
    def governs(self) -> tuple[str, ...]:
        """What decides the answer, in words."""
        sides = {foot: self.body.side(foot, self.gravity) for foot in FEET}
        weak = min(sides, key=lambda foot: sides[foot].slenderness_angle)
        side, first = sides[weak], int(np.argmin(self.lifts))
        text = _SIDES["either" if self.body.is_symmetric else weak]
        where = Message(text, {"reach": side.half_width, "height": side.centre_height})
        if self.standing is not None:
            where = self.standing.words[0]
        motion = self.motions[first]
        facts = {"limit": side.uplift_acceleration / g, "factor": self.lifts[first], "motion": motion.name}
        lifts = Message(_LIFTS if motion.vertical is None else _LIFTS_WITH_VERTICAL, facts)
        found = [Message.joined([where, lifts])]
        margins = {name: each.lowest for name, each in self.models.items() if math.isfinite(each.lowest)}
        if len(margins) > 1:
            low, high = min(margins, key=margins.__getitem__), max(margins, key=margins.__getitem__)
            facts = {"low": margins[low], "lower": low, "high": margins[high], "higher": high}
            differ = f"{margins[low]:.3g}" != f"{margins[high]:.3g}"
            found.append(Message(_MOVES if differ else _SAME, {**facts, "models": _restitutions(len(margins))}))
        if self.standing is not None:
            found.append(self.standing.words[1])
        slope = side.half_width / side.centre_height
        slid = self.sliding.lowest
        result = Message("a margin of {factor:.3g}", {"factor": slid})
        if math.isinf(slid):
            result = Message("no factor that was tried overturns it")
        if math.isnan(slid):
            result = Message("no history has a result")
        if self.standing is not None and not math.isnan(self.standing.slides):
            result = Message("by {distance} mm at the least factor", {"distance": millimetres(self.standing.slides)})
        facts = {"friction": self.friction, "slope": slope, "result": result}
        found.append(Message(_SLIDES_FIRST if self.friction < slope else _SLIDES_LATER, facts))
        shares = {name: each for name, each in self.prediction.shares.items() if each.total > 0.0}
        if shares:
            most = max(shares, key=lambda name: shares[name].total)
            others = [each.total_high for name, each in self.prediction.shares.items() if name != most]
            text = _DECIDES if shares[most].total_low > max(others, default=0.0) else _UNDECIDED
            source = Message("which motion it is" if most == "case" else most)
            found.append(Message(text, {"input": source, "share": min(shares[most].total, 1.0)}))
        return tuple(found)

    @property
    def to_do(self) -> tuple[str, ...]:
        """What would help, in words."""
        remedy = self.remedies
        ask: str = self._this
        if remedy.margin != 1.0:
            several = len(np.unique(self.records)) > 1
            text = "{factor:g} times these records" if several else "{factor:g} times this record"
            ask = Message(text, {"factor": remedy.margin})
        if self.standing is not None:
            direction = _degrees(self.standing.plane)
            ask = Message("{motion} as a plane body along {direction}", {"motion": ask, "direction": direction})
        if not remedy.needed:
            return (Message("Nothing: it does not lift under {motion}.", {"motion": ask}),)
        forces = {edge: rounded_up(force / 1e3) for edge, force in remedy.tension.items()}
        shear = rounded_up(remedy.shear / 1e3)
        found: list[str] = [Message(_ANCHORS[tuple(forces)], {"motion": ask, "shear": shear, **forces})]
        for change, texts in ((remedy.wider, _WIDER), (remedy.lower, _LOWER)):
            even = millimetres(change.lifts_not) if math.isfinite(change.lifts_not) else None
            if change.why_not:
                found.append(Message(texts[0], {"reason": change.why_not}))
            elif change.stands > 0.0:
                stands = Message(texts[1], {"length": millimetres(change.stands)})
                found.append(
                    Message.joined([stands, Message("By {length} mm: it does not even lift.", {"length": even})])
                )
            elif even is not None:
                without = "It stands without." if self.lowest.factor > remedy.margin else ""
                found.append(Message.joined([Message(texts[2], {"length": even}), without]))
        if remedy.isolation is None:
            found.append("Isolators: no period up to 6 s keeps it from lifting.")
        else:
            period, far = remedy.isolation
            found.append(Message(_ISOLATORS, {"period": period, "distance": millimetres(far)}))
        if self.standing is not None:
            found.append("All of this is of that plane body: in space it may fall over another edge.")
        return tuple(found)

    @property
    def model_rows(self) -> list[dict[str, Any]]:
        """Result of each restitution, by quantity; without friction, last that of the history that may slide."""
        sliding = {} if self.standing else {f"{self.lowest.model}, friction {self.friction:.3g}": self.sliding}
        return [
            {
                "restitution": name, **{f"coefficient_{foot}": r for foot, r in each.coefficients.items()},
                "overturned": f"{self.falls(each)} of {self.fallen.size}", "min_factor": each.lowest,
            }
            for name, each in (*self.models.items(), *sliding.items())
        ]  # fmt: skip

    @property
    def code_rows(self) -> list[dict[str, Any]]:
        """Result of each code method, by quantity: motions called safe, of these overturned, scale factor allowed."""
        rows = []
        for name, each in self.capacities.items():
            capacity = self.by_record(each, np.minimum)  # NaN where one direction is outside the domain
            known = np.isfinite(capacity)
            safe = known & (capacity * AT_MOST >= 1.0)
            counts: dict[str, Any] = {"safe": self.outside_words(name), "overturned": None, "code_methods": None}
            if known.any():
                fell = int((safe & (self.fallen > 0.0)).sum())
                least = float(capacity[known].min())
                counts = {"safe": f"{safe.sum()} of {known.sum()}", "overturned": fell, "code_methods": least}
            rows.append({"method": name, **counts})
        return rows

    @property
    def sentences(self) -> tuple[str, ...]:
        """Verdict, margin, probability, what governs, and what to do."""
        return (self.verdict, self.margin_words, self.probability_words, *self.governs, *self.to_do)

    @property
    def several(self) -> str:
        """How many motions, and in how many directions, in words."""
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
        """Return everything that is shown.

        Returns
        -------
        Answer
            SI units; infinite where nothing overturns, NaN where something does not exist.
        """
        return Answer({
            "verdict": self.verdict,
            "sentences": list(self.sentences),
            "body": repr(self.body if self.standing is None else self.standing.solid),
            "motions": [each.name for each in self.motions],
            "repairs": list(self.prediction.repairs),
            "record_index": self.records,
            "lowest": {
                "min_factor": self.lowest.factor, "model": self.lowest.model, "mirrored": self.lowest.mirrored,
                "motion": self.motions[self.lowest.motion].name,
            },
            "uplift_factors": self.lifts,
            "models": {name: each.answer() for name, each in self.models.items()},
            "refused": dict(self.refused),
            "with_friction": self.sliding.answer() | {"friction": self.friction},
            "code_methods": dict(self.capacities),
            "code_methods_outside": dict(self.outside),
            "motions_with_vertical": self.vertical,
            "remedies": self.remedies.answer(),
            "prediction": self.prediction.answer(),
            **({} if self.standing is None else {"solid": self.standing.answer()}),
        })  # fmt: skip
