"""Base class of the responses of all mechanics (outcome, texts, files), and functions for the duration of motions."""

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
from rocking.messages import Message, listed
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
    """Return the provenance of a motion as text."""
    return "ground at rest" if motion is None else listed(provenance_of(motion))


_ROUNDING = 1e-9


def interval_rows(intervals: Sequence[tuple[Any, ...]], *names: str) -> AnswerRows:
    """Return a table of intervals with constant contact. `names` are the columns after start and end."""
    columns = zip(*intervals, strict=True) if intervals else [()] * (2 + len(names))
    return AnswerRows(dict(zip(("start", "end", *names), columns, strict=True)))


class ResponseBase(Exported):
    """Response of one body, with outcome, text, picture and export."""

    _blank = False

    settings: Settings
    trajectory: Any  # result of the engine: outcome, status, overturning_time, still_rocking, engine

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.summary} [{self.engine}]>"

    @property
    def outcome(self) -> Outcome:
        """Outcome of the response."""
        outcome: Outcome = self.trajectory.outcome
        return outcome

    @property
    def status(self) -> Status:
        """Status of the computation."""
        status: Status = self.trajectory.status
        return status

    @property
    def engine(self) -> str:
        """Name of the engine, with its method."""
        engine: str = self.trajectory.engine
        return engine

    @property
    def overturning_time(self) -> float:
        """Time of the last passage of the centre of mass over the contact [s]; NaN without overturning."""
        return float(self.trajectory.overturning_time)

    @property
    def still_rocking(self) -> bool:
        """True if the body has not overturned and still moves at the end. `impacts` excludes later impacts."""
        return bool(self.trajectory.still_rocking)

    @property
    def unfinished(self) -> str:
        """Sentence about a motion that continues at the end of the response; empty if the body is at rest."""
        if not self.still_rocking:
            return ""
        doing, end, state = self._last_motion
        unfinished = Message(
            "the body is still {activity} at the end of the computation, {time:.4g} s, {state}; later impacts are not "
            "counted",
            {"activity": Message(doing), "time": end, "state": state},
        )
        return Message.followed(unfinished, self._end_reason)

    @property
    def _end_reason(self) -> str:
        """Reason why the body still moves at the end of the response; empty if the reason is the duration."""
        return "no impact loses energy, so that the body never comes to rest" if self._never_rests else ""

    @property
    def _never_rests(self) -> bool:
        """True if impacts lose no energy."""
        return False

    @property
    def summary(self) -> str:
        """The outcome in one sentence. The sentence includes a motion that continues at the end."""
        if self.outcome is Outcome.FAILED:
            return Message("{outcome}: {reason}", {"outcome": self.outcome.value, "reason": self.status.value})
        return Message.followed(self._ending, self.unfinished)

    @property
    @abstractmethod
    def _ending(self) -> str:
        """The outcome of a successful computation in one sentence."""

    @property
    @abstractmethod
    def _last_motion(self) -> tuple[str, float, str]:
        """Description of the motion at the end of the response, time of the end [s], and state."""

    @property
    @abstractmethod
    def _samples(self) -> dict[str, FloatArray]:
        """Histories over `time`, by name in `rocking.quantities`."""

    @property
    @abstractmethod
    def _tables(self) -> dict[str, AnswerRows]:
        """Tables of impacts, and of intervals with constant contact."""

    @property
    @abstractmethod
    def _facts(self) -> dict[str, Any]:
        """Inputs and provenance as plain values, without software, engine, outcome and settings."""

    def answer(self) -> Answer:
        """Return outcome, peaks and energy, with units.

        Returns
        -------
        Answer
            Engine, outcome, peaks, energy, and tables of impacts and contacts.
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
        """Results that exist only in this mechanics."""

    @property
    @abstractmethod
    def _last_state(self) -> dict[str, Any]:
        """State of the body at the end of the response."""

    def plot(self, path: str | Path | None = None, **options: Any) -> "Figure":
        """Draw the response.

        Parameters
        ----------
        path : str or Path, optional
            File for the picture: .png, .svg or .pdf.
        **options
            Options of the picture in `rocking.plots`: `friction` for a response without friction.

        Returns
        -------
        matplotlib.figure.Figure
            The picture.

        Raises
        ------
        MissingExtraError
            If matplotlib is not installed.
        RockingError
            If the path has another extension.
        """
        from rocking.plots import write

        figure = self._plot(**options)
        if path is not None:
            write(figure, Path(path))
        return figure

    @abstractmethod
    def _plot(self, **options: Any) -> "Figure":
        """Draw the picture of this kind of response."""

    def exported(self) -> "Table":
        """Return the table of samples, with tables of impacts and intervals."""
        from rocking.tables import Table

        outcome = {
            "software": SOFTWARE, "engine": self.engine, "outcome": self.outcome.name, "status": self.status.name,
            "still_rocking": self.still_rocking, "summary": self.summary,
        }  # fmt: skip
        settings = {f"setting_{name}": value for name, value in self.settings.integration.items()}
        details = {name.removesuffix("s"): rows.arrays for name, rows in self._tables.items()}
        tables = {row: Table.of(row, arrays) for row, arrays in details.items()}
        provenance = with_units(outcome | self._facts | settings)
        return Table.of("time", self._samples, provenance=provenance, related=tables, no_unit="-")

    def animate(self, path: str | Path, **options: Any) -> Path:
        """Write an animation of the response.

        Parameters
        ----------
        path : str or Path
            A web page in one file (.html), or a film (.gif).
        **options
            Options of a film, `rocking.plots.animate_gif`: fps, speed, progress.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        InvalidValueError
            If the path has another extension, or the mechanics has no animation.
        MissingExtraError
            If matplotlib is not installed (films need it).
        """
        from rocking.plots import animate_gif, animate_html

        suffix = Path(path).suffix.lower()
        if suffix not in {".html", ".gif"}:
            raise InvalidValueError(
                "an animation must be .html or .gif, got {value}", parameter="path", value=Path(path).name
            )
        if suffix == ".html" and options:
            raise InvalidValueError(
                "{options} can be used with films (.gif) only; a page (.html) has its own controls",
                options=", ".join(options),
            )
        response: Any = self
        return animate_html(response, path) if suffix == ".html" else animate_gif(response, path, **options)

    def report(self, path: str | Path, **options: Any) -> Path:
        """Write a report with pictures: body, energy loss at impact, ground motion, response, restraints.

        Parameters
        ----------
        path : str or Path
            A document (.pdf), or a web page in one file (.html).
        **options
            Options of `rocking.reports.report`: name, date; friction for a response without friction and restraints.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        InvalidValueError
            If the path has another extension, or the mechanics has no report.
        MissingExtraError
            If matplotlib, and typst or jinja2, are not installed.
        """
        from rocking.reports import report

        return report(self, path, **options)

    def _times_within(self, time: Any, end: float) -> FloatArray:
        """Return times between 0 and an end [s]. Raise an error if a time is outside by more than rounding."""
        times = checks.real_array("time", time, "s")
        bad = times[~((times >= -_ROUNDING * end) & (times <= (1.0 + _ROUNDING) * end))]
        if bad.size:
            raise InvalidValueError(
                "time must be in [0, {end:g}] s, the duration of the response, got {time:g}", end=end, time=bad[0]
            )
        return np.clip(times, 0.0, end)


_MAX_SAMPLES = 2_000_000


def max_duration(step: float) -> float:
    """Return the longest duration of a response with a step [s]."""
    return _MAX_SAMPLES * step


def ground_at_rest(step: float, length: float) -> Segments:
    """Return ground at rest for a length [s], in steps [s]."""
    check_samples(length / step)
    return Segments.still(step, max(1, math.ceil(length / step - 1e-9)))


def followed(segments: Segments, length: float, parts: int, motion: Motion) -> Segments:
    """Return a motion, cut or extended by rest to a length [s]. `parts` subdivides the segments of a pulse."""
    if isinstance(motion, Pulse):
        segments = segments.refined(parts)
    check_samples(length / segments.step)
    keep = max(1, math.ceil(length / segments.step - 1e-9))
    vertical = None if segments.vertical is None else segments.vertical[:keep]
    return Segments(segments.step, segments.horizontal[:keep], vertical).extended(length)


def check_samples(count: float) -> None:
    """Raise an error for more than two million samples."""
    if not count <= _MAX_SAMPLES:
        raise InvalidValueError(
            "the response would have {samples:.3g} samples, more than {limit:g}", samples=count, limit=_MAX_SAMPLES,
            hint="use a shorter duration",
        )  # fmt: skip
