"""`score`: probabilities beside what then happened, and beside the plain curves that they must beat."""

import csv
import difflib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from rocking import checks
from rocking.answers import Answer
from rocking.conventions import FloatArray, percent
from rocking.errors import InvalidValueError
from rocking.statistics.counts import LEAST_CLUSTERS
from rocking.statistics.scores import REPETITIONS, Forecasts, Score, logistic_left_out
from rocking.studies.inventory.cells import DecimalMark
from rocking.studies.inventory.sheets import MOST_BYTES, rows_of

PREDICTION, LOGISTIC, BASE_RATE = "prediction", "logistic", "base rate"  # the forecasts that are compared, by name
MEASURES = ("brier", "logarithmic")
BETTER, WORSE, MIXED, NOT_RESOLVED = "better", "worse", "mixed", "not resolved"
_HAPPENED = {"overturning": "overturned", "uplift": "rocked", "sliding": "slid"}
_RIVALS = {
    LOGISTIC: "the plain logistic in PGA and PGV",
    BASE_RATE: "the base rate",
}


@dataclass(frozen=True, eq=False, repr=False)
class Validation:
    """Probabilities beside what then happened, and beside plain curves.

    Parameters
    ----------
    event : str
        What was foreseen: overturning, uplift or sliding.
    outcome : ndarray, shape (n,)
        1 where it happened, 0 where not, NaN where nobody knows [-].
    motions : ndarray, shape (n,)
        Name of the motion of each outcome.
    probability : dict of str to ndarray
        What each forecast gave to each outcome: "prediction", "logistic" and "base rate"; NaN where nothing [-].
    forecasts : dict of str to Forecasts
        The same with their scores, where all of them and the outcome are known.
    """

    event: str
    outcome: FloatArray
    motions: Any
    probability: Mapping[str, FloatArray]
    forecasts: Mapping[str, Forecasts]

    @property
    def count(self) -> int:
        """How many outcomes are scored."""
        return int(self.forecasts[PREDICTION].outcome.size)

    @property
    def clusters(self) -> int:
        """Under how many motions they are."""
        return int(self.forecasts[PREDICTION].cluster.max()) + 1

    @cached_property
    def either(self) -> tuple[int, int]:
        """Under how many motions it happened, and under how many it did not, at least once."""
        said = self.forecasts[PREDICTION]
        yes, no = (np.unique(said.cluster[said.outcome == each]).size for each in (1.0, 0.0))
        return yes, no

    @property
    def enough(self) -> bool:
        """Whether both outcomes were seen under so many motions that drawing these anew says something."""
        return min(self.either) >= LEAST_CLUSTERS

    @cached_property
    def differences(self) -> dict[str, dict[str, Score]]:
        """By how much each score of the prediction is better than that of each plain curve, drawn in pairs."""
        said = self.forecasts[PREDICTION]
        rivals = {name: each for name, each in self.forecasts.items() if name != PREDICTION}
        return {
            name: {measure: said.skill(each, measure) for measure in MEASURES}
            for name, each in rivals.items()
        }  # fmt: skip

    @property
    def finding(self) -> str:
        """What the paired differences say: "better" than both plain curves, "worse" than one, "mixed", "not resolved".

        Balanced accuracy has no say in it: it does not see how sure a forecast was of itself.
        """
        sides = {_side(each) for each in self.differences.values()}
        if not self.enough:
            return NOT_RESOLVED
        return BETTER if sides == {BETTER} else next((each for each in (WORSE, MIXED) if each in sides), NOT_RESOLVED)

    @property
    def verdict(self) -> str:
        """Whether the prediction is better than the plain curves, in words."""
        if not self.enough:
            (yes, no), word = self.either, _HAPPENED[self.event]
            return (
                f"Not resolved: of {self.clusters} motions it {word} under {yes} and did not under {no}, and a verdict "
                f"needs {LEAST_CLUSTERS} of either."
            )
        finding, head = self.finding, f"The prediction of {self.event}"
        which = " and than ".join(_RIVALS[name] for name, each in self.differences.items() if _side(each) == finding)
        return {
            BETTER: f"{head} is better than {which}",
            WORSE: f"{head} is not better: it is worse than {which}",
            MIXED: f"{head} is not better: by one score it is better and by the other worse than {which}",
            NOT_RESOLVED: f"Not resolved: the prediction of {self.event} may be better or worse than {which}",
        }[finding] + (", and it is too sure of itself." if self.too_sure else ".")

    @property
    def too_sure(self) -> bool:
        """Whether more is wrong than the probabilities say, resolved by motion; balanced accuracy does not see that."""
        return self.enough and self.forecasts[PREDICTION].sureness.low > 0.0

    @property
    def sentences(self) -> tuple[str, ...]:
        """The verdict, the differences behind it, and whether too much or too little was said."""
        said = self.forecasts[PREDICTION]
        found = [self.verdict]
        for name, scores in self.differences.items():
            both = [
                f"the {'Brier' if key == 'brier' else key} score is {_better(each)}" for key, each in scores.items()
            ]
            found.append(f"Against {_RIVALS[name]}, {' and '.join(both)}.")
        if self.differences:
            found.append("Both are fitted to the outcomes under all other motions; the prediction is fitted to none.")
        mean, share = percent(float(said.probability.mean())), percent(float(said.outcome.mean()))
        more = "more" if said.bias.value > 0.0 else "less"
        right = f"{more} than happened" if said.bias.resolved else "the difference is not resolved"
        if not self.enough:
            right = "too few to tell the two apart"
        word = _HAPPENED[self.event]
        found.append(f"It said {mean} in the mean, and {share} of {self.count} {word}: {right}.")
        if left := self.outcome.size - self.count:
            found.append(f"{left} of {self.outcome.size} outcomes are not known or have no probability: left out.")
        return tuple(found)

    def __str__(self) -> str:
        return "\n".join(self.sentences)

    __repr__ = __str__

    def answer(self) -> Answer:
        """Return everything that is shown.

        Returns
        -------
        Answer
            NaN where something does not exist, such as the balanced accuracy where all outcomes are alike.
        """
        names = (*MEASURES, "balanced_accuracy", "bias", "sureness")
        return Answer({
            "event": self.event, "finding": self.finding, "too_sure": self.too_sure, "verdict": self.verdict,
            "sentences": self.sentences,
            "outcomes": self.count, "happened": float(self.forecasts[PREDICTION].outcome.sum()),
            "motions": self.clusters, "left_out": self.outcome.size - self.count,
            "scores": {
                key: {**{name: vars(getattr(each, name)) for name in names}, "calibration": each.calibration}
                for key, each in self.forecasts.items()
            },
            "better_by": {
                key: {name: {**vars(each), "resolved": each.resolved} for name, each in scores.items()}
                for key, scores in self.differences.items()
            },
            "reliability": [
                {
                    "count": each.count, "predicted": each.predicted, "observed": each.observed,
                    "observed_low": each.low, "observed_high": each.high,
                }
                for each in self.forecasts[PREDICTION].reliability()
            ],
        })  # fmt: skip


