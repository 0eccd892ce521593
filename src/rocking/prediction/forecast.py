"""What is foreseen of a body: probabilities with their intervals, which input matters, what cannot be predicted."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking.conventions import FloatArray, percent
from rocking.exported import Exported
from rocking.statistics.shares import VarianceShare

if TYPE_CHECKING:
    from rocking.tables import Table

_VERDICTS = (
    (0.01, "will almost certainly stay standing"),
    (1.0 / 3.0, "will probably stay standing"),
    (2.0 / 3.0, "may overturn or not"),
    (0.99, "will probably overturn"),
    (math.inf, "will almost certainly overturn"),
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
            return "It does not rock: nothing grows."
        of = f"{self.lost} of {self.rocking} pairs of histories that differ by one part in a million in scale"
        if not self.lost:
            return (
                f"Each response can be predicted: none of {self.rocking} such pairs ends differently or differs by 1 %."
            )
        share = f"{len(self.motions_lost)} of {self.motions} motions"
        return (
            f"Under {share} this response cannot be predicted; its distribution can: {of} end differently or differ by "
            "more than 1 % in their peaks."
        )


@dataclass(frozen=True, eq=False, repr=False)
class Prediction(Exported):
    """What is foreseen of a body of which not everything is known.

    Parameters
    ----------
    body : str
        The body as it is drawn.
    motions : tuple of str
        Names of the motions.
    inputs : dict of str to str
        What was drawn from what, in words, by input; also what is known.
    assumed : tuple of str
        What nobody said and was assumed, and why; and what is left out.
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
    count, histories, failed : int
        Bodies for each motion behind a probability, histories in all, and those without a result, which do not count.
    seed : int
        Seed of the draws.
    beside : dict of str to Chance
        Of overturning with KED and with Housner's restitution instead of the measured one, all else drawn alike; of
        plane bodies, where no restitution was asked for.
    """

    body: str
    motions: tuple[str, ...]
    inputs: Mapping[str, str]
    assumed: tuple[str, ...]
    sliding_beyond: float
    chances: Mapping[str, Chance]
    shares: Mapping[str, VarianceShare]
    ends: Mapping[str, EndsOfRange]
    growth: Growth
    count: int
    histories: int
    failed: int
    seed: int
    beside: Mapping[str, Chance] = field(default_factory=dict)

    @property
    def verdict(self) -> str:
        """What will become of it, in words and with its probability."""
        chance = self.chances["overturning"]
        words = next(text for most, text in _VERDICTS if chance.value < most)
        if chance.low <= 0.5 <= chance.high:
            words = "may overturn or not"
        return f"It {words}: {_said('overturns', chance)}."

    @property
    def sentences(self) -> tuple[str, ...]:
        """Verdict, the other probabilities, what would change the answer, and whether it can be predicted at all."""
        far = f"slides by {1000.0 * self.sliding_beyond:g} mm or more"
        both = [_said("rocks", self.chances["uplift"]), _said(far, self.chances["sliding"])]
        found = [self.verdict, *(f"I{each[1:]}." for each in both)]
        if self.beside:
            others = (
                f"{percent(c.value)} ({percent(c.low)} to {percent(c.high)}, {n})" for n, c in self.beside.items()
            )
            found.append(f"With another restitution, all else drawn alike, it overturns with {' or '.join(others)}.")
        movers = sorted(self.ends.items(), key=lambda pair: -abs(pair[1].probability_high - pair[1].probability_low))
        for name, each in movers[:2]:
            if each.probability_low != each.probability_high:
                found.append(
                    f"With {name} about {each.low:.3g} it overturns with {percent(each.probability_low)}, about "
                    f"{each.high:.3g} with {percent(each.probability_high)}."
                )
        found.append(self.growth.sentence)
        if self.failed:
            found.append(f"{self.failed} of {self.histories} histories have no result and do not count.")
        return tuple(found)

    def __str__(self) -> str:
        return "\n".join([*self.sentences, *(f"assumed: {each}" for each in self.assumed)])

    __repr__ = __str__

    def as_dict(self) -> dict[str, Any]:
        """Return everything as plain values.

        Returns
        -------
        dict
            NaN where something does not exist.
        """
        plain = (
            "verdict",
            "body",
            "motions",
            "sliding_beyond",
            "inputs",
            "assumed",
            "count",
            "histories",
            "failed",
            "seed",
        )
        return {
            **{name: getattr(self, name) for name in plain},
            "probability": {name: vars(chance) for name, chance in self.chances.items()},
            "beside": {name: vars(chance) for name, chance in self.beside.items()},
            "shares": {_told(name): asdict(share) for name, share in self.shares.items()},
            "ends": {name: asdict(each) for name, each in self.ends.items()},
            "growth": {**asdict(self.growth), "sentence": self.growth.sentence},
        }

    def exported(self) -> "Table":
        """Return one row a motion, the inputs beside it."""
        from rocking.tables import Column, Table, text_array

        columns = {"motion": Column(text_array(list(self.motions)), "", "name of the motion")}
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
            "body": self.body, "verdict": self.verdict, "assumed": "; ".join(self.assumed), "seed": self.seed,
            "sliding_beyond_m": self.sliding_beyond,
            **{f"probability_of_{name}": chance.value for name, chance in self.chances.items()},
        }  # fmt: skip
        return Table("motion", columns, provenance, {"input": Table("input", beside)})


def _said(word: str, chance: Chance) -> str:
    wide = ""
    if not math.isnan(chance.wide_low):
        wide = f"; {percent(chance.wide_low)} to {percent(chance.wide_high)} under other motions like these"
    ends = f"{percent(chance.low)} to {percent(chance.high)}"
    return f"it {word} with a probability of {percent(chance.value)} ({ends}{wide})"


def _told(name: str) -> str:
    return "motion" if name == "case" else name
