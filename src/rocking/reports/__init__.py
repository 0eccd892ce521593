"""Reports: one content, rendered as HTML, PDF and tables."""

from typing import TYPE_CHECKING

from rocking.lazy import exports
from rocking.reports.document import Document

if TYPE_CHECKING:
    from rocking.reports._assessment import assessment_report
    from rocking.reports._identification import identification_report
    from rocking.reports._predictions import prediction_report, validation_report
    from rocking.reports.response_document import response_report

__all__ = [
    "Document",
    "assessment_report",
    "identification_report",
    "prediction_report",
    "response_report",
    "validation_report",
]

__getattr__, __dir__ = exports(
    "rocking.reports",
    {
        "assessment_report": "rocking.reports._assessment",
        "identification_report": "rocking.reports._identification",
        "prediction_report": "rocking.reports._predictions",
        "response_report": "rocking.reports.response_document",
        "validation_report": "rocking.reports._predictions",
    },
)