def score(  # noqa: PLR0913 - the outcomes and what shook each, beside how they are counted
    probability: Any,
    outcome: Any,
    motions: Any,
    *,
    pga: Any,
    pgv: Any,
    count: int | None = None,
    event: str = "overturning",
    repetitions: int = REPETITIONS,
    seed: int = 0,
) -> Validation:
    """Score probabilities by what then happened, beside plain curves that must be beaten.

    The plain forecasts are a logistic in ln PGA and ln PGV, and the share that happened at all, either fitted to the
    outcomes under all other motions. Scores are the Brier and the logarithmic score; all intervals draw whole motions
    anew, and differences are drawn in pairs.

    Parameters
    ----------
    probability : array_like, shape (n,)
        Probability given to each outcome beforehand [-].
    outcome : array_like, shape (n,)
        1 where it happened, 0 where not, NaN where nobody knows [-].
    motions : array_like, shape (n,)
        Name of the motion of each outcome: the same record at another scale is the same motion.
    pga, pgv : array_like, shape (n,)
        Peak acceleration [m/s2] and velocity [m/s] of the ground.
    count : int, optional
        Histories behind each probability: a share h/n of a finite sample is never quite certain, so it counts as
        (h + 1/2)/(n + 1). Taken as they are if not given.
    event : str
        What was foreseen: "overturning", "uplift" or "sliding".
    repetitions : int
        Bootstrap samples of the intervals.
    seed : int
        Of the bootstrap.

    Returns
    -------
    Validation
        Scores, differences, the reliability diagram, and a verdict.

    Raises
    ------
    InvalidValueError
        If lengths differ, a probability is outside [0, 1], an outcome is none, a peak is not above zero, or nothing is
        known.

    Examples
    --------
    >>> import numpy as np
    >>> pga = np.repeat(np.linspace(1.0, 5.0, 20), 2)
    >>> fell = (np.arange(40) % 3 == 0) * 1.0
    >>> score(0.9 * fell + 0.05, fell, np.arange(40) // 2, pga=pga, pgv=0.1 * pga, count=128).finding
    'better'
    """
    checks.one_of("event", event, _HAPPENED)
    given, happened = (np.asarray(each, dtype=np.float64) for each in (probability, outcome))
    names, peaks = np.asarray(motions), [np.asarray(each, dtype=np.float64) for each in (pga, pgv)]
    shapes = [each.shape for each in (given, happened, names, *peaks)]
    if given.ndim != 1 or len(set(shapes)) > 1:
        raise InvalidValueError(
            "probability, outcome, motions, pga and pgv must be rows of one length, got shapes "
            + ", ".join(map(str, shapes))
        )
    for name, each in zip(("pga", "pgv"), peaks, strict=True):
        if not ((each > 0.0) & np.isfinite(each)).all():
            raise InvalidValueError(
                "{parameter} must be {allowed}, got {values}", parameter=name, allowed="above zero",
                values=each[~(each > 0.0)][:1], hint="is a record empty?",
            )  # fmt: skip
    if count is not None:
        n = checks.whole("count", count, 1, 1 << 24)
        inside = (given >= 0.0) & (given <= 1.0)  # what is not is refused by its own value
        given = np.where(inside, (given * n + 0.5) / (n + 1.0), given)
    found = {
        PREDICTION: given,
        LOGISTIC: logistic_left_out(np.log(np.column_stack(peaks)), happened, names),
        BASE_RATE: logistic_left_out(np.empty((given.size, 0)), happened, names),
    }
    both = ~np.isnan(given) & ~np.isnan(happened)
    rivals = (PREDICTION, *(name for name in (LOGISTIC, BASE_RATE) if np.isfinite(found[name][both]).all()))
    how: dict[str, Any] = {"repetitions": repetitions, "seed": seed}
    forecasts = {name: Forecasts(found[name][both], happened[both], names[both], **how) for name in rivals}
    return Validation(event, happened, names, found, forecasts)


