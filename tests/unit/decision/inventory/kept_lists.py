"""Lists as museums keep them, in five languages: invented objects below headers of one to three rows, as three forms.

Each list states what must come out beside what is written: the rows that are objects, and those that are none.
"""

# ruff: noqa: E501, RUF001 - rows of lists are one line; signs of other languages are meant

import csv
import io
import re
import zipfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape


@dataclass(frozen=True)
class KeptList:
    """A list: its rows, the cells that are merged, and what must come out."""

    language: str
    rows: list[str]  # cells parted by |; a row of no cell is blank
    objects: dict[int, tuple[str, str, float, float, float, int]]  # by row: number, name, width, depth, height, count
    merged: tuple[str, ...] = ()  # as a spreadsheet names them, A1:B2
    refused: tuple[int, ...] = ()  # rows of objects that cannot be assessed
    others: tuple[int, ...] = ()  # rows that are no objects
    only: tuple[str, ...] = ("xlsx", "ods", "csv")
    masses: dict[int, float] = field(default_factory=dict)  # by row [kg]
    bases: dict[int, tuple[float, float]] = field(default_factory=dict)  # by row [m]


LISTS = {
    # two rows, merged across and down; sums and a signature at the end
    "merged": KeptList(
        "de",
        [
            "Inv.-Nr.|Bezeichnung|Maße (cm)|||Gewicht (kg)|Anzahl|Bemerkung",
            "||Breite|Tiefe|Höhe|||",
            "A-17|Vase|20|20|60|4,5|1|Fuß restauriert",
            "A-18|Vase|22,5|21|62,5|5|1|",
            "A-19|Bodenuhr|45|28|210|38|1|geht nach",
            "A-20|Leuchter|18|18|95|3|2|",
            "Summe|||||50,5|5|",
            "",
            "Erstellt: 12.3.2024|||||||",
            "Datum, Unterschrift: ____________|||||||",
        ],
        {
            3: ("A-17", "Vase", 0.2, 0.2, 0.6, 1), 4: ("A-18", "Vase", 0.225, 0.21, 0.625, 1),
            5: ("A-19", "Bodenuhr", 0.45, 0.28, 2.1, 1), 6: ("A-20", "Leuchter", 0.18, 0.18, 0.95, 2),
        },
        ("C1:E1", "A1:A2", "B1:B2", "F1:F2", "G1:G2", "H1:H2"),
        others=(7, 9, 10),
        masses={3: 4.5, 5: 38.0},
    ),
    # three rows, letters, units in brackets, the base as a group of its own, and the pedestal, which is not the object
    "three rows": KeptList(
        "de",
        [
            "Landschaftsmuseum Beispielstadt|||||||||||",
            "Abteilung Skulptur und Kunsthandwerk, Bestand im Erdgeschoss|||||||||||",
            "",
            "Lfd.|Inventar-|Objekt|Objektmaße|||Standfläche||Sockel|Gewicht|Stk.|Anmerkung",
            "Nr.|Nr.||B|T|H|B|T|H|||",
            "|||[cm]|[cm]|[cm]|[cm]|[cm]|[cm]|[kg]||",
            "1|1932.4|Torso, Gips|52|38|96|40|30|80|61|1|",
            "2|1932.5 a|Relief|80|12|110|70|12|75|90|1|hängt sonst",
            "3|1940.1|Taubenpaar|24|20|33|||60|7|2|",
        ],
        {
            7: ("1932.4", "Torso, Gips", 0.52, 0.38, 0.96, 1), 8: ("1932.5 a", "Relief", 0.8, 0.12, 1.1, 1),
            9: ("1940.1", "Taubenpaar", 0.24, 0.2, 0.33, 2),
        },
        ("A1:L1", "A2:L2", "D4:F4", "G4:H4"),
        others=(1, 2),
        masses={7: 61.0},
        bases={7: (0.4, 0.3), 8: (0.7, 0.12)},
    ),
    # headings within, blank lines, a repeated header on each printed page, numbers of pages
    "pages": KeptList(
        "de",
        [
            "Inventarliste Möbel|||||",
            "Nr.|Gegenstand|Breite|Tiefe|Höhe|Stück",
            "||cm|cm|cm|",
            "Saal 3|||||",
            "M 1|Schrank|120|55|190|1",
            "M 2|Stuhl|45|45|98|6",
            "",
            "Saal 4 (Nordseite)|||||",
            "M 3|Standuhr|48,5|26|215|1",
            "Seite 1 von 2|||||",
            "Inventarliste Möbel|||||",
            "Nr.|Gegenstand|Breite|Tiefe|Höhe|Stück",
            "||cm|cm|cm|",
            "M 4|Spiegel||4|160|1",
            "M 5|Kommode|110|50|85|1",
            "Zwischensumme|||||10",
            "Gesamt|||||10",
        ],
        {
            5: ("M 1", "Schrank", 1.2, 0.55, 1.9, 1), 6: ("M 2", "Stuhl", 0.45, 0.45, 0.98, 6),
            9: ("M 3", "Standuhr", 0.485, 0.26, 2.15, 1), 15: ("M 5", "Kommode", 1.1, 0.5, 0.85, 1),
        },
        ("A1:F1", "A4:F4", "A8:F8"),
        refused=(14,),
        others=(1, 4, 8, 10, 11, 12, 13, 16, 17),
    ),
    # one column of all measures, their order stated beside the table
    "one column": KeptList(
        "de",
        [
            "Depot Süd|||",
            "Maßangaben: Breite x Tiefe x Höhe|||",
            "Objekt-Nr.|Titel|Maße in cm|Hinweis",
            "D7|Kiste, bemalt|40 x 30 x 120 cm|",
            "D8|Schale|35,5 x 35,5 x 12|gesprungen",
            "D9|Büste|45 × 32 × 78|",
        ],
        {
            4: ("D7", "Kiste, bemalt", 0.4, 0.3, 1.2, 1), 5: ("D8", "Schale", 0.355, 0.355, 0.12, 1),
            6: ("D9", "Büste", 0.45, 0.32, 0.78, 1),
        },
        others=(1, 2),
    ),
    # two languages
    "bilingual": KeptList(
        "de",
        [
            "Inv.-Nr. / N. inv.|Objekt / Oggetto|Breite / Larghezza (cm)|Tiefe / Profondità (cm)|Höhe / Altezza (cm)|Stück / Q.tà|Anmerkungen / Note",
            "K 101|Madonna|38|29,5|112|1|Holz / legno",
            "K 102|Leuchterengel|31|31|87,5|2|",
            "Gesamt / Totale|||||3|",
        ],
        {2: ("K 101", "Madonna", 0.38, 0.295, 1.12, 1), 3: ("K 102", "Leuchterengel", 0.31, 0.31, 0.875, 2)},
        others=(4,),
    ),
    # Italian: group of measures, number of pieces, sums, a remark, the one who is responsible
    "italian": KeptList(
        "it",
        [
            "Museo civico di Esempio - sezione ceramica||||||",
            "N. inv.|Oggetto|Misure (cm)|||Q.tà|Osservazioni",
            "||L|P|H||",
            "12|Albarello|14,5|14,5|31|3|",
            "13|Piatto da parata|48|48|9|1|crepa",
            "14|Anfora|35|33|82|1|",
            "Totale pezzi|||||5|",
            "Nota: misure senza piedistallo||||||",
            "Il responsabile||||||",
        ],
        {
            4: ("12", "Albarello", 0.145, 0.145, 0.31, 3), 5: ("13", "Piatto da parata", 0.48, 0.48, 0.09, 1),
            6: ("14", "Anfora", 0.35, 0.33, 0.82, 1),
        },
        ("A1:G1", "C2:E2", "A2:A3", "B2:B3", "F2:F3", "G2:G3"),
        others=(1, 7, 8, 9),
    ),
    # French: two lengths, thousands
    "french": KeptList(
        "fr",
        [
            "Musée d'Exemple|||||||",
            "Département des sculptures|||||||",
            "N° d'inventaire|Désignation|Dimensions (mm)|||Poids (kg)|Qté|Remarques",
            "||Largeur|Profondeur|Hauteur|||",
            "2001.7.1|Colonne|420|420|2\u202f350|1 250|1|",
            "2001.7.2|Petite colonne|310|310|980|160|2|socle à part",
            "2003.1|Stèle|560|220|1\u202f410|420|1|",
            "Salle 12|||||||",
            "2004.9|Vasque|880|870|640|300|1|",
            "Total|||||2130|5|",
            "Fait à Exempleville, le 3 mars 2024|||||||",
        ],
        {
            5: ("2001.7.1", "Colonne", 0.42, 0.42, 2.35, 1), 6: ("2001.7.2", "Petite colonne", 0.31, 0.31, 0.98, 2),
            7: ("2003.1", "Stèle", 0.56, 0.22, 1.41, 1), 9: ("2004.9", "Vasque", 0.88, 0.87, 0.64, 1),
        },
        ("C3:E3",),
        others=(1, 2, 8, 10, 11),
        masses={5: 1250.0},
    ),
    # Spanish: alto, ancho, fondo; a remark with a star
    "spanish": KeptList(
        "es",
        [
            "Nº inv.|Denominación|Medidas en cm|||Cant.|Obs.",
            "||Alto|Ancho|Fondo||",
            "E-1|Bargueño|61,5|102|43|1|con pie",
            "E-2|Arca|58|131|55|1|",
            "E-3|Velador|74|51|51|2|*",
            "Suma||||| 4|",
            "* medidas aproximadas||||||",
        ],
        {
            3: ("E-1", "Bargueño", 1.02, 0.43, 0.615, 1), 4: ("E-2", "Arca", 1.31, 0.55, 0.58, 1),
            5: ("E-3", "Velador", 0.51, 0.51, 0.74, 2),
        },
        ("C1:E1",),
        others=(6, 7),
    ),
    # English: crate sizes beside those of the object, feet and inches by a row of units
    "english": KeptList(
        "en",
        [
            "Sample County Museum|||||||||",
            "Decorative arts, ground floor store|||||||||",
            "",
            "Accession no.|Object|Overall dimensions|||Crate|||Qty|Remarks",
            "||W|D|H|W|D|H||",
            "||in|in|in|in|in|in||",
            "1987.12|Longcase clock|20|10|84|30|20|95|1|",
            "1987.13|Urn|14 1/2|14 1/2|32|20|20|40|2|pair, gilt",
            "",
            "Total number of objects|||||||||3",
            "Checked by: ________|||||||||",
        ],
        {7: ("1987.12", "Longcase clock", 0.508, 0.254, 2.1336, 1), 8: ("1987.13", "Urn", 0.3683, 0.3683, 0.8128, 2)},
        ("C4:E4", "F4:H4", "A4:A6", "B4:B6"),
        others=(1, 2, 10, 11),
    ),
}  # fmt: skip


