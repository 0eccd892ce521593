"""Function for the report of any result. One module per class of results provides the content."""

from collections.abc import Callable
from datetime import UTC, datetime
from inspect import Parameter, signature
from pathlib import Path
from typing import Any

from rocking import checks
from rocking.decision.assessment import BodyAssessment
from rocking.decision.prediction import Prediction
from rocking.dynamics.response import Response
from rocking.dynamics.restrained.response import RestrainedResponse
from rocking.errors import InvalidValueError
from rocking.identification import Identification
from rocking.reports._assessment import assessment_content
from rocking.reports._identification import identification_content, trials_content
from rocking.reports._predictions import prediction_content, validation_content
from rocking.reports.document import Content, write_report
from rocking.reports.response_document import response_content
from rocking.reports.restrained_document import restrained_content
from rocking.spec.identification import IdentifiedTrials
from rocking.spec.validation import FolderValidation
from rocking.tables import target_of

_CONTENTS: dict[type, Callable[..., Content]] = {
    Response: response_content,
    RestrainedResponse: restrained_content,
    BodyAssessment: assessment_content,
    Prediction: prediction_content,
    FolderValidation: validation_content,
    Identification: identification_content,
    IdentifiedTrials: trials_content,
}
"""Functions that return document and pictures, by class of the result."""


def report(result: Any, path: str | Path, *, name: str = "", date: str | None = None, **options: Any) -> Path:
    """Write the report of a result: verdict, pictures, tables, assumptions and method.

    Parameters
    ----------
    result : Response, RestrainedResponse, BodyAssessment, Prediction, FolderValidation, Identification or \
IdentifiedTrials
        Result of `rocking.simulate` or `rocking.free_rocking` without friction, of `rocking.assess`,
        `rocking.predict` or `rocking.identify`, or of the commands for folders of trials.
    path : str or Path
        A document (.pdf), or a web page of one file (.html).
    name : str
        Name of the body.
    date : str, optional
        Printed date of the report. The default is today; an empty text means no date.
    **options
        For a response without restraints ``friction``, the coefficient of friction compared with the friction demand
        [-]. For an assessment ``project`` and ``author``, printed at the top and at the signature.

    Returns
    -------
    Path
        The written file.

    Raises
    ------
    InvalidValueError
        If the class has no report, an option is unknown, there is no result, or the extension is not allowed.
    MissingExtraError
        If matplotlib, or typst (.pdf) or jinja2 (.html), is not installed.

    Examples
    --------
    >>> import tempfile
    >>> import rocking as rk
    >>> response = rk.free_rocking(rk.Block(width=0.5, height=2.0), rotation=0.1, restitution="ked")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     page = report(response, f"{folder}/response.html", name="Column 4", friction=0.5)
    ...     page.name, "Column 4" in page.read_text(encoding="utf-8")
    ('response.html', True)
    """
    make_content = next((content for kind, content in _CONTENTS.items() if isinstance(result, kind)), None)
    if make_content is None:
        kinds = ", ".join(kind.__name__ for kind in _CONTENTS)
        raise InvalidValueError(parameter="result", allowed=f"one of {kinds}", value=result)
    target = target_of(path)
    keywords = [
        parameter
        for parameter in signature(make_content).parameters.values()
        if parameter.kind is Parameter.KEYWORD_ONLY
    ]
    names = [parameter.name for parameter in keywords]
    if unknown := next((parameter for parameter in options if parameter not in names), None):
        subject = type(result).__name__
        raise InvalidValueError(
            "unknown option {option!r} of a report of {subject}; allowed: {names}", subject=subject, option=unknown,
            names=", ".join(names), hint=checks.nearest(unknown, names),
        )  # fmt: skip
    day = f"{datetime.now(UTC):%d %B %Y}" if date is None else date
    document, pictures = make_content(result, name=name, date=day, **options)
    write_report(document, pictures, target)
    return target
