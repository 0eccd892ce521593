"""Tables as files: comma-separated values, Excel, MATLAB, netCDF."""

from rocking.app.takeaway.sheets.sheet import Column, Sheet
from rocking.app.takeaway.sheets.writing import MEDIA_TYPES, written

__all__ = ["MEDIA_TYPES", "Column", "Sheet", "written"]
