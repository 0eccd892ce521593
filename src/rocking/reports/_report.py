"""One call for the report of every answer; what stands in it is the matter of the module of its kind."""

from collections.abc import Callable
from datetime import UTC, datetime
from inspect import Parameter, signature
from pathlib import Path
from typing import Any

from rocking import checks
from rocking.assessment import BodyAssessment
from rocking.dynamics.response import Response
from rocking.errors import InvalidValueError
from rocking.identification import Identification
from rocking.prediction import Prediction
from rocking.reports._assessment import assessment_content
from rocking.reports._identification import identification_content, trials_content
from rocking.reports._predictions import prediction_content, validation_content
from rocking.reports.document import Content, write_report
from rocking.reports.response_document import response_content
from rocking.spec.identification import IdentifiedTrials
from rocking.spec.validation import FolderValidation
from rocking.tables import target_of

_CONTENTS: dict[type, Callable[..., Content]] = {
    Response: response_content,
    BodyAssessment: assessment_content,
    Prediction: prediction_content,
    FolderValidation: validation_content,
    Identification: identification_content,
    IdentifiedTrials: trials_content,
}
"""What makes the document and its pictures, by the class of an answer."""


def report(found: Any, path: str | Path, *, name: str = "", date: str | None = None, **options: Any) -> Path:
    """Write the report of an answer: verdict, pictures, tables, what was assumed, and how it was computed.

    Parameters
    ----------
    found : Response, BodyAssessment, Prediction, FolderValidation, Identification or IdentifiedTrials
        Of `rocking.simulate` or `rocking.free_rocking` without friction, `rocking.assess`, `rocking.predict`,
        `rocking.identify`, or as ``rocking validate`` and ``rocking identify`` find it of a folder.
    path : str or Path
        A document (.pdf), or a web page of one file (.html).
    name : str
        What the body is called.
    date : str, optional
        Day of the report, as it should be printed; today if not given, none if empty.
    **options
        Of a response ``friction``, the coefficient that the friction that is taken is compared with [-]; of an
        assessment ``project`` and ``author``, which stand at its head and beside the signature.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidValueError
        If there is no report of such an answer, it takes no such option, it has no result, or the ending of the path
        is another.
    MissingExtraError
        If matplotlib, and typst (.pdf) or jinja2 (.html), are not installed.

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
    made = next((content for kind, content in _CONTENTS.items() if isinstance(found, kind)), None)
    if made is None:
        kinds = ", ".join(kind.__name__ for kind in _CONTENTS)
        raise InvalidValueError(parameter="found", allowed=f"one of {kinds}", value=found)
    target = target_of(path)
    known = [each for each in signature(made).parameters.values() if each.kind is Parameter.KEYWORD_ONLY]
    names = [each.name for each in known]
    if odd := next((each for each in options if each not in names), None):
        of = type(found).__name__
        raise InvalidValueError(
            "a report of {subject} takes no {option}; it takes {names}", subject=of, option=odd, names=", ".join(names),
            hint=checks.nearest(odd, names),
        )  # fmt: skip
    day = f"{datetime.now(UTC):%d %B %Y}" if date is None else date
    document, pictures = made(found, name=name, date=day, **options)
    write_report(document, pictures, target)
    return target