def _side(scores: Mapping[str, Score]) -> str:
    """Return on which side of a plain curve a forecast is, by its differences that are resolved."""
    sides = {BETTER if each.value > 0.0 else WORSE for each in scores.values() if each.resolved}
    return NOT_RESOLVED if not sides else MIXED if len(sides) > 1 else sides.pop()


def _better(each: Score) -> str:
    side = "better" if each.value > 0.0 else "worse"
    low, high = sorted((each.low, each.high) if each.value > 0.0 else (-each.low, -each.high))
    ends = f"{low:.3f} to {high:.3f}" + ("" if each.resolved else ", not resolved")
    return f"{side} by {abs(each.value):.3f} ({ends})"


EVENTS = {"overturned": "overturning", "rocked": "uplift", "slid": "sliding"}
"""Columns of what was seen, and what a prediction calls it."""

AXES = ("x", "y", "z")
COLUMNS = ("motion", *AXES, "scale", *EVENTS)
"""Columns that are read: motion, or x with y and z where there are several components."""

_SEEN = {"1": 1.0, "yes": 1.0, "true": 1.0, "0": 0.0, "no": 0.0, "false": 0.0, "": float("nan")}
_HOW = (
    "a table of outcomes is a .csv file whose first line names the columns motion (or x, y, z) and overturned, and if "
    "known scale, rocked, slid, with commas, semicolons or tabs between"
)


@dataclass(frozen=True)
class Trial:
    """One row: which motion, how strong, and what was seen."""

    line: int
    files: tuple[tuple[str, str], ...]  # axis and record file of each component
    scale: float  # factor on the acceleration [-]
    seen: dict[str, float]  # 1, 0, or NaN where nobody knows, by event

    @property
    def motion(self) -> str:
        """The files, by which trials are counted as of one motion whatever their scale."""
        return " ".join(word if len(self.files) == 1 else f"{axis}={word}" for axis, word in self.files)


@dataclass(frozen=True)
class UntakenRow:
    """A row that could not be taken, and why."""

    line: int
    reason: str


