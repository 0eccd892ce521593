"""The output folder of an inventory: HTML, PDF, spreadsheet, CSV, JSON, and thumbnails of the photos."""

import json
import warnings
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rocking.decision.inventory.assessment import Assessment
from rocking.decision.inventory.lights import LIGHT_NAMES, Light
from rocking.decision.inventory.ranking import (
    COLUMNS,
    PLAN_NOTE,
    answer_of,
    as_csv,
    header,
    limits,
    plan_header,
    plan_row,
    rows,
    stated,
    words_of,
)
from rocking.errors import InvalidValueError, MissingExtraError, extra
from rocking.motions.summary import provenance_rows, summaries_of
from rocking.reports.document import render_pdf, write_html
from rocking.reports.inventory_document import GLANCE, MOST_DRAWN, SHARES, inventory_document
from rocking.tables import escaped
from rocking.tables.table import writing, written_whole

STEM = "inventory"  # name of the files, without suffix

FILLS = {Light.GREEN: "C6E7D6", Light.AMBER: "FFE3A3", Light.RED: "F6C1BC", None: "E3E6EA"}
"""Background colour of a rating. The cell contains the word of the rating."""

MOST_BYTES, MOST_PIXELS = 64 << 20, 100_000_000
"""Limits of a photo. Larger photos are ignored and not decoded."""

SIDE = 240  # largest side of a thumbnail [pixels]
_FORMATS = ("JPEG", "PNG", "WEBP", "TIFF", "GIF", "BMP")
_WIDTHS = {"number": 18, "name": 28, "words": 70, "advice": 70, "note": 28, "rating": 14, "remarks": 40}


def thumbnails(assessment: Assessment, folder: Path) -> dict[int, str]:
    """Write thumbnails. Return their file names by index of the object; empty for unreadable photos."""
    names = {}
    for index, verdict in enumerate(assessment.verdicts):
        if verdict.item.photo is not None:
            name = f"photo-{index}.jpg"
            names[index] = name if _thumbnail(verdict.item.photo, folder / name) else ""
    return names


def _thumbnail(photo: Path, path: Path) -> bool:
    """Write a thumbnail of a file with any content. Return True if the thumbnail was written."""
    try:
        image, ops = extra("PIL.Image", "thumbnails"), extra("PIL.ImageOps", "thumbnails")
        if not photo.is_file() or photo.stat().st_size > MOST_BYTES:
            return False
        with warnings.catch_warnings(action="ignore"), image.open(photo, formats=_FORMATS) as opened:
            if opened.width * opened.height > MOST_PIXELS:
                return False
            opened.draft("RGB", (2 * SIDE, 2 * SIDE))
            small = ops.exif_transpose(opened).convert("RGB")
            small.thumbnail((SIDE, SIDE))
            small.save(path, "JPEG", quality=80)
    except Exception:  # noqa: BLE001 - decoders of damaged pictures raise anything, and no photo may fail a report
        return False
    return True


def write_inventory(assessment: Assessment, folder: Path) -> tuple[list[Path], list[str]]:
    """Write an assessment in all formats. Return the files, and messages on missing libraries."""
    with writing(f"to {folder}"):
        folder.mkdir(parents=True, exist_ok=True)
    written: list[Path] = []
    left_out: list[str] = []
    for suffix in _WRITERS:
        try:
            written.append(_write_whole(assessment, folder / f"{STEM}.{suffix}"))
        except MissingExtraError as error:
            left_out.append(str(error))
    return written, left_out


def write_inventory_file(assessment: Assessment, path: Path) -> Path:
    """Write an assessment in one format. After an error, no incomplete file remains."""
    check_form(path)
    return _write_whole(assessment, path)


def check_form(path: Path) -> None:
    """Raise an error if the extension of a file is not allowed for an inventory."""
    if _form(path) not in _WRITERS:
        forms = ", ".join(f".{suffix}" for suffix in _WRITERS)
        raise InvalidValueError(
            "unknown extension {ending!r:.40}; an inventory can be written as {endings}",
            endings=forms,
            ending=path.suffix,
        )


def _form(path: Path) -> str:
    return path.suffix.lower().removeprefix(".")


def _write_whole(assessment: Assessment, path: Path) -> Path:
    with writing(path), written_whole(path) as unfinished:
        _WRITERS[_form(path)](assessment, unfinished)
    return path


def inventory_json(assessment: Assessment) -> str:
    """Return an assessment as one JSON object in SI units."""
    return json.dumps(answer_of(assessment).plain(), indent=2, allow_nan=False, ensure_ascii=False)


def _document(assessment: Assessment, path: Path) -> None:
    write = render_pdf if _form(path) == "pdf" else write_html
    # the renderer temporarily writes its source into the folder of the pictures, which is not the folder of the user
    with TemporaryDirectory() as name:
        folder = Path(name)
        document = inventory_document(assessment, thumbnails(assessment, folder), _drawn(assessment, folder))
        write(document, folder, path)


