"""`score`: probabilities compared with outcomes, and with simple reference curves."""

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
from rocking.decision.inventory.lists.cells import DecimalMark
from rocking.decision.inventory.lists.sheets import MOST_BYTES, rows_of
from rocking.errors import InvalidValueError
from rocking.statistics.counts import MIN_CLUSTERS
from rocking.statistics.scores import REPETITIONS, Forecasts, Score, logistic_left_out

PREDICTION, LOGISTIC, BASE_RATE = "prediction", "logistic", "base rate"  # names of the compared forecasts
MEASURES = ("brier", "logarithmic")
BETTER, WORSE, MIXED, NOT_RESOLVED = "better", "worse", "mixed", "not resolved"
_HAPPENED = {"overturning": "overturned", "uplift": "rocked", "sliding": "slid"}
_RIVALS = {
    LOGISTIC: "the logistic regression on PGA and PGV",
    BASE_RATE: "the base rate",
}


@dataclass(frozen=True, eq=False, repr=False)
class Validation:
    """Probabilities compared with outcomes and with reference curves.

    Parameters
    ----------
    event : str
        Predicted event: overturning, uplift or sliding.
    outcome : ndarray, shape (n,)
        1 if the event occurred, 0 if not, NaN if unknown [-].
    motions : ndarray, shape (n,)
        Name of the motion of each outcome.
    probability : dict of str to ndarray
        Probability of each outcome by forecast: "prediction", "logistic" and "base rate"; NaN if missing [-].
    forecasts : dict of str to Forecasts
        Forecasts with scores, for outcomes with a known result and all probabilities.
    """

    event: str
    outcome: FloatArray
    motions: Any
    probability: Mapping[str, FloatArray]
    forecasts: Mapping[str, Forecasts]

    @property
    def count(self) -> int:
        """Number of scored outcomes."""
        return int(self.forecasts[PREDICTION].outcome.size)

    @property
    def clusters(self) -> int:
        """Number of motions of the scored outcomes."""
        return int(self.forecasts[PREDICTION].cluster.max()) + 1

    @cached_property
    def either(self) -> tuple[int, int]:
        """Number of motions with at least one occurrence of the event, and number with at least one absence."""
        forecast = self.forecasts[PREDICTION]
        with_event, without_event = (
            np.unique(forecast.cluster[forecast.outcome == value]).size for value in (1.0, 0.0)
        )
        return with_event, without_event

    @property
    def enough(self) -> bool:
        """True if both outcomes occur under enough motions for a bootstrap over motions."""
        return min(self.either) >= MIN_CLUSTERS

    @cached_property
    def differences(self) -> dict[str, dict[str, Score]]:
        """Paired difference of each score of the prediction to each reference curve; positive is better."""
        forecast = self.forecasts[PREDICTION]
        rivals = {name: rival for name, rival in self.forecasts.items() if name != PREDICTION}
        return {
            name: {measure: forecast.skill(rival, measure) for measure in MEASURES}
            for name, rival in rivals.items()
        }  # fmt: skip

    @property
    def finding(self) -> str:
        """Result: "better" than both reference curves, "worse" than at least one of them, "mixed" or "not resolved".

        Balanced accuracy is not used, because it ignores the probability of a forecast.
        """
        sides = {_side(side) for side in self.differences.values()}
        if not self.enough:
            return NOT_RESOLVED
        return BETTER if sides == {BETTER} else next((side for side in (WORSE, MIXED) if side in sides), NOT_RESOLVED)

    @property
    def verdict(self) -> str:
        """Comparison of the prediction with the reference curves as a sentence."""
        if not self.enough:
            (with_event, without_event), verb = self.either, _HAPPENED[self.event]
            return (
                f"Not resolved: of {self.clusters} motions the body {verb} under {with_event} and did not under "
                f"{without_event}; a verdict requires {MIN_CLUSTERS} motions of each."
            )
        finding, subject = self.finding, f"The prediction of {self.event}"
        rivals = " and than ".join(
            _RIVALS[name] for name, scores in self.differences.items() if _side(scores) == finding
        )
        return {
            BETTER: f"{subject} is better than {rivals}",
            WORSE: f"{subject} is not better: it is worse than {rivals}",
            MIXED: f"{subject} is not better: by one score it is better and by the other worse than {rivals}",
            NOT_RESOLVED: f"Not resolved: the prediction of {self.event} may be better or worse than {rivals}",
        }[finding] + (", and it is overconfident." if self.too_sure else ".")

    @property
    def too_sure(self) -> bool:
        """True if the prediction is overconfident: there are enough motions, and the interval is above zero."""
        return self.enough and self.forecasts[PREDICTION].sureness.low > 0.0

    @property
    def sentences(self) -> tuple[str, ...]:
        """Verdict, its differences of scores, and bias of the probability."""
        forecast = self.forecasts[PREDICTION]
        sentences = [self.verdict]
        for name, scores in self.differences.items():
            parts = [
                f"the {'Brier' if key == 'brier' else key} score is {_better(difference)}"
                for key, difference in scores.items()
            ]
            sentences.append(f"Against {_RIVALS[name]}, {' and '.join(parts)}.")
        if self.differences:
            sentences.append(
                "Both curves are fitted to the outcomes under all other motions; the prediction is not fitted."
            )
        mean, share = percent(float(forecast.probability.mean())), percent(float(forecast.outcome.mean()))
        direction = "more" if forecast.bias.value > 0.0 else "less"
        comparison = f"{direction} than observed" if forecast.bias.resolved else "the difference is not resolved"
        if not self.enough:
            comparison = "too few outcomes for a comparison"
        verb = _HAPPENED[self.event]
        sentences.append(f"The mean prediction is {mean}, and {share} of {self.count} {verb}: {comparison}.")
        if left_out := self.outcome.size - self.count:
            sentences.append(
                f"{left_out} of {self.outcome.size} outcomes are unknown or have no probability and are not scored."
            )
        return tuple(sentences)

    def __str__(self) -> str:
        return "\n".join(self.sentences)

    __repr__ = __str__

    def answer(self) -> Answer:
        """Return all results.

        Returns
        -------
        Answer
            NaN without a value, such as the balanced accuracy if all outcomes are equal.
        """
        names = (*MEASURES, "balanced_accuracy", "bias", "sureness")
        return Answer({
            "event": self.event, "finding": self.finding, "too_sure": self.too_sure, "verdict": self.verdict,
            "sentences": self.sentences,
            "outcomes": self.count, "happened": float(self.forecasts[PREDICTION].outcome.sum()),
            "motions": self.clusters, "left_out": self.outcome.size - self.count,
            "scores": {
                key: {**{name: vars(getattr(item, name)) for name in names}, "calibration": item.calibration}
                for key, item in self.forecasts.items()
            },
            "better_by": {
                key: {name: {**vars(item), "resolved": item.resolved} for name, item in scores.items()}
                for key, scores in self.differences.items()
            },
            "reliability": [
                {
                    "count": item.count, "predicted": item.predicted, "observed": item.observed,
                    "observed_low": item.low, "observed_high": item.high,
                }
                for item in self.forecasts[PREDICTION].reliability()
            ],
        })  # fmt: skip


