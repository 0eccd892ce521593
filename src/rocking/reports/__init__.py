"""Reports: one content, rendered as HTML, PDF and tables."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.reports._assessment import assessment_report as assessment_report
    from rocking.reports._identification import identification_report as identification_report
    from rocking.reports._predictions import prediction_report as prediction_report
    from rocking.reports._predictions import validation_report as validation_report
    from rocking.reports.document import Document as Document
    from rocking.reports.response_document import response_report as response_report
else:
    __all__, __getattr__, __dir__ = exports(__name__)
