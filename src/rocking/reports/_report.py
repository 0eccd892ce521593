"""One call for the report of every answer; what stands in it is the matter of the module of its kind."""

from importlib import import_module
from pathlib import Path
from typing import Any

from rocking.errors import InvalidValueError
from rocking.reports.document import write_report
from rocking.tables import target_of

_CONTENTS = {
    "Response": "response_document:response_content",
    "BodyAssessment": "_assessment:assessment_content",
    "Prediction": "_predictions:prediction_content",
    "FolderValidation": "_predictions:validation_content",
    "Identification": "_identification:identification_content",
    "IdentifiedTrials": "_identification:trials_content",
}
"""What makes the document and its pictures, by the class of an answer."""


def report(found: Any, path: str | Path, *, name: str = "", date: str = "", **options: Any) -> Path:
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
    date : str
        Day of the report, as it should be printed.
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
        If there is no report of such an answer, it has no result, or the ending of the path is another.
    MissingExtraError
        If matplotlib, and typst (.pdf) or jinja2 (.html), are not installed.
    """
    homes = [_CONTENTS[each.__name__] for each in type(found).__mro__ if each.__name__ in _CONTENTS]
    if not homes:
        raise InvalidValueError(f"found must be one of {', '.join(_CONTENTS)}, got {found!r:.60}")
    target = target_of(path)
    module, _, content = homes[0].partition(":")
    made = getattr(import_module(f"{__package__}.{module}"), content)
    document, pictures = made(found, name=name, date=date, **options)
    write_report(document, pictures, target)
    return target
