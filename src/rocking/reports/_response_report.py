"""The report of a response that was computed in Python, with its pictures."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from rocking import checks
from rocking.conventions import DEFAULT_FRICTION, Assumed
from rocking.dynamics.response import Response
from rocking.errors import InvalidValueError
from rocking.outcome import Outcome
from rocking.plots.body import body_picture, coefficient_picture
from rocking.plots.ground_motion import ground_motion_picture
from rocking.plots.response import response_picture
from rocking.plots.traces import fine_samples
from rocking.reports.body_facts import ImpactAnswer
from rocking.reports.motion_facts import measures_of
from rocking.reports.render import write_report
from rocking.reports.response_document import ReportResults, ReportSubject, response_document
from rocking.tables import target_of


def response_report(
    response: Response, path: str | Path, *, name: str = "", date: str = "", friction: float = DEFAULT_FRICTION
) -> Path:
    """Write the report of a response: the body, what an impact costs it, the ground, the response, with pictures.

    Parameters
    ----------
    response : Response
        Of `rocking.simulate` or `rocking.free_rocking`, without friction.
    path : str or Path
        A document (.pdf), or a web page of one file (.html).
    name : str
        What the body is called.
    date : str
        Day of the report, as it should be printed.
    friction : float
        Coefficient of friction between body and ground, which the friction that is taken is compared with [-].

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidValueError
        If the ending of the path is another.
    MissingExtraError
        If matplotlib, and typst (.pdf) or jinja2 (.html), are not installed.
    """
    path = target_of(path)
    if response.outcome is Outcome.FAILED:
        raise InvalidValueError(f"a report needs a result: {response.summary}")
    friction = friction if isinstance(friction, Assumed) else checks.positive("friction", friction)
    gravity = response.settings.gravity
    impact = ImpactAnswer.of(response.body, None, onto="both", gravity=gravity, identities=False)
    motion = (
        response.motion if response.motion is None or response.scale == 1.0 else response.motion.scaled(response.scale)
    )
    measures = {} if motion is None or response.scale == 0.0 else measures_of(motion, fine_samples(motion))
    results = ReportResults(impact, motion, measures, {response.parameters.label: response}, {}, friction)
    document = response_document(ReportSubject(name, date), results)
    pictures: dict[str, Callable[[], Any]] = {
        "body": lambda: body_picture(response.body),
        "coefficients": lambda: coefficient_picture(response.body, impact.tables),
        "response": lambda: response_picture(response, friction),
    }
    if motion is not None:
        pictures["motion"] = lambda: ground_motion_picture(motion)
    write_report(document, pictures, path)
    return path