def _cell(text: str) -> Any:
    """Return what a spreadsheet would hold: a number where one is written plainly, nothing, or text."""
    text = text.strip()
    if re.fullmatch(r"\d+|\d+,\d+", text):
        return float(text.replace(",", "."))
    return text or None


def write(kept: KeptList, path: Path, encoding: str = "utf-8-sig") -> Path:
    """Write a list in the form that the extension says."""
    {".xlsx": _write_excel, ".ods": _write_open_document, ".csv": _write_csv}[path.suffix](kept, path, encoding)
    return path


def _write_excel(kept: KeptList, path: Path, _: str) -> None:
    from openpyxl import Workbook

    book = Workbook()
    sheet = book.active
    for i, row in enumerate(kept.rows, start=1):
        for k, text in enumerate(row.split("|"), start=1):
            sheet.cell(i, k, _cell(text))
    for each in kept.merged:
        sheet.merge_cells(each)
    book.save(path)


def _write_csv(kept: KeptList, path: Path, encoding: str) -> None:
    text = io.StringIO(newline="")
    writer = csv.writer(text, delimiter=";", lineterminator="\r\n")
    for row in kept.rows:
        writer.writerow(row.split("|") if row else [])
    path.write_bytes(text.getvalue().encode(encoding))


def _write_open_document(kept: KeptList, path: Path, _: str) -> None:
    spans, covered = {}, set()
    for each in kept.merged:
        (left, top), (right, bottom) = (
            (ord(mark[0]) - 65, int(mark[1:])) for mark in each.split(":")
        )  # fmt: skip
        spans[top, left] = (right - left + 1, bottom - top + 1)
        covered |= {(i, k) for i in range(top, bottom + 1) for k in range(left, right + 1)} - {(top, left)}
    lines = []
    for i, row in enumerate(kept.rows, start=1):
        cells = []
        for k, text in enumerate(row.split("|")):
            value, across = _cell(text), spans.get((i, k))
            tag = "table:covered-table-cell" if (i, k) in covered else "table:table-cell"
            given = (
                f' table:number-columns-spanned="{across[0]}" table:number-rows-spanned="{across[1]}"' if across else ""
            )
            if isinstance(value, float):
                given += f' office:value-type="float" office:value="{value!r}"'
            elif value is not None:
                given += ' office:value-type="string"'
            words = f"<text:p>{escape(text.strip())}</text:p>" if value is not None else ""
            cells.append(f"<{tag}{given}>{words}</{tag}>")
        lines.append(f"<table:table-row>{''.join(cells)}</table:table-row>")
    content = (
        '<?xml version="1.0"?><office:document-content xmlns:office="o" xmlns:table="t" xmlns:text="x"><office:body><office:spreadsheet>'
        f'<table:table table:name="A">{"".join(lines)}</table:table></office:spreadsheet></office:body></office:document-content>'
    )
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("content.xml", content)
