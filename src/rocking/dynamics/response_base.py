"""What the responses of every mechanics share: how they end, in words, in files, and how long a motion lasts."""

import math
from abc import abstractmethod
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rocking import checks
from rocking.answers import Answer, AnswerRows
from rocking.conventions import FloatArray
from rocking.dynamics.settings import Settings
from rocking.errors import InvalidValueError
from rocking.exported import Exported
from rocking.messages import Message
from rocking.motions.pulse import Motion, Pulse
from rocking.motions.segments import Segments
from rocking.motions.summary import provenance_of
from rocking.outcome import Outcome, Status
from rocking.quantities import with_units
from rocking.version import SOFTWARE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from rocking.tables import Table


def motion_provenance(motion: Any) -> str:
    """Return where a motion comes from."""
    return "ground at rest" if motion is None else "; ".join(provenance_of(motion))


_ROUNDING = 1e-9


def interval_rows(intervals: Sequence[tuple[Any, ...]], *names: str) -> AnswerRows:
    """Return a table of intervals of one contact; names: of the columns after start and end."""
    columns = zip(*intervals, strict=True) if intervals else [()] * (2 + len(names))
    return AnswerRows(dict(zip(("start", "end", *names), columns, strict=True)))


class ResponseBase(Exported):
    """One history: how it ends, in words, in a picture, and on its way out."""

    _blank = False

    settings: Settings
    trajectory: Any  # what the engine returned: outcome, status, overturning_time, still_rocking, engine

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.summary} [{self.engine}]>"

    @property
    def outcome(self) -> Outcome:
        """How it ended."""
        outcome: Outcome = self.trajectory.outcome
        return outcome

    @property
    def status(self) -> Status:
        """Whether it could be computed."""
        status: Status = self.trajectory.status
        return status

    @property
    def engine(self) -> str:
        """Which engine ran, and how."""
        engine: str = self.trajectory.engine
        return engine

    @property
    def overturning_time(self) -> float:
        """When the centre of mass passed over the contact for good; NaN if it did not overturn [s]."""
        return float(self.trajectory.overturning_time)

    @property
    def still_rocking(self) -> bool:
        """Whether it stands, but does not yet rest where the response ends; later impacts are not among `impacts`."""
        return bool(self.trajectory.still_rocking)

    @property
    def unfinished(self) -> str:
        """A sentence that says when and how it still rocks where the response ends; empty if it does not."""
        if not self.still_rocking:
            return ""
        doing, end, place = self._last_motion
        unfinished = Message(
            "it is still {activity} when the computation ends at {time:.4g} s, {state}; later impacts are not counted",
            {"activity": Message(doing), "time": end, "state": place},
        )
        return Message.followed(unfinished, self._end_reason)

    @property
    def _end_reason(self) -> str:
        """Why the body does not come to rest within the response; empty if the duration alone ends it."""
        return "no impact loses energy, so that it never comes to rest" if self._never_rests else ""

    @property
    def _never_rests(self) -> bool:
        """Whether impacts lose no energy."""
        return False

    @property
    def summary(self) -> str:
        """The outcome in one sentence; also whether it still rocks where the response ends."""
        if self.outcome is Outcome.FAILED:
            return Message("{outcome}: {reason}", {"outcome": self.outcome.value, "reason": self.status.value})
        return Message.followed(self._ending, self.unfinished)

    @property
    @abstractmethod
    def _ending(self) -> str:
        """The outcome, where there is one, in one sentence."""

    @property
    @abstractmethod
    def _last_motion(self) -> tuple[str, float, str]:
        """What a body that still rocks does where the response ends, when that is [s], and how it stands then."""

    @property
    @abstractmethod
    def _samples(self) -> dict[str, FloatArray]:
        """Values over `time`, by their names in `rocking.quantities`."""

    @property
    @abstractmethod
    def _tables(self) -> dict[str, AnswerRows]:
        """Tables beside the samples: impacts, and intervals of one contact."""

    @property
    @abstractmethod
    def _facts(self) -> dict[str, Any]:
        """What was computed from what, beside software, engine, outcome and settings, as plain values."""

    def answer(self) -> Answer:
        """Return what is shown of the response.

        Returns
        -------
        Answer
            What was computed, the outcome, peaks, energy, and tables of impacts and contacts.
        """
        time = self.overturning_time
        return Answer({
            "engine": self.engine, "gravity": self.settings.gravity, "outcome": self.outcome.name.lower(),
            "summary": self.summary, "still_rocking": self.still_rocking,
            "last_state": {"unfinished": self.unfinished, **self._last_state} if self.still_rocking else None,
            "overturning_time": None if math.isnan(time) else time,
            **self._values,
            **self._tables,
        })  # fmt: skip

    @property
    @abstractmethod
    def _values(self) -> dict[str, Any]:
        """What an answer of these mechanics has beside what all have."""

    @property
    @abstractmethod
    def _last_state(self) -> dict[str, Any]:
        """State of a body that still rocks where the response ends."""

    def plot(self, path: str | Path | None = None, **options: Any) -> "Figure":
        """Draw the response.

        Parameters
        ----------
        path : str or Path, optional
            Where to write the picture, too: .png, .svg or .pdf.
        **options
            Of the picture of this kind of response in `rocking.plots`: `friction` where it rocks alone.

        Returns
        -------
        matplotlib.figure.Figure
            The picture.

        Raises
        ------
        MissingExtraError
            If matplotlib is not installed.
        RockingError
            If the ending of the path is another.
        """
        from rocking.plots import write

        figure = self._plot(**options)
        if path is not None:
            write(figure, Path(path))
        return figure

    @abstractmethod
    def _plot(self, **options: Any) -> "Figure":
        """Draw the response by the picture of its kind."""

    def exported(self) -> "Table":
        """Return samples, with tables of impacts and the like beside them."""
        from rocking.tables import Table

        ended = {
            "software": SOFTWARE, "engine": self.engine, "outcome": self.outcome.name, "status": self.status.name,
            "still_rocking": self.still_rocking, "summary": self.summary,
        }  # fmt: skip
        settings = {f"setting_{name}": value for name, value in self.settings.integration.items()}
        beside = {name.removesuffix("s"): rows.arrays for name, rows in self._tables.items()}
        tables = {row: Table.of(row, arrays) for row, arrays in beside.items()}
        provenance = with_units(ended | self._facts | settings)
        return Table.of("time", self._samples, provenance=provenance, beside=tables, no_unit="-")

    def animate(self, path: str | Path, **options: Any) -> Path:
        """Write the response as it moves.

        Parameters
        ----------
        path : str or Path
            A web page of one file (.html), or a film (.gif).
        **options
            Of a film, as of `rocking.plots.animate_gif`: fps, speed, progress.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        InvalidValueError
            If the ending of the path is another, or these mechanics have no animation.
        MissingExtraError
            If matplotlib is not installed, which films need.
        """
        from rocking.plots import animate_gif, animate_html

        suffix = Path(path).suffix.lower()
        if suffix not in {".html", ".gif"}:
            raise InvalidValueError(
                "an animation is .html or .gif, got {value}", parameter="path", value=Path(path).name
            )
        if suffix == ".html" and options:
            raise InvalidValueError(
                "{options}: these are for films (.gif); the page has its own controls", options=", ".join(options)
            )
        response: Any = self
        return animate_html(response, path) if suffix == ".html" else animate_gif(response, path, **options)

    def _known(self, time: Any, end: float) -> FloatArray:
        """Return times up to an end, to rounding; what lies outside is refused [s]."""
        times = checks.real_array("time", time, "s")
        bad = times[~((times >= -_ROUNDING * end) & (times <= (1.0 + _ROUNDING) * end))]
        if bad.size:
            raise InvalidValueError(
                "time must be in [0, {end:g}] s, where the response is known, got {time:g}", end=end, time=bad[0]
            )
        return np.clip(times, 0.0, end)


_MOST_SAMPLES = 2_000_000


def most_samples_last(step: float) -> float:
    """Return the longest duration of which a response may have samples [s]."""
    return _MOST_SAMPLES * step


def ground_at_rest(step: float, length: float) -> Segments:
    """Return ground at rest in steps, for a length [s]."""
    check_samples(length / step)
    return Segments.still(step, max(1, math.ceil(length / step - 1e-9)))


def followed(segments: Segments, length: float, parts: int, motion: Motion) -> Segments:
    """Return a motion cut or followed by rest to a length [s]; the stretches of a pulse in so many parts."""
    if isinstance(motion, Pulse):
        segments = segments.refined(parts)
    check_samples(length / segments.step)
    keep = max(1, math.ceil(length / segments.step - 1e-9))
    vertical = None if segments.vertical is None else segments.vertical[:keep]
    return Segments(segments.step, segments.horizontal[:keep], vertical).extended(length)


def check_samples(count: float) -> None:
    """Refuse more samples than memory should hold."""
    if not count <= _MOST_SAMPLES:
        raise InvalidValueError(
            "the response would have {samples:.3g} samples, more than {limit:g}", samples=count, limit=_MOST_SAMPLES,
            hint="a shorter duration, please",
        )  # fmt: skip
