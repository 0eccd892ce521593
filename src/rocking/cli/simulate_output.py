"""What `rocking simulate` computes, writes and draws."""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from rocking import checks
from rocking.cli.simulate_question import Question, restitution_from
from rocking.dynamics.outcome import Outcome
from rocking.dynamics.response import Response
from rocking.errors import InvalidValueError, MissingExtraError, RockingError
from rocking.evidence.coefficient_table import default_models


@dataclass(frozen=True, slots=True)
class Answer:
    """A response, and what the other models of impact make of the same question.

    Parameters
    ----------
    response : Response
        With the restitution asked for.
    friction : float
        Coefficient of friction between body and ground [-].
    others : dict of str to Response or str
        By model: the response, or why the model has none for this body.
    """

    response: Response
    friction: float
    others: dict[str, Response | str]

    @classmethod
    def of(cls, question: Question, restitution: str, friction: float) -> "Answer":
        """Compute the response and its rivals.

        Parameters
        ----------
        question : Question
            Body, motion, and how to compute.
        restitution : str
            Model or coefficient.
        friction : float
            Coefficient of friction between body and ground, above zero [-].

        Returns
        -------
        Answer
            Everything that is printed.

        Raises
        ------
        RockingError
            If the response could not be computed.
        """
        friction = checks.positive("--friction", friction)
        response = question.answered_with(restitution_from(restitution))
        if response.outcome is Outcome.FAILED:
            raise RockingError(f"there is no response: {response.status.value}")
        others: dict[str, Response | str] = {}
        for model in default_models():
            if model.label == response.rocker.label:
                continue
            try:
                others[model.label] = question.answered_with(model)
            except InvalidValueError as error:
                others[model.label] = str(error)
        return cls(response, friction, others)


@dataclass(frozen=True, slots=True)
class Files:
    """Files to write.

    Parameters
    ----------
    picture, animation, csv, mat, netcdf : Path, optional
        Where each goes, if it was asked for.

    Raises
    ------
    RockingError
        If no animation can have that suffix.
    """

    picture: Path | None
    animation: Path | None
    csv: Path | None
    mat: Path | None
    netcdf: Path | None

    def __post_init__(self) -> None:
        """Refuse before anything is computed."""
        if self.animation is not None and self.animation.suffix.lower() not in {".html", ".gif"}:
            raise RockingError(f"an animation is .html or .gif, got {self.animation.name!r}")

    def write(self, answer: Answer) -> list[Path]:
        """Write what was asked for.

        Parameters
        ----------
        answer : Answer
            What `Answer.of` computed.

        Returns
        -------
        list of Path
            The files.
        """
        response = answer.response
        if self.picture is not None:
            from rocking.plots.response import response_picture
            from rocking.plots.style import write

            write(response_picture(response, answer.friction), self.picture)
        if self.animation is not None:
            _animate(response, self.animation)
        exports = (self.csv, response.to_csv), (self.mat, response.to_mat), (self.netcdf, response.to_netcdf)
        for path, export in exports:
            if path is not None:
                _export(export, path)
        return [path for path in (self.picture, self.animation, self.csv, self.mat, self.netcdf) if path is not None]


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