def _drawn(assessment: Assessment, folder: Path) -> list[str]:
    """Draw the pictures at the top of the report. Return their stems; empty if there are no objects."""
    from rocking.plots.inventory import inventory_distribution, inventory_picture
    from rocking.plots.style import write

    count = len(assessment.verdicts)
    try:
        with warnings.catch_warnings():
            # the text of the SVG may be in any script, and uses the fonts of the reader
            warnings.filterwarnings("ignore", "Glyph .* missing from font")
            if count:
                write(inventory_picture(assessment, MOST_DRAWN), folder / f"{GLANCE}.svg")
            if count > MOST_DRAWN:
                write(inventory_distribution(assessment), folder / f"{SHARES}.svg")
        return [stem for stem in (GLANCE, SHARES) if (folder / f"{stem}.svg").exists()]
    except MissingExtraError:  # the report is complete without pictures
        return []


def _csv(assessment: Assessment, path: Path) -> None:
    # Excel reads UTF-8 only with a byte order mark
    path.write_text(as_csv(assessment), encoding="utf-8-sig", newline="")


def write_spreadsheet(assessment: Assessment, path: Path) -> None:
    """Write the table as an Excel workbook: the ranking, the plan of measures, and the assumptions."""
    book, say = extra("openpyxl", "the spreadsheet").Workbook(), words_of(assessment)
    sheet = book.active
    sheet.title = say("Ranking")
    titles = header(say)[: len(COLUMNS)]
    _fill(sheet, [titles, *(item[: len(COLUMNS)] for item in rows(assessment, say.code))])
    lights = [item.light for item in assessment.verdicts]
    _dress(sheet, [_WIDTHS.get(name, 12) for name in COLUMNS])
    _colour(sheet, [*lights, *[None] * (len(assessment.not_assessed) + len(assessment.not_objects))])
    plan = book.create_sheet(say("Measures"))
    _fill(plan, [
        [say("inventory number"), say("name"), *plan_header(say)],
        *([escaped(item.item.number), escaped(item.item.name), *plan_row(item, say)] for item in assessment.plan),
    ])  # fmt: skip
    _dress(plan, [18, 28, *[16] * len(plan_header(say))])
    about = book.create_sheet(say("Explanation"))
    meaning = assessment.thresholds.sentences(say.code).items()
    hazard = assessment.hazard
    shaking = f"{hazard.words(say.code)}; {say(hazard.source)}"
    facts = [[say("ground motions"), shaking], [say("restitution model"), assessment.restitution]]
    sources = [] if hazard.synthetic else provenance_rows(summaries_of(hazard.motions))
    facts += [[escaped(f"{say('ground motions')}: {name}"), escaped(text)] for name, text in sources]
    if assessment.ignored:
        facts.append([say("ignored"), say("columns of the list: {columns}", columns=", ".join(assessment.ignored))])
    if text := stated(assessment):
        facts.append(["", text])
    _fill(about, [
        *([say(LIGHT_NAMES[light]), text] for light, text in meaning),
        *(["", item] for item in assessment.thresholds.conventions(say.code)),
        *facts,
        [say("Measures"), say(PLAN_NOTE)],
        *([say("not covered"), item] for item in limits(assessment)),
    ])  # fmt: skip
    about.column_dimensions["A"].width, about.column_dimensions["B"].width = 14, 110
    buffer = BytesIO()  # on a full disk, openpyxl would raise a second error after the file was closed
    book.save(buffer)
    path.write_bytes(buffer.getvalue())


def _fill(sheet: Any, lines: list[list[Any]]) -> None:
    for i, line in enumerate(lines, start=1):
        for k, value in enumerate(line, start=1):
            cell = sheet.cell(row=i, column=k)
            if isinstance(value, str):
                # the value is a string, never a formula; control characters cannot be stored
                cell.value = "".join(character for character in value if character.isprintable()) or None
                cell.data_type = "s" if cell.value is not None else "n"
            else:
                cell.value = value


def _dress(sheet: Any, widths: list[int]) -> None:
    styles = extra("openpyxl.styles", "the spreadsheet")
    for k, width in enumerate(widths, start=1):
        for i in range(1, sheet.max_row + 1):
            sheet.cell(row=i, column=k).alignment = styles.Alignment(wrap_text=True, vertical="top")
        head = sheet.cell(row=1, column=k)
        head.font = styles.Font(bold=True)
        sheet.column_dimensions[head.column_letter].width = width
    sheet.freeze_panes = "E2" if len(widths) == len(COLUMNS) else "C2"
    sheet.auto_filter.ref = sheet.dimensions


def _colour(sheet: Any, lights: list[Light | None]) -> None:
    styles = extra("openpyxl.styles", "the spreadsheet")
    for i, light in enumerate(lights, start=2):
        cell = sheet.cell(row=i, column=COLUMNS.index("rating") + 1)
        cell.fill = styles.PatternFill("solid", start_color=FILLS[light])


_WRITERS: dict[str, Callable[[Assessment, Path], object]] = {
    "html": _document,
    "pdf": _document,
    "xlsx": write_spreadsheet,
    "csv": _csv,
    "json": lambda assessment, path: path.write_text(inventory_json(assessment) + "\n", encoding="utf-8"),
}