@dataclass(frozen=True)
class Outcomes:
    """What a table says."""

    source: str
    trials: tuple[Trial, ...]
    refused: tuple[UntakenRow, ...]
    ignored: tuple[str, ...]  # columns that were not read

    @classmethod
    def read(cls, path: Path) -> "Outcomes":
        """Return what a file says, each row checked by itself."""
        if path.stat().st_size > MOST_BYTES:
            raise InvalidValueError(
                "a table must be below {limit} MiB", limit=MOST_BYTES >> 20, hint="another kind of file?"
            ).at(path.name)
        try:
            text = path.read_bytes().decode("utf-8-sig")
        except UnicodeDecodeError as error:
            raise InvalidValueError('{file} is not UTF-8 text: save it as "CSV UTF-8"', file=path.name) from error
        return cls.parsed(text, path.name)

    @classmethod
    def parsed(cls, text: str, source: str) -> "Outcomes":
        r"""Return what a text says.

        >>> found = Outcomes.parsed("motion;scale;overturned\na.at2;1,5;yes\nb.at2;2;perhaps", "seen.csv")
        >>> found.trials[0].scale, found.refused[0].reason
        (1.5, "overturned must be 1, 0, yes, no, true, false or empty, got 'perhaps'")
        """
        delimiter = _delimiter(text)
        if delimiter is None:
            raise InvalidValueError(_HOW).at(source)
        (_, head), *rows = rows_of(text, delimiter, source)
        titles = [title.strip().casefold() for title in head]
        _check_titles(titles, source)
        rows = [(line, cells) for line, cells in rows if any(cell.strip() for cell in cells)]
        numbers = (dict(zip(titles, cells, strict=False)).get("scale", "") for _, cells in rows)
        mark = DecimalMark(numbers, comma_delimited=delimiter == ",")
        trials, refused = [], []
        for line, cells in rows:
            try:
                trials.append(_trial(line, cells, titles, mark))
            except InvalidValueError as error:
                refused.append(UntakenRow(line, str(error)))
        ignored = (raw.strip() for raw, title in zip(head, titles, strict=True) if title and title not in COLUMNS)
        return cls(source, tuple(trials), tuple(refused), tuple(ignored))


def is_outcomes(path: Path) -> bool:
    """Return whether the first line of a file names what was seen. Never raises."""
    try:
        with path.open("rb") as file:
            return _delimiter(file.read(10_000).decode("utf-8-sig", "replace")) is not None
    except OSError:
        return False


def _delimiter(text: str) -> str | None:
    first = next((line for line in text.splitlines() if line.strip()), "")
    for mark in ",;\t":
        if "overturned" in (title.strip().casefold() for title in next(csv.reader([first], delimiter=mark), [])):
            return mark
    return None


def _check_titles(titles: Sequence[str], source: str) -> None:
    if twice := next((title for title in titles if title and titles.count(title) > 1), None):
        raise InvalidValueError("column {column!r:.60} stands twice", column=twice, hint="leave one").at(source)
    if ("motion" in titles) == ("x" in titles):
        raise InvalidValueError("give the column motion, or x with y and z, and not both", hint=_HOW).at(source)
    if "motion" in titles and (odd := [axis for axis in AXES if axis in titles]):
        raise InvalidValueError("column {column!r} goes with x: name the column motion x", column=odd[0]).at(source)
    for title in titles:
        words = set(title.replace("_", " ").replace("-", " ").split())
        near = [*(words & set(COLUMNS)), *difflib.get_close_matches(title, COLUMNS, n=1, cutoff=0.75)]
        if title not in COLUMNS and near:  # what it says would change the answer, so it must not be passed over
            raise InvalidValueError(
                "column {column!r:.60} is not known", column=title,
                hint=f"did you mean {near[0]!r}? Rename it",
            ).at(source)  # fmt: skip


def _trial(line: int, cells: Sequence[str], titles: Sequence[str], mark: DecimalMark) -> Trial:
    if len(cells) != len(titles):
        hint = "a decimal comma between commas?" if len(cells) > len(titles) else "a separator missing?"
        raise InvalidValueError(
            "it has {count} fields, the first line {expected}", count=len(cells), expected=len(titles), hint=hint
        )
    row = {title: cell.strip() for title, cell in zip(titles, cells, strict=True)}
    files = tuple((axis, row[key]) for axis, key in (("x", "motion"), *((a, a) for a in AXES)) if row.get(key))
    if not files or files[0][0] != "x":
        raise InvalidValueError(
            "{parameter} is empty: the name of a record file", parameter="motion" if "motion" in row else "x"
        )
    scale = mark.number("scale", row["scale"]) if row.get("scale") else 1.0
    if scale == 0.0:
        raise InvalidValueError("scale must not be 0: nothing would move")
    seen = {}
    for column, event in EVENTS.items():
        word = row.get(column, "").casefold()
        if word not in _SEEN:
            raise InvalidValueError(parameter=column, allowed="1, 0, yes, no, true, false or empty", value=row[column])
        seen[event] = _SEEN[word]
    return Trial(line, files, scale, seen)


def column(trials: Sequence[Trial], event: str) -> FloatArray:
    """Return what was seen of an event, one entry a trial."""
    return np.array([trial.seen[event] for trial in trials], dtype=np.float64)
