"""Reports: one content, rendered as HTML, PDF and tables."""

from rocking.reports.document import Document

__all__ = ["Document"]
