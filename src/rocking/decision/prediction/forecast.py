"""Result of a prediction: probabilities with intervals, contributions of inputs, limits of predictability."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from rocking.answers import Answer, AnswerRows
from rocking.bodies import Body
from rocking.conventions import DEFAULT_RESTITUTION, FloatArray, percent
from rocking.decision.prediction.likelihood import likelihood, scale_words
from rocking.decision.prediction.model_error import MODEL_ERROR, evidence
from rocking.exported import Exported
from rocking.messages import Message, listed
from rocking.motions.summary import MotionSummary, condition
from rocking.quantities import with_units
from rocking.restitution.headline import headline
from rocking.statistics.shares import VarianceShare
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    from rocking.bodies import Solid
    from rocking.tables import Table

_LIKELY = {
    "uplift": "Rocking is {likelihood} {condition}: {probability}.",
    "sliding": "Sliding by {distance:g} mm or more is {likelihood} {condition}: {probability}.",
    "overturning": "Overturning is {likelihood} {condition}, for the sampled inputs: {probability}.",
}
_ALIKE = (
    "Of {rocking} pairs of histories with a difference of one part in a million in scale, 0 have different outcomes."
)
_APART = (
    "Under {motions} of {total} motions the outcome of a single history cannot be predicted, but its probability can. "
    "Of {rocking} pairs of histories with a difference of one part in a million in scale, {pairs} have different "
    "outcomes."
)
_COMPARED = "With the same {count} of the {total} samples, overturning has {probabilities}."
_AT_ENDS = (
    "The probability of overturning is {low} with {input} near {lower:.3g} and {high} with {input} near {higher:.3g}."
)


_DIRECTIONS = (
    "The azimuth was sampled, because no azimuth was given: between the quarters of the directions the probability of "
    "overturning ranges from {low} to {high}. State the azimuth if the direction of the body is known."
)
_MODEL_ERROR = "The samples contain the error of the model: {factors}."
_AT_ENDS_OF_ERROR = (
    "The probability of overturning is {low} with {lower:.3g} times the computed uplift acceleration and {high} with "
    "{higher:.3g} times."
)
_NOT_INCLUDED = (
    "The probability does not include how often such motions occur, damage to the body, and impacts of other objects."
)
_ONE_VALUE = "Inputs with one stated value, without uncertainty: {inputs}."


@dataclass(frozen=True, eq=False)
class Chance:
    """Probability of an event with 95 % intervals [-]."""

    value: float  # mean of all motions
    low: float  # low, high: interval that follows from the number of sampled bodies, under these motions
    high: float
    between: float  # standard deviation between motions, without sampling error; NaN for one motion
    wide_low: float  # wide_low, wide_high: interval for other motions of the same kind; NaN for fewer than five motions
    wide_high: float
    per_motion: FloatArray
    per_motion_low: FloatArray
    per_motion_high: FloatArray


@dataclass(frozen=True)
class EndsOfRange:
    """Probability of overturning in the lowest and in the highest fifth of the samples of an input."""

    low: float  # mean of the input in the lowest fifth
    probability_low: float
    high: float
    probability_high: float


@dataclass(frozen=True)
class OutcomePairs:
    """Pairs of histories whose motions differ by one part in a million."""

    pairs: int  # number of pairs under each motion
    rocking: int  # number of pairs with rocking under all motions
    apart: int  # number of these pairs with different outcomes
    motions_apart: tuple[str, ...]  # motions with pairs of different outcomes
    motions: int  # number of motions

    @property
    def sentence(self) -> str:
        """Predictability of outcomes as a sentence."""
        if not self.rocking:
            return "No pair of histories rocks."
        facts = {
            "motions": len(self.motions_apart), "total": self.motions, "pairs": self.apart, "rocking": self.rocking,
        }  # fmt: skip
        return Message(_APART if self.apart else _ALIKE, facts)


@dataclass(frozen=True, eq=False, repr=False)
class Prediction(Exported):
    """Probabilities of rocking, sliding and overturning of a body with uncertain inputs.

    Parameters
    ----------
    body : Block, Section, MassPoints or Solid
        Nominal body.
    motions : tuple of MotionSummary
        Name, intensity, source and processing of each motion; all probabilities are conditional on these motions.
    inputs : dict of str to str
        Distribution or value of each input as text.
    assumptions : dict of str to str
        Reason of each default, by input. A sentence that does not belong to an input has an empty reason.
    fixed : dict of str to str
        Value and reason of each input with one value in all histories.
    sliding_beyond : float
        Sliding distance that counts as sliding [m].
    chances : dict of str to Chance
        Probabilities of uplift, sliding and overturning.
    contributions : dict of str to VarianceShare
        Contribution of each input, and of the motion as `case`, to the variance of overturning; empty if not computed.
    ends : dict of str to EndsOfRange
        Probability of overturning at the ends of each input.
    outcome_pairs : OutcomePairs
        Outcomes that change with a small difference of the motion.
    outcomes : int
        Number of different outcomes (1 or 2) of all histories, with those of the sensitivity analysis.
    count, histories, failed : int
        Bodies per motion, total number of histories, and number of histories without a result (not counted).
    seed : int
        Random seed.
    gravity : float
        Acceleration of gravity [m/s2].
    beside : dict of str to Chance
        Probability of overturning with the default, with KED and with Housner's model, for the same quarter of the
        samples; with the default restitution only.
    directions : tuple of float
        Probability of overturning in each quarter of the azimuths, if the azimuth was sampled by default [-].
    """

    body: "Body | Solid"
    motions: tuple[MotionSummary, ...]
    inputs: Mapping[str, str]
    assumptions: Mapping[str, str]
    fixed: Mapping[str, str]
    sliding_beyond: float
    chances: Mapping[str, Chance]
    contributions: Mapping[str, VarianceShare]
    ends: Mapping[str, EndsOfRange]
    outcome_pairs: OutcomePairs
    outcomes: int
    count: int
    histories: int
    failed: int
    seed: int
    gravity: float
    beside: Mapping[str, Chance] = field(default_factory=dict)
    directions: tuple[float, ...] = ()

    @property
    def ranked_contributions(self) -> AnswerRows:
        """Contributions of the uncertain inputs to the variance of overturning, largest first."""
        ordered = sorted(self.contributions.items(), key=lambda pair: -pair[1].total)
        return AnswerRows.of_records({"input": input_label(name), **vars(share)} for name, share in ordered)

    @property
    def assumed(self) -> tuple[str, ...]:
        """Assumptions with their reasons, one sentence per assumption."""
        return tuple(_reasoned(name, reason) if reason else name for name, reason in self.assumptions.items())

    @property
    def assumed_values(self) -> tuple[str, ...]:
        """Assumed inputs with their values, without the reasons."""
        return tuple(
            Message("{name}: {value}", {"name": input_label(name), "value": self.inputs[name]}) if reason else name
            for name, reason in self.assumptions.items()
        )

    @property
    def not_sampled(self) -> tuple[str, ...]:
        """Inputs with one value in all histories and their reasons, one sentence per input."""
        return tuple(_reasoned(name, reason) for name, reason in self.fixed.items())

    @property
    def condition(self) -> Message:
        """Condition of all probabilities as text: the motions and their intensity."""
        return condition(self.motions)

    @property
    def repairs(self) -> tuple[str, ...]:
        """Repairs of the mesh of the body as text; none for a plane body."""
        return tuple(getattr(self.body, "repairs", ()))

    @property
    def verdict(self) -> str:
        """Likelihood and probability of overturning, with its condition."""
        return self._sentence("overturning")

    @property
    def evidence(self) -> str:
        """Observed fraction of overturning in tests of real bodies with a similar predicted probability."""
        return evidence(self.chances["overturning"].value)

    @property
    def headline(self) -> str:
        """Restitution model of the probabilities and the reason for it, as a sentence."""
        return self.headline_with()

    def headline_with(self, case: str = "") -> str:
        """Return the sentence with the restitution model of the probabilities.

        Parameters
        ----------
        case : str
            Restitution of a margin, for the sentence of an assessment.

        Returns
        -------
        str
            Model and reason.
        """
        is_default = "restitution" in self.assumptions
        label = DEFAULT_RESTITUTION if is_default else self.inputs["restitution"]
        return headline(label, in_space=not isinstance(self.body, Body), is_stated=not is_default, case=case)

    @property
    def decides(self) -> str:
        """Reason for missing contributions to the variance; empty if there are contributions."""
        if any(share.total for share in self.contributions.values()):
            return ""
        if self.outcomes == 1:
            return "All histories have the same outcome; no input contributes to the variance."
        if self.contributions:
            return "Too few histories differ in their outcome to compute contributions to the variance."
        return "Contributions to the variance were not computed."

    @property
    def sentences(self) -> tuple[str, ...]:
        """Verdict, other probabilities, effects of inputs, and predictability."""
        chance = self.chances["overturning"]
        sentences = [self.verdict, *filter(None, [getattr(self.body, "caution", "")])]
        if not math.isnan(chance.wide_low):
            interval = _between(chance.wide_low, chance.wide_high)
            sentences.append(
                Message("For other motions like these the interval is {interval}.", {"interval": interval})
            )
        sentences.append(self.evidence)
        if self.directions:
            range_of_quarters = {"low": percent(min(self.directions)), "high": percent(max(self.directions))}
            sentences.append(Message(_DIRECTIONS, range_of_quarters))
        sentences.append(Message(_NOT_INCLUDED))
        if stated := [input_label(name) for name in self.fixed if name in self.inputs]:
            listed, *others = stated
            for other in others:
                listed = Message("{first}, {second}", {"first": listed, "second": other})
            sentences.append(Message(_ONE_VALUE, {"inputs": listed}))
        if MODEL_ERROR in self.inputs and MODEL_ERROR not in self.fixed:
            sentences.append(Message(_MODEL_ERROR, {"factors": self.inputs[MODEL_ERROR]}))
        sentences += [self._sentence(event) for event in ("uplift", "sliding")]
        if self.beside:
            others = [
                Message("{probability} with {model}", {"probability": _of(item), "model": name})
                for name, item in self.beside.items()
            ]
            first = others[0]
            for other in others[1:-1]:
                first = Message("{first}, {second}", {"first": first, "second": other})
            first = Message("{first} and {second}", {"first": first, "second": others[-1]})
            facts = {"count": self.count // 4, "total": self.count, "probabilities": first}
            sentences.append(Message(_COMPARED, facts))
        sentences.append(self.headline)
        ranked = sorted(self.ends.items(), key=lambda pair: -abs(pair[1].probability_high - pair[1].probability_low))
        for name, item in ranked[:2]:
            if item.probability_low != item.probability_high:
                low, high = percent(item.probability_low), percent(item.probability_high)
                facts = {"input": input_label(name), "low": low, "high": high, "lower": item.low, "higher": item.high}
                sentences.append(Message(_AT_ENDS_OF_ERROR if name == MODEL_ERROR else _AT_ENDS, facts))
        sentences.append(self.outcome_pairs.sentence)
        if self.failed:
            text = "{count} of {total} histories have no result and do not count."
            sentences.append(Message(text, {"count": self.failed, "total": self.histories}))
        return tuple(sentences)

    def _sentence(self, event: str) -> str:
        chance = self.chances[event]
        same_motions = Message("given the same motion" if len(self.motions) == 1 else "given the same motions")
        facts = {
            "likelihood": likelihood(chance.low, chance.high),
            "condition": self.condition if event == "overturning" else same_motions,
            "distance": 1000.0 * self.sliding_beyond,
            "probability": _of(chance),
        }
        return Message(_LIKELY[event], facts)

    def __str__(self) -> str:
        not_sampled = (f"not sampled: {text}" for text in self.not_sampled)
        return "\n".join([*self.sentences, *(f"assumed: {text}" for text in self.assumed), *not_sampled, scale_words()])

    __repr__ = __str__

    def answer(self) -> Answer:
        """Return all results.

        Returns
        -------
        Answer
            Values by name; NaN without a value.
        """
        pairs = self.outcome_pairs
        plain = ("verdict", "evidence", "headline", "condition", "sliding_beyond", "inputs", "assumed", "not_sampled",
                 "repairs", "decides", "count", "histories", "failed", "seed", "gravity")  # fmt: skip
        return Answer({
            **{name: getattr(self, name) for name in plain},
            "sentences": list(self.sentences),
            "likelihood": {name: likelihood(item.low, item.high) for name, item in self.chances.items()},
            "likelihood_scale": scale_words(),
            "body": repr(self.body),
            "motions": [item.answer() for item in self.motions],
            "software": SOFTWARE,
            "probability": {name: vars(chance) for name, chance in self.chances.items()},
            "beside": {name: vars(chance) for name, chance in self.beside.items()},
            "contributions": {_input_name(name): asdict(share) for name, share in self.contributions.items()},
            "ends": {
                name: {
                    "input_low": item.low, "input_high": item.high, "probability_low": item.probability_low,
                    "probability_high": item.probability_high,
                }
                for name, item in self.ends.items()
            },
            "outcome_pairs": {
                "pairs": pairs.pairs, "pairs_rocking": pairs.rocking, "pairs_apart": pairs.apart,
                "motions_apart": pairs.motions_apart, "motions": pairs.motions, "sentence": pairs.sentence,
            },
        })  # fmt: skip

    def exported(self) -> "Table":
        """Return a table with one row per motion, and a table of the inputs."""
        from rocking.tables import Column, Table, text_array

        columns = {
            "motion": Column(text_array([motion.name for motion in self.motions]), "", "name of the motion"),
            "support": Column(text_array([motion.support for motion in self.motions]), "", "ground, or the floor"),
            "peak_acceleration": Column(
                np.array([motion.peak for motion in self.motions]), "m/s2", "peak acceleration"
            ),
            "peak_velocity": Column(
                np.array([motion.peak_velocity for motion in self.motions]), "m/s", "peak velocity"
            ),
            "provenance": Column(
                text_array([listed(motion.provenance) for motion in self.motions]), "", "source and processing steps"
            ),
        }
        for name, chance in self.chances.items():
            for end, meaning in (("", "probability of {}"), ("_low", "2.5 % of it"), ("_high", "97.5 % of it")):
                values = getattr(chance, f"per_motion{end}")
                columns[f"{name}{end}"] = Column(values, "1", meaning.format(name))
        names = list(dict.fromkeys([*self.inputs, *self.contributions]))
        beside = {"name": Column(text_array(list(map(_input_name, names))), "", "uncertain input")}
        nothing = VarianceShare(*[0.0 if self.contributions else math.nan] * 6)
        for key, meaning in (("first", "first-order index of overturning"), ("total", "total index of overturning")):
            for end in ("", "_low", "_high"):
                values = [getattr(self.contributions.get(name, nothing), f"{key}{end}") for name in names]
                beside[f"{key}{end}"] = Column(np.array(values), "1", meaning)
        provenance = {
            "software": SOFTWARE, "body": repr(self.body), "verdict": self.verdict,
            "assumed": listed(self.assumed), "not_sampled": listed(self.not_sampled),
            "repairs": listed(self.repairs), "likelihood_scale": scale_words(), "seed": self.seed,
            "sliding_beyond": self.sliding_beyond,
            **{f"probability_of_{name}": chance.value for name, chance in self.chances.items()},
        }  # fmt: skip
        return Table("motion", columns, with_units(provenance), {"input": Table("input", beside)})


def _reasoned(name: str, reason: str) -> str:
    return Message("{name}: {reason}", {"name": input_label(name), "reason": reason})


def input_label(name: str) -> str:
    """Return the name of an input as text; a sentence without an input is returned unchanged."""
    return Message({MODEL_ERROR: "model error", "case": "motion"}.get(name, name))


def _between(low: float, high: float) -> str:
    return Message("{low} to {high}", {"low": percent(round(low, 3)), "high": percent(round(high, 3))})


def _of(chance: Chance) -> str:
    facts = {"value": percent(round(chance.value, 4)), "interval": _between(chance.low, chance.high)}
    return Message("probability {value} (95 % interval {interval})", facts)


def _input_name(name: str) -> str:
    return "motion" if name == "case" else name
