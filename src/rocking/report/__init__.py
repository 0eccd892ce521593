"""Reports: one content, rendered as HTML, PDF and tables."""

from rocking.report.document import Document

__all__ = ["Document"]
