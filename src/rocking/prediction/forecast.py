"""What is foreseen of a body: probabilities with their intervals, which input matters, what cannot be predicted."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from rocking.answers import Answer, AnswerRows
from rocking.conventions import FloatArray, percent
from rocking.exported import Exported
from rocking.messages import Message
from rocking.motions.summary import MotionSummary, condition
from rocking.prediction.likelihood import likelihood, scale_words
from rocking.quantities import with_units
from rocking.statistics.shares import VarianceShare
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    from rocking.bodies import Body, Solid
    from rocking.tables import Table

_LIKELY = {
    "uplift": "Rocking is {likelihood} {condition}: {probability}.",
    "sliding": "Sliding by {distance:g} mm or more is {likelihood} {condition}: {probability}.",
    "overturning": "Overturning is {likelihood} {condition}: {probability}.",
}
_PREDICTABLE = (
    "Each response can be predicted: 0 of {rocking} pairs of histories that differ by one part in a million in scale "
    "end differently or differ by more than 1 % in their peaks."
)
_UNPREDICTABLE = (
    "Under {motions} of {total} motions this response cannot be predicted; its distribution can: {pairs} of {rocking} "
    "pairs of histories that differ by one part in a million in scale end differently or differ by more than 1 % in "
    "their peaks."
)
_BESIDE = "With another restitution model and all else alike, overturning has {probabilities}."
_AT_ENDS = (
    "The probability of overturning is {low} with {input} near {lower:.3g} and {high} with {input} near {higher:.3g}."
)


@dataclass(frozen=True, eq=False)
class Chance:
    """How likely something is, with 95 % intervals [-]."""

    value: float  # over all motions, each as likely
    low: float  # low, high: from the number of bodies drawn, under these motions
    high: float
    between: float  # standard deviation from motion to motion, without what sampling adds; NaN of one motion
    wide_low: float  # wide_low, wide_high: if other motions like these came; NaN of fewer than five motions
    wide_high: float
    per_motion: FloatArray
    per_motion_low: FloatArray
    per_motion_high: FloatArray


@dataclass(frozen=True)
class EndsOfRange:
    """How likely overturning is in the lowest and in the highest fifth of the draws of an input."""

    low: float  # mean of the input there
    probability_low: float
    high: float
    probability_high: float


@dataclass(frozen=True)
class Growth:
    """What becomes of a small difference: pairs of histories whose motions differ by one part in a million."""

    pairs: int  # under each motion
    rocking: int  # how many of all pairs rocked
    lost: int  # how many of these end differently, or differ by more than 1 % in their peaks
    motions_lost: tuple[str, ...]  # motions under which that happened to a pair at least
    motions: int  # how many motions there are
    median: float  # of the relative change of the peak over that of the motion; NaN where nothing rocks on [-]

    @property
    def sentence(self) -> str:
        """Whether responses can be predicted at all, in words."""
        if not self.rocking:
            return "No pair of histories rocks, so no difference between histories grows."
        facts = {
            "motions": len(self.motions_lost), "total": self.motions, "pairs": self.lost, "rocking": self.rocking,
        }  # fmt: skip
        return Message(_UNPREDICTABLE if self.lost else _PREDICTABLE, facts)


@dataclass(frozen=True, eq=False, repr=False)
class Prediction(Exported):
    """What is foreseen of a body of which not everything is known.

    Parameters
    ----------
    body : Block, Section, MassPoints or Solid
        The body as it is drawn.
    motions : tuple of MotionSummary
        Name, intensity, source and processing of each motion: what every probability is conditional on.
    inputs : dict of str to str
        What was drawn from what, in words, by input; also what is known.
    assumptions : dict of str to str
        What nobody said and was assumed, and why, by input; a sentence about no single input has no reason.
    fixed : dict of str to str
        What is one value in all histories, and why, by input.
    sliding_beyond : float
        How far it slides at least where it is said to slide [m].
    chances : dict of str to Chance
        Of uplift, sliding and overturning.
    shares : dict of str to VarianceShare
        Share of each input, and of the motion as `case`, in whether it overturns; empty if they were not asked for.
    ends : dict of str to EndsOfRange
        How the probability of overturning would change at the ends of each input.
    growth : Growth
        What becomes of small differences.
    outcomes : int
        How many outcomes, 1 or 2, all histories have, those of the sensitivity analysis included.
    count, histories, failed : int
        Bodies for each motion behind a probability, histories in all, and those without a result, which do not count.
    seed : int
        Seed of the draws.
    gravity : float
        Acceleration of gravity [m/s2].
    beside : dict of str to Chance
        Of overturning with KED and with Housner's restitution instead of the measured one, all else drawn alike; of
        plane bodies, where no restitution was asked for.
    """

    body: "Body | Solid"
    motions: tuple[MotionSummary, ...]
    inputs: Mapping[str, str]
    assumptions: Mapping[str, str]
    fixed: Mapping[str, str]
    sliding_beyond: float
    chances: Mapping[str, Chance]
    shares: Mapping[str, VarianceShare]
    ends: Mapping[str, EndsOfRange]
    growth: Growth
    outcomes: int
    count: int
    histories: int
    failed: int
    seed: int
    gravity: float
    beside: Mapping[str, Chance] = field(default_factory=dict)

    @property
    def contributions(self) -> AnswerRows:
        """Shares of the uncertain inputs in the variance of overturning, the largest first."""
        ordered = sorted(self.shares.items(), key=lambda pair: -pair[1].total)
        return AnswerRows.of_records(
            {"input": "motion" if name == "case" else name, **vars(share)} for name, share in ordered
        )

    @property
    def assumed(self) -> tuple[str, ...]:
        """What nobody said and was assumed, and why, in a sentence each."""
        return tuple(_reasoned(name, reason) if reason else name for name, reason in self.assumptions.items())

    @property
    def not_sampled(self) -> tuple[str, ...]:
        """What is one value in all histories, and why, in a sentence each."""
        return tuple(_reasoned(name, reason) for name, reason in self.fixed.items())

    @property
    def condition(self) -> str:
        """The motions and their intensity, on which every probability depends, in words."""
        return condition(self.motions)

    @property
    def repairs(self) -> tuple[str, ...]:
        """Repairs of the mesh of the body, in words; none of a plane body."""
        return tuple(getattr(self.body, "repairs", ()))

    @property
    def verdict(self) -> str:
        """Likelihood and probability of overturning, with its condition."""
        return self._sentence("overturning")

    @property
    def decides(self) -> str:
        """Why there are no contributions to the variance; empty where there are."""
        if any(share.total for share in self.shares.values()):
            return ""
        if self.outcomes == 1:
            return "All histories have the same outcome, so that no input contributes to the variance."
        if self.shares:
            return "Too few histories differ in their outcome to compute contributions to the variance."
        return "Contributions to the variance were not computed."

    @property
    def sentences(self) -> tuple[str, ...]:
        """Verdict, the other probabilities, the effect of inputs, and whether a response can be predicted."""
        chance = self.chances["overturning"]
        found = [self.verdict]
        if not math.isnan(chance.wide_low):
            interval = _between(chance.wide_low, chance.wide_high)
            found.append(Message("For other motions like these the interval is {interval}.", {"interval": interval}))
        found += [self._sentence(event) for event in ("uplift", "sliding")]
        if self.beside:
            others = [
                Message("{probability} with {model}", {"probability": _of(each), "model": name})
                for name, each in self.beside.items()
            ]
            first = others[0]
            for other in others[1:]:
                first = Message("{first} and {second}", {"first": first, "second": other})
            found.append(Message(_BESIDE, {"probabilities": first}))
        movers = sorted(self.ends.items(), key=lambda pair: -abs(pair[1].probability_high - pair[1].probability_low))
        for name, each in movers[:2]:
            if each.probability_low != each.probability_high:
                low, high = percent(each.probability_low), percent(each.probability_high)
                facts = {"input": Message(name), "low": low, "high": high, "lower": each.low, "higher": each.high}
                found.append(Message(_AT_ENDS, facts))
        found.append(self.growth.sentence)
        if self.failed:
            text = "{count} of {total} histories have no result and do not count."
            found.append(Message(text, {"count": self.failed, "total": self.histories}))
        return tuple(found)

    def _sentence(self, event: str) -> str:
        chance = self.chances[event]
        same = Message("given the same motion" if len(self.motions) == 1 else "given the same motions")
        facts = {
            "likelihood": likelihood(chance.low, chance.high),
            "condition": self.condition if event == "overturning" else same,
            "distance": 1000.0 * self.sliding_beyond,
            "probability": _of(chance),
        }
        return Message(_LIKELY[event], facts)

    def __str__(self) -> str:
        left = (f"not sampled: {each}" for each in self.not_sampled)
        return "\n".join([*self.sentences, *(f"assumed: {each}" for each in self.assumed), *left, scale_words()])

    __repr__ = __str__

    def answer(self) -> Answer:
        """Return everything that is shown.

        Returns
        -------
        Answer
            NaN where something does not exist.
        """
        plain = ("verdict", "condition", "sliding_beyond", "inputs", "assumed", "not_sampled", "repairs", "decides",
                 "count", "histories", "failed", "seed", "gravity")  # fmt: skip
        return Answer({
            **{name: getattr(self, name) for name in plain},
            "sentences": list(self.sentences),
            "likelihood": {name: likelihood(each.low, each.high) for name, each in self.chances.items()},
            "likelihood_scale": scale_words(),
            "body": repr(self.body),
            "motions": [each.answer() for each in self.motions],
            "software": SOFTWARE,
            "probability": {name: vars(chance) for name, chance in self.chances.items()},
            "beside": {name: vars(chance) for name, chance in self.beside.items()},
            "shares": {_told(name): asdict(share) for name, share in self.shares.items()},
            "ends": {
                name: {
                    "input_low": each.low, "input_high": each.high, "probability_low": each.probability_low,
                    "probability_high": each.probability_high,
                }
                for name, each in self.ends.items()
            },
            "growth": {
                "pairs": self.growth.pairs, "pairs_rocking": self.growth.rocking, "pairs_apart": self.growth.lost,
                "motions_apart": self.growth.motions_lost, "motions": self.growth.motions,
                "relative_change": self.growth.median, "sentence": self.growth.sentence,
            },
        })  # fmt: skip

    def exported(self) -> "Table":
        """Return one row a motion, the inputs beside it."""
        from rocking.tables import Column, Table, text_array

        columns = {
            "motion": Column(text_array([each.name for each in self.motions]), "", "name of the motion"),
            "support": Column(text_array([each.support for each in self.motions]), "", "ground, or the floor"),
            "peak_acceleration": Column(np.array([each.peak for each in self.motions]), "m/s2", "peak acceleration"),
            "peak_velocity": Column(np.array([each.peak_velocity for each in self.motions]), "m/s", "peak velocity"),
            "provenance": Column(
                text_array(["; ".join(each.provenance) for each in self.motions]), "", "source and processing steps"
            ),
        }
        for name, chance in self.chances.items():
            for end, meaning in (("", "probability of {}"), ("_low", "2.5 % of it"), ("_high", "97.5 % of it")):
                values = getattr(chance, f"per_motion{end}")
                columns[f"{name}{end}"] = Column(values, "1", meaning.format(name))
        names = list(dict.fromkeys([*self.inputs, *self.shares]))
        beside = {"name": Column(text_array(list(map(_told, names))), "", "what is not known")}
        nothing = VarianceShare(*[0.0 if self.shares else math.nan] * 6)
        for key, meaning in (("first", "first-order index of overturning"), ("total", "total index of overturning")):
            for end in ("", "_low", "_high"):
                values = [getattr(self.shares.get(name, nothing), f"{key}{end}") for name in names]
                beside[f"{key}{end}"] = Column(np.array(values), "1", meaning)
        provenance = {
            "software": SOFTWARE, "body": repr(self.body), "verdict": self.verdict,
            "assumed": "; ".join(self.assumed), "not_sampled": "; ".join(self.not_sampled),
            "repairs": "; ".join(self.repairs), "likelihood_scale": scale_words(), "seed": self.seed,
            "sliding_beyond": self.sliding_beyond,
            **{f"probability_of_{name}": chance.value for name, chance in self.chances.items()},
        }  # fmt: skip
        return Table("motion", columns, with_units(provenance), {"input": Table("input", beside)})


def _reasoned(name: str, reason: str) -> str:
    return Message("{name}: {reason}", {"name": Message(name), "reason": reason})


def _between(low: float, high: float) -> str:
    return Message("{low} to {high}", {"low": percent(round(low, 3)), "high": percent(round(high, 3))})


def _of(chance: Chance) -> str:
    facts = {"value": percent(round(chance.value, 4)), "interval": _between(chance.low, chance.high)}
    return Message("probability {value} (95 % interval {interval})", facts)


def _told(name: str) -> str:
    return "motion" if name == "case" else name