def score(  # noqa: PLR0913 - outcomes, motions and settings
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
    """Score probabilities against outcomes, compared with simple reference curves.

    The reference forecasts are a logistic regression on ln PGA and ln PGV, and the fraction of outcomes with the event.
    Both are fitted to the outcomes under all other motions. Scores are the Brier and the logarithmic score. The
    bootstrap of the intervals resamples motions, and differences in pairs.

    Parameters
    ----------
    probability : array_like, shape (n,)
        Predicted probability of each outcome [-].
    outcome : array_like, shape (n,)
        1 if the event occurred, 0 if not, NaN if unknown [-].
    motions : array_like, shape (n,)
        Name of the motion of each outcome: the same record at another scale is the same motion.
    pga, pgv : array_like, shape (n,)
        Peak ground acceleration [m/s2] and velocity [m/s].
    count : int, optional
        Number of histories per probability. A fraction h/n of a finite sample is then replaced by
        (h + 1/2)/(n + 1). Default: probabilities are used without change.
    event : str
        Predicted event: "overturning", "uplift" or "sliding".
    repetitions : int
        Number of bootstrap samples.
    seed : int
        Random seed of the bootstrap.

    Returns
    -------
    Validation
        Scores, differences, the reliability diagram, and a verdict.

    Raises
    ------
    InvalidValueError
        If lengths differ, a probability is outside [0, 1], an outcome is not allowed, a peak is not positive, or all
        outcomes are unknown.

    Examples
    --------
    >>> import numpy as np
    >>> pga = np.repeat(np.linspace(1.0, 5.0, 20), 2)
    >>> outcome = (np.arange(40) % 3 == 0) * 1.0
    >>> score(0.9 * outcome + 0.05, outcome, np.arange(40) // 2, pga=pga, pgv=0.1 * pga, count=128).finding
    'better'
    """
    checks.one_of("event", event, _HAPPENED)
    probabilities, outcomes = (np.asarray(values, dtype=np.float64) for values in (probability, outcome))
    names, peaks = np.asarray(motions), [np.asarray(values, dtype=np.float64) for values in (pga, pgv)]
    shapes = [values.shape for values in (probabilities, outcomes, names, *peaks)]
    if probabilities.ndim != 1 or len(set(shapes)) > 1:
        raise InvalidValueError(
            "probability, outcome, motions, pga and pgv must be 1-D arrays of equal length, got shapes "
            + ", ".join(map(str, shapes))
        )
    for name, values in zip(("pga", "pgv"), peaks, strict=True):
        if not ((values > 0.0) & np.isfinite(values)).all():
            raise InvalidValueError(
                "{parameter} must be {allowed}, got {values}", parameter=name, allowed="above zero",
                values=values[~(values > 0.0)][:1], hint="check for empty records",
            )  # fmt: skip
    if count is not None:
        n = checks.whole("count", count, 1, 1 << 24)
        inside = (probabilities >= 0.0) & (probabilities <= 1.0)  # `Forecasts` raises the error for other values
        probabilities = np.where(inside, (probabilities * n + 0.5) / (n + 1.0), probabilities)
    by_forecast = {
        PREDICTION: probabilities,
        LOGISTIC: logistic_left_out(np.log(np.column_stack(peaks)), outcomes, names),
        BASE_RATE: logistic_left_out(np.empty((probabilities.size, 0)), outcomes, names),
    }
    is_scored = ~np.isnan(probabilities) & ~np.isnan(outcomes)
    rivals = (PREDICTION, *(name for name in (LOGISTIC, BASE_RATE) if np.isfinite(by_forecast[name][is_scored]).all()))
    bootstrap: dict[str, Any] = {"repetitions": repetitions, "seed": seed}
    forecasts = {
        name: Forecasts(by_forecast[name][is_scored], outcomes[is_scored], names[is_scored], **bootstrap)
        for name in rivals
    }
    return Validation(event, outcomes, names, by_forecast, forecasts)


def _side(scores: Mapping[str, Score]) -> str:
    """Return "better", "worse", "mixed" or "not resolved" for a forecast relative to a reference."""
    sides = {BETTER if difference.value > 0.0 else WORSE for difference in scores.values() if difference.resolved}
    return NOT_RESOLVED if not sides else MIXED if len(sides) > 1 else sides.pop()


def _better(difference: Score) -> str:
    side = "better" if difference.value > 0.0 else "worse"
    low, high = sorted(
        (difference.low, difference.high) if difference.value > 0.0 else (-difference.low, -difference.high)
    )
    ends = f"{low:.3f} to {high:.3f}" + ("" if difference.resolved else ", not resolved")
    return f"{side} by {abs(difference.value):.3f} ({ends})"


EVENTS = {"overturned": "overturning", "rocked": "uplift", "slid": "sliding"}
"""Columns of observed outcomes, and the event of each in a prediction."""

AXES = ("x", "y", "z")
CLUSTER = "earthquake"
COLUMNS = ("motion", *AXES, "scale", CLUSTER, *EVENTS)
"""Columns of a table of outcomes: motion, or x, y and z for components. Tests of one earthquake are dependent."""

_SYNONYMS = {"record": "motion", "shake": "motion", "cluster": CLUSTER, "event": CLUSTER}

_OBSERVED = {"1": 1.0, "yes": 1.0, "true": 1.0, "0": 0.0, "no": 0.0, "false": 0.0, "": float("nan")}
_HOW = (
    "a table of outcomes is a .csv file with commas, semicolons or tabs; the first line names the columns motion (or "
    "x, y, z), overturned, and optionally scale, earthquake, rocked, slid"
)


@dataclass(frozen=True)
class Trial:
    """One row: motion, scale factor and observed outcomes."""

    line: int
    files: tuple[tuple[str, str], ...]  # axis and record file by component
    scale: float  # factor on the acceleration [-]
    observed: dict[str, float]  # 1, 0, or NaN if unknown, by event
    earthquake: str = ""  # name of the earthquake; empty if not stated

    @property
    def motion(self) -> str:
        """File names; trials with the same files have the same motion at any scale."""
        return " ".join(word if len(self.files) == 1 else f"{axis}={word}" for axis, word in self.files)


@dataclass(frozen=True)
class RefusedRow:
    """A row that cannot be used, and the reason."""

    line: int
    reason: str


@dataclass(frozen=True)
class Outcomes:
    """Content of a table of outcomes."""

    source: str
    trials: tuple[Trial, ...]
    refused: tuple[RefusedRow, ...]
    ignored: tuple[str, ...]  # names of ignored columns

    @classmethod
    def read(cls, path: Path) -> "Outcomes":
        """Return the content of a file; each row is checked separately."""
        if path.stat().st_size > MOST_BYTES:
            raise InvalidValueError(
                "a table must be smaller than {limit} MiB", limit=MOST_BYTES >> 20, hint="check the kind of file"
            ).at(path.name)
        try:
            text = path.read_bytes().decode("utf-8-sig")
        except UnicodeDecodeError as error:
            raise InvalidValueError('{file} is not UTF-8 text: save it as "CSV UTF-8"', file=path.name) from error
        return cls.parsed(text, path.name)

    @classmethod
    def parsed(cls, text: str, source: str) -> "Outcomes":
        r"""Return the content of a text.

        >>> outcomes = Outcomes.parsed("motion;scale;overturned\na.at2;1,5;yes\nb.at2;2;perhaps", "seen.csv")
        >>> outcomes.trials[0].scale, outcomes.refused[0].reason
        (1.5, "overturned must be 1, 0, yes, no, true, false or empty, got 'perhaps'")
        """
        delimiter = _delimiter(text)
        if delimiter is None:
            raise InvalidValueError(_HOW).at(source)
        (_, head), *rows = rows_of(text, delimiter, source)
        titles = [_SYNONYMS.get(title, title) for title in (raw.strip().casefold() for raw in head)]
        _check_titles(titles, source)
        rows = [(line, cells) for line, cells in rows if any(cell.strip() for cell in cells)]
        numbers = (dict(zip(titles, cells, strict=False)).get("scale", "") for _, cells in rows)
        mark = DecimalMark(numbers, comma_delimited=delimiter == ",")
        trials, refused = [], []
        for line, cells in rows:
            try:
                trials.append(_trial(line, cells, titles, mark))
            except InvalidValueError as error:
                refused.append(RefusedRow(line, str(error)))
        ignored = (raw.strip() for raw, title in zip(head, titles, strict=True) if title and title not in COLUMNS)
        return cls(source, tuple(trials), tuple(refused), tuple(ignored))


def is_outcomes(path: Path) -> bool:
    """Return True if the first line of a file contains a column of observed outcomes; raises no error."""
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
        raise InvalidValueError("column {column!r:.60} appears twice", column=twice, hint="remove one").at(source)
    if ("motion" in titles) == ("x" in titles):
        raise InvalidValueError("use either the column motion, or x with y and z", hint=_HOW).at(source)
    if "motion" in titles and (unexpected := [axis for axis in AXES if axis in titles]):
        raise InvalidValueError(
            "column {column!r} requires the column x. Rename the column motion to x.", column=unexpected[0]
        ).at(source)
    for title in titles:
        title_words = set(title.replace("_", " ").replace("-", " ").split())
        candidates = [*(title_words & set(COLUMNS)), *difflib.get_close_matches(title, COLUMNS, n=1, cutoff=0.75)]
        if title not in COLUMNS and candidates:  # the column must not be ignored, because this would change the result
            raise InvalidValueError(
                "unknown column {column!r:.60}", column=title, hint=f"rename it to {candidates[0]!r}",
            ).at(source)  # fmt: skip


def _trial(line: int, cells: Sequence[str], titles: Sequence[str], mark: DecimalMark) -> Trial:
    if len(cells) != len(titles):
        hint = "check for decimal commas" if len(cells) > len(titles) else "check the separators"
        raise InvalidValueError(
            "the line has {count} fields, but the first line has {expected}",
            count=len(cells),
            expected=len(titles),
            hint=hint,
        )
    row = {title: cell.strip() for title, cell in zip(titles, cells, strict=True)}
    files = tuple((axis, row[key]) for axis, key in (("x", "motion"), *((a, a) for a in AXES)) if row.get(key))
    if not files or files[0][0] != "x":
        raise InvalidValueError(
            "{parameter} is empty; enter the name of a record file", parameter="motion" if "motion" in row else "x"
        )
    scale = mark.number("scale", row["scale"]) if row.get("scale") else 1.0
    if scale == 0.0:
        raise InvalidValueError("scale must not be 0")
    observed = {}
    for column, event in EVENTS.items():
        word = row.get(column, "").casefold()
        if word not in _OBSERVED:
            raise InvalidValueError(parameter=column, allowed="1, 0, yes, no, true, false or empty", value=row[column])
        observed[event] = _OBSERVED[word]
    if CLUSTER in row and not row[CLUSTER]:
        raise InvalidValueError("{parameter} is empty; enter the name of the earthquake", parameter=CLUSTER)
    return Trial(line, files, scale, observed, row.get(CLUSTER, ""))


def column(trials: Sequence[Trial], event: str) -> FloatArray:
    """Return the observed outcomes of an event, one entry per trial."""
    return np.array([trial.observed[event] for trial in trials], dtype=np.float64)
