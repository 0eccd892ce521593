from ._report import report as report
from .document import Document as Document
