"""The ranked table of an inventory as a spreadsheet."""

from io import BytesIO
from pathlib import Path
from typing import Any

from rocking.errors import extra
from rocking.studies.inventory.assessment import Assessment
from rocking.studies.inventory.table import HEADER, LIMITS, rows

FILLS = {"G": "C6E7D6", "A": "FFE3A3", "R": "F6C1BC", "n": "E3E6EA"}
"""Background of a light by the first letter of its words; the words stand in the cell."""

_WIDTHS = {"name": 28, "in words": 70, "what to do": 70, "note": 28, "light": 14}


def write_spreadsheet(assessment: Assessment, path: Path) -> None:
    """Write the table as an Excel workbook: the ranking, and the assumptions on a second sheet."""
    book = extra("openpyxl", "the spreadsheet").Workbook()
    sheet = book.active
    sheet.title = "Ranking"
    _fill(sheet, [list(HEADER), *rows(assessment)])
    _dress(sheet)
    about = book.create_sheet("What it means")
    lights = [[f"{light.value} {light.word}", words] for light, words in assessment.thresholds.sentences().items()]
    hazard = assessment.hazard
    facts = [["shaking", f"{hazard.words()}; {hazard.source}"], ["impacts", assessment.restitution]]
    if assessment.ignored:
        facts.append(["not read", f"columns of the list: {', '.join(assessment.ignored)}"])
    _fill(about, [*lights, *facts, *(["not covered", each] for each in LIMITS)])
    about.column_dimensions["A"].width, about.column_dimensions["B"].width = 14, 110
    whole = BytesIO()  # a workbook that a full disk cuts off complains for long after it was closed
    book.save(whole)
    path.write_bytes(whole.getvalue())


def _fill(sheet: Any, lines: list[list[Any]]) -> None:
    for i, line in enumerate(lines, start=1):
        for k, value in enumerate(line, start=1):
            place = sheet.cell(row=i, column=k)
            if isinstance(value, str):
                # as a string whatever it begins with; control characters cannot be stored
                place.value = "".join(each for each in value if each.isprintable()) or None
                place.data_type = "s" if place.value is not None else "n"
            else:
                place.value = value


def _dress(sheet: Any) -> None:
    styles = extra("openpyxl.styles", "the spreadsheet")
    for k, title in enumerate(HEADER, start=1):
        head = sheet.cell(row=1, column=k)
        head.font = styles.Font(bold=True)
        head.alignment = styles.Alignment(wrap_text=True, vertical="top")
        sheet.column_dimensions[head.column_letter].width = _WIDTHS.get(title, 12)
    light = HEADER.index("light") + 1
    for i in range(2, sheet.max_row + 1):
        colour = FILLS[str(sheet.cell(row=i, column=light).value)[0]]
        sheet.cell(row=i, column=light).fill = styles.PatternFill("solid", start_color=colour)
        for k in range(1, len(HEADER) + 1):
            sheet.cell(row=i, column=k).alignment = styles.Alignment(wrap_text=True, vertical="top")
    sheet.freeze_panes = "D2"
    sheet.auto_filter.ref = sheet.dimensions
