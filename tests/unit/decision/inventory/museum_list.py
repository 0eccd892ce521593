"""A test list as a museum may keep it: thirty invented objects in German, untidy on purpose."""

# ruff: noqa: E501 - the header of the list is one line

import re
from datetime import date
from pathlib import Path
from typing import Any

LIST = """\
Inv.-Nr.|Objekt|Form|Maße (H x B x T)|Breite [cm]|Tiefe|Höhe in cm|Durchmesser|Standfläche cm|Schwerpunkt (cm)|Gewicht|Stück|Schadensfolge|Foto|Bemerkung|Standort
T-01|Amphore|rund||||62|38 cm|12||9 kg|1|hoch|amphore.png||EG
T-02|Büste auf Sockel|||45|40 cm|185|||105|210 kg|1|hoch|||EG
T-03|Stehspiegel|||?|40 cm|160||||18 kg|1|mittel|||EG
T-04|Vitrine|eckig|180 x 90 x 45 cm|||||||120 kg|3|mittel|||EG
T-05|Säule|Rund||||ca. 230|25 cm|||300 kg|2 Stk.|hoch|||EG
T-06|Standuhr|||49,5|25 cm|215|||125|60 kg|1|hoch|uhr.png||1. OG
T-07|Truhe|||120|60 cm|70||||0,65 t|1|gering|||1. OG
T-08|Leuchterpaar|rund||||90|12,5 cm|||k. A.|Paar|mittel|||1. OG
T-09|Schale|rund||||12|30 cm|10|7|1,5 kg|12|niedrig|||1. OG
T-10|Bronzefigur||120 x 30 x 28 cm|||||||85 kg|1|hoch|fehlt.jpg||1. OG
T-11|Regal|||80|28 cm|210||||160 kg|4|mittel|||Depot
T-12|Globus|rund||||110|Ø 60 cm|ca. 40||25 kg|1|mittel|||Depot
T-13|Stele||etwa 150 x 40 x 20 cm||||||||1|hoch|||Depot
T-14|Kachelofen (Modell)|||60-65|50 cm|140||||90 kg|1|mittel|||Depot
T-15|Rüstung|||70|45 cm|180 ± 5||50|110|unbekannt|1|hoch|||Depot
T-16|Grabplatte|||90|15 cm|200?||||600 kg|1|hoch|||Depot
T-17|Uhrwerk||H 54 x B 40 x T 30 cm|||||||20 kg|1||||Depot
T-18|Modellschiff|||20|4 ft 6 in|110||||14 lb|1|mittel|||Depot
T-19|Tafelklavier|||160|24"|85||||140 kg|1|mittel|||Depot
T-20|Vase mit Deckel|rund|Ø 24 x 55 cm|||||||6 kg|1|hoch|../geheim.png||Saal 3
T-21|Hocker|oval||45|35 cm|42||||5 kg|viele|gering|||Saal 3
T-22|Ofenschirm|||70|#REF!|110||||12 kg|1|mittel|||Saal 3
T-23|Lesepult|||60|50 cm|2024-12-01||||30 kg|1|mittel|||Saal 3
T-24|Taufbecken|zylindrisch||||95|0,8 m|?||9000000 kg|1|***|||Saal 3
T-25|Kerzenständer|rund||||130|unbekannt|||8 kg|1|mittel|||Saal 3
T-26|Kommode|||110|55 cm|90||||70 kg|1|gering||Füße gerundet|Saal 3
T-27|Hausaltar|||80|35 cm|190||90||55 kg|1|hoch|||Saal 3
T-28||||40|40 cm|100|||||1|||ohne Bezeichnung|Saal 3
T-29|Obelisk||200 x 35 cm|||||||180 kg|1|hoch|||Saal 3
T-30|Schreibkasten||300 x 400 x 250 mm|||||||7 kg|True|gering|||Saal 3
"""


def _cell(text: str) -> Any:
    """Return what a spreadsheet would hold: a number, a date, a truth, nothing, or text."""
    if re.fullmatch(r"\d{4}-\d\d-\d\d", text):
        return date.fromisoformat(text)
    return float(text) if text.isdigit() else {"": None, "True": True}.get(text, text)


def write_museum_list(path: Path) -> None:
    """Write the list, with titles above, empty rows and columns, merged cells, another sheet and totals."""
    from openpyxl import Workbook

    book = Workbook()
    about = book.active
    about.title = "Hinweise"
    about["A1"] = "Testliste: alle Objekte sind erfunden"
    sheet = book.create_sheet("Objekte")
    sheet["A1"] = "Bestandsliste Testmuseum (erfunden)"
    sheet.merge_cells("A1:F1")
    sheet["A2"] = "Stand: 12.3.2024"
    place = 4
    for k, line in enumerate(LIST.splitlines()):
        for j, text in enumerate(line.split("|")):
            sheet.cell(place, j + 2, _cell(text))  # column A is empty
        place += 2 if k % 7 == 6 else 1
    sheet.cell(place + 1, 3, "Summe")
    sheet.cell(place + 1, 12, "2.345 kg")
    book.save(path)
