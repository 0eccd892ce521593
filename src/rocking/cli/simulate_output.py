"""What `rocking simulate` computes, writes and draws."""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rocking.cli.simulate_question import Question, restitution_from
from rocking.dynamics.exportable import Exportable
from rocking.dynamics.response import Response
from rocking.errors import InvalidValueError, MissingExtraError, RockingError
from rocking.evidence._coefficient_table import default_models
from rocking.outcome import Outcome


@dataclass(frozen=True, slots=True)
class ResponseComparison:
    """A response, and what the other models of impact make of the same question."""

    response: Response  # with the restitution asked for
    friction: float  # coefficient of friction between body and ground [-]
    others: dict[str, Response | str]  # by model: the response, or why the model has none for this body

    @classmethod
    def of(cls, question: Question, restitution: str) -> "ResponseComparison":
        """Compute the response, and what every model that needs no value makes of the same question."""
        response = _computed(question, restitution_from(restitution))
        rivals = {model.label: model for model in default_models() if model.label != response.rocker.label}
        return cls(response, question.friction, {name: _tried(question, model) for name, model in rivals.items()})

    @classmethod
    def of_choices(cls, question: Question) -> "ResponseComparison":
        """Compute the response with the first restitution of a question, and with all others that it lists."""
        (_, first), *rest = question.choices.items()
        response = _computed(question, first)
        return cls(response, question.friction, {name: _tried(question, choice) for name, choice in rest})


def _computed(question: Question, restitution: Any) -> Response:
    response = question.answered_with(restitution)
    if response.outcome is Outcome.FAILED:
        raise RockingError(f"there is no response: {response.status.value}")
    return response


def _tried(question: Question, restitution: Any) -> Response | str:
    try:
        return question.answered_with(restitution)
    except InvalidValueError as error:
        return str(error)


@dataclass(frozen=True, slots=True)
class ResponseFiles:
    """Files to write."""

    picture: Path | None  # picture, animation, csv, mat, netcdf: where each goes, if it was asked for
    animation: Path | None
    csv: Path | None
    mat: Path | None
    netcdf: Path | None

    def __post_init__(self) -> None:
        """Refuse before anything is computed."""
        if self.animation is not None and self.animation.suffix.lower() not in {".html", ".gif"}:
            raise RockingError(f"an animation is .html or .gif, got {self.animation.name!r}")

    def write(self, answer: ResponseComparison) -> list[Path]:
        """Write what was asked for."""
        written = self.written(answer.response, lambda: _drawn(answer))
        if self.animation is not None:
            _animate(answer.response, self.animation)
        return written

    def written(self, response: Exportable, drawn: Callable[[], Any]) -> list[Path]:
        """Write the picture and the samples of any kind of response.

        Returns the files, the animation among them, which only the pure rocking response has.
        """
        if self.picture is not None:
            from rocking.plots.style import write

            write(drawn(), self.picture)
        exports = (self.csv, response.to_csv), (self.mat, response.to_mat), (self.netcdf, response.to_netcdf)
        for path, export in exports:
            if path is not None:
                _export(export, path)
        return [path for path in (self.picture, self.animation, self.csv, self.mat, self.netcdf) if path is not None]


def _drawn(answer: ResponseComparison) -> Any:
    from rocking.plots.response import response_picture

    return response_picture(answer.response, answer.friction)


def _export(export: Callable[[Path], object], path: Path) -> None:
    try:
        export(path)
    except MissingExtraError:
        raise
    except ImportError as error:
        # some libraries only notice when they write that one of theirs is not there
        raise MissingExtraError(f"cannot write {path}: {error}") from error


def _animate(response: Response, path: Path) -> None:
    from rocking.plots.animation import animate_gif, animate_html, slowest_speed

    if path.suffix.lower() == ".html":
        animate_html(response, path)
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True, disable=not sys.stderr.isatty()) as progress:
        task = progress.add_task("frames")
        animate_gif(
            response,
            path,
            speed=slowest_speed(response),
            progress=lambda done, total: progress.update(task, completed=done, total=total),
        )
