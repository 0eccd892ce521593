"""Reports: one content, rendered as HTML, PDF and tables."""

from typing import TYPE_CHECKING

from rocking.lazy import exports
from rocking.reports.document import Document

if TYPE_CHECKING:
    from rocking.reports._response_report import response_report

__all__ = ["Document", "response_report"]

__getattr__, __dir__ = exports("rocking.reports", {"response_report": "rocking.reports._response_report"})
