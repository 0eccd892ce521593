"""Reports: one content, rendered as HTML, PDF and tables."""

from typing import TYPE_CHECKING

from rocking.lazy import exports

if TYPE_CHECKING:
    from rocking.reports._report import report as report
    from rocking.reports.document import Document as Document
else:
    __all__, __getattr__, __dir__ = exports(__name__)
