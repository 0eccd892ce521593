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
from rocking.motions.summary import peak_name, support_of
from rocking.prediction import Prediction
from rocking.studies.code_methods.comparison import AT_MOST
from rocking.studies.remedies import Remedies, millimetres, rounded_up


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
    def words(self) -> tuple[str, str]:
        """Where it is weakest and how firmly it stands, and how it falls, in words."""
        towards, out = _degrees(self.plane), self.way_out
        how = "It is weakest" if self.weakest else "As it stands to the ground's motion it lifts first"
        weak = (
            f"{how} towards {towards}, counter-clockwise from its x axis: the edge of its base there is "
            f"{self.reach:.3g} m from under its centre, which is {self.pose.height:.3g} m high. "
        )
        falls = (
            "" if math.isnan(self.falls_towards) else f"At its margin it falls towards {_degrees(self.falls_towards)}. "
        )
        if out is not None:
            falls += (
                f"Its centre must rise by {1e3 * out.rise:.3g} mm ({out.energy:.3g} J) at least to topple it, towards "
                f"{_degrees(out.azimuth)}. "
            )
        margin = "no factor overturns it" if math.isinf(self.in_plane) else f"its margin is {self.in_plane:.3g}"
        return weak, f"{falls}As a plane body along {towards}, which does not slide: {margin}."

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
        several, models = self.several, f"{len(self.models)} restitution{'s' if len(self.models) > 1 else ''}"
        with_all, with_some = int((self.fallen == 1.0).sum()), int((self.fallen > 0.0).sum())
        if math.isnan(self.lowest.factor):
            return "No history has a result: it cannot be said whether it stands."
        if not with_some:
            stands = "It does not lift" if (self.lifts > 1.0).all() else "It rocks and stands"
            return f"{stands}: it overturns under none of {several}, with none of {models}, either way round."
        if with_all == with_some:
            return f"It overturns under {with_all} of {several}, with all of {models}."
        return (
            f"It may overturn: under {with_some} of {several} with some of {models}, under {with_all} with all of "
            "them: what an impact costs decides."
        )

    @property
    def margin_words(self) -> str:
        """How far it is from overturning, in words."""
        factor, model, motion, mirrored = self.lowest
        if math.isnan(factor):
            return "Margin to overturning: not known."
        if math.isinf(factor):
            return f"No factor on {self._this} that was tried overturns it."
        turned = "mirrored" if self.standing is None else "turned half round"
        name, way = self.motions[motion].name, f", {turned}" if mirrored else ""
        pga = factor * self.motions[motion].peak
        on = "this record" if len(self.motions) == 1 else name
        asked, here = self.remedies.margin, self.models[model].overturned[motion]
        more = "; it stands under the motion as it is, which is no margin" if factor < 1.0 and here == 0.0 else ""
        short = f" The {asked:g} that is asked for is not reached." if asked > max(factor, 1.0) else ""
        peak = peak_name(support_of(self.motions[motion]))
        return (
            f"Margin to overturning: {factor:.3g} times {on} ({model}{way}), a {peak} of {pga / g:.3g} g{more}.{short}"
        )

    @property
    def probability_words(self) -> str:
        """How likely it overturns, of all motions and under the worst, in words."""
        chance = self.prediction.chances["overturning"]
        sentence = f"With uncertain inputs sampled: {self.prediction.verdict}"
        if len(self.prediction.motions) == 1:
            return sentence
        worst = int(np.nanargmax(chance.per_motion))
        largest = percent(round(float(chance.per_motion[worst]), 3))
        name = self.prediction.motions[worst].name
        return f"{sentence} All motions are equally likely; the largest is {largest}, under {name}."

    @property
    def governs(self) -> tuple[str, ...]:
        """What decides the answer, in words."""
        sides = {foot: self.body.side(foot, self.gravity) for foot in FEET}
        weak = min(sides, key=lambda foot: sides[foot].slenderness_angle)
        side, first = sides[weak], int(np.argmin(self.lifts))
        found = [
            f"Its weaker side is the {weak}: the centre is {side.half_width:.3g} m from that foot and "
            f"{side.centre_height:.3g} m above it. "
            if not self.body.is_symmetric
            else f"The centre is {side.half_width:.3g} m from either foot and {side.centre_height:.3g} m above it. ",
        ]
        if self.standing is not None:
            found[0] = self.standing.words[0]
        motion, factor, limit = self.motions[first], self.lifts[first], side.uplift_acceleration / g
        found[0] += (
            f"It lifts from {limit:.3g} g, at {factor:.3g} times {motion.name}."
            if motion.vertical is None
            else f"Without vertical acceleration it lifts from {limit:.3g} g; with that of {motion.name} at "
            f"{factor:.3g} times this motion."
        )
        margins = {name: each.lowest for name, each in self.models.items() if math.isfinite(each.lowest)}
        if len(margins) > 1:
            low, high = min(margins, key=margins.__getitem__), max(margins, key=margins.__getitem__)
            found.append(
                f"What an impact costs moves the margin from {margins[low]:.3g} ({low}) to {margins[high]:.3g} "
                f"({high})."
                if f"{margins[low]:.3g}" != f"{margins[high]:.3g}"
                else f"The margin is {margins[low]:.3g} with each of {len(margins)} restitutions."
            )
        if self.standing is not None:
            found.append(self.standing.words[1])
        slope = side.half_width / side.centre_height
        slid = self.sliding.lowest
        words = "no factor that was tried overturns it" if math.isinf(slid) else f"a margin of {slid:.3g}"
        words = "no history has a result" if math.isnan(slid) else words
        if self.standing is not None and not math.isnan(self.standing.slides):
            words = f"by {millimetres(self.standing.slides)} mm at the least factor"
        slides = "before it lifts" if self.friction < slope else "only while it rocks, if at all"
        found.append(f"With a friction of {self.friction:.3g} (b/h = {slope:.3g}) it slides {slides}: {words}.")
        shares = {name: each for name, each in self.prediction.shares.items() if each.total > 0.0}
        if shares:
            most = max(shares, key=lambda name: shares[name].total)
            word, size = "which motion it is" if most == "case" else most, f"{min(shares[most].total, 1.0):.2f}"
            others = [each.total_high for name, each in self.prediction.shares.items() if name != most]
            found.append(
                f"Of what is not known, {word} decides most ({size} of the variance)."
                if shares[most].total_low > max(others, default=0.0)
                else f"No single uncertain input is distinguishable (95 %) as the main one; the largest total index of "
                f"overturning is that of {word}, {size}."
            )
        return tuple(found)

    @property
    def to_do(self) -> tuple[str, ...]:
        """What would help, in words."""
        remedy = self.remedies
        ask = self._this if remedy.margin == 1.0 else f"{remedy.margin:g} times {self._this}"
        if self.standing is not None:
            ask += f" as a plane body along {_degrees(self.standing.plane)}"
        if not remedy.needed:
            return (f"Nothing: it does not lift under {ask}.",)
        both = " and ".join(
            f"{rounded_up(force / 1e3):.3g} kN along the {edge} edge" for edge, force in remedy.tension.items()
        )
        found = [
            f"Anchors that keep it from lifting under {ask}: {both}; shear "
            f"{rounded_up(remedy.shear / 1e3):.3g} kN in all."
        ]
        for change, what in (
            (remedy.wider, "Base wider by {} on each side"), (remedy.lower, "Centre of mass lower by {}"),
        ):  # fmt: skip
            name = what.partition(" by ")[0]
            still = f"{millimetres(change.lifts_not)} mm" if math.isfinite(change.lifts_not) else ""
            if change.why_not:
                found.append(f"{name}: not found, {change.why_not}.")
            elif change.stands > 0.0:
                length = f"{millimetres(change.stands)} mm"
                found.append(
                    f"{what.format(length)}: no history overturns any more. By {still}: it does not even lift."
                )
            elif still:
                without = " It stands without." if self.lowest.factor > remedy.margin else ""
                found.append(f"{what.format(still)}: it does not lift any more.{without}")
        if remedy.isolation is None:
            found.append("Isolators: no period up to 6 s keeps it from lifting.")
        else:
            period, far = remedy.isolation
            found.append(
                f"Isolators of a period of {period:.3g} s or more keep it from lifting; they move by "
                f"{millimetres(far)} mm at that period."
            )
        if self.standing is not None:
            found.append("All of this is of that plane body: in space it may fall over another edge.")
        return tuple(found)

    @property
    def code_rows(self) -> list[tuple[str, int, int, int, float]]:
        """Method, motions in its domain in all directions, of these safe, of these overturn, least factor it allows."""
        rows = []
        for name, each in self.capacities.items():
            capacity = self.by_record(each, np.minimum)  # NaN where one direction is outside the domain
            known = np.isfinite(capacity)
            safe = known & (capacity * AT_MOST >= 1.0)
            least = float(capacity[known].min()) if known.any() else math.nan
            fell = int((safe & (self.fallen > 0.0)).sum())
            rows.append((name, int(known.sum()), int(safe.sum()), fell, least))
        return rows

    @property
    def sentences(self) -> tuple[str, ...]:
        """Verdict, margin, probability, what governs, and what to do."""
        return (self.verdict, self.margin_words, self.probability_words, *self.governs, *self.to_do)

    @property
    def several(self) -> str:
        """How many motions, and in how many directions, in words."""
        count = len(np.unique(self.records))
        turned = f" (in {len(self.motions)} directions)" if len(self.motions) > count else ""
        return f"{count} motion{'s' if count > 1 else ''}{turned}"

    @property
    def _this(self) -> str:
        return "these records" if len(np.unique(self.records)) > 1 else "this record"

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
