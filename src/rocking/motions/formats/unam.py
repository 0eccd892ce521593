"""UNAM, Mexico: the ASA standard file of accelerations, version 2.0, with up to 12 channels in columns.

The layout is known from the header, which contains all field names and the Fortran format. The reader was verified with
one file of 2017.
"""

import re
from typing import ClassVar

import numpy as np

from rocking.motions.formats import headers, numbers
from rocking.motions.formats.header_values import after, columns_of, header_text, header_value, side_by_side
from rocking.motions.formats.record import Component, Record, RecordFormat, Source, metadata_of, one_line

_RULE = "---------+" * 8
_TOP = 150


class Unam(RecordFormat):
    """ASA 2.0 files of accelerations."""

    name: ClassVar[str] = "unam"
    title: ClassVar[str] = "UNAM, Mexico: archivo estandar de aceleracion (ASA), version 2.0"
    suffixes: ClassVar[tuple[str, ...]] = (".txt",)
    notes: ClassVar[str] = "Verified with one file of 2017 with three channels in gal. Channel names are orientations."
    marks: ClassVar[tuple[str, ...]] = (
        "ARCHIVO ESTANDAR DE ACELERACION", r"NUMERO DE CANALES\s*:", r"INTERVALO DE MUESTREO, C1-C6",
        r"NUM\. TOTAL DE MUESTRAS, C1-C6", r"FORMATO DATOS", "DATOS DE ACELERACION",
    )  # fmt: skip
    top: ClassVar[int] = _TOP

    def read(self, source: Source, units: str | None = None, time_step: float | None = None) -> Record:
        head = after(source, "DATOS DE ACELERACION", _TOP)
        first = after(source, r"-{9}\+", head + 10)
        channels = int(header_value(source, head, r"NUMERO DE CANALES\s*:", r"0?[1-9]|1[0-2]")[0])
        counts = _listed(source, head, r"NUM\. TOTAL DE MUESTRAS", channels, r"\d{1,9}")
        steps = _listed(source, head, "INTERVALO DE MUESTREO", channels, r"\d*\.?\d+")
        names = _listed(source, head, "ORIENTACION", channels, r"[^/]*")
        peaks = _listed(source, head, r"ACEL\. MAX\.\s*\(Gal\)", channels, r"[-+]?\d*\.?\d+")
        if len(set(counts)) > 1 or len({float(step) for step in steps}) > 1:
            raise source.error(None, "channels must have equal length and time step")
        header_value(source, head, r"UNIDADES DE LOS DATOS\s*:", r"(?:Gal|cm/s/s|cm/s\^?2)\b.*")
        unit = headers.acceleration_unit(source, "gal", units)
        step = headers.step_between_samples(source, float(steps[0]), time_step)
        form = header_value(source, head, r"FORMATO DATOS[^:]*:", r".*")[0]
        columns, width = numbers.fortran_form(source, head, form)
        if columns != channels:
            raise source.error(
                None, "the header states {channels} channels, but samples in {form}", channels=channels, form=form[:20]
            )
        sides = names
        if len(set(names)) < channels or "" in names:
            names = [f"CHAN {number}" for number in range(1, channels + 1)]
        texts = {
            "event": r"FECHA DEL SISMO[^:]*:",
            "station": r"NOMBRE DE LA ESTACION\s*:",
            "magnitude": r"MAGNITUD\(ES\)\s*:",
        }
        metadata = metadata_of(**{key: header_text(source, head, word) for key, word in texts.items()})
        pairs = zip(names, sides, strict=True)
        channels_of = tuple(Component(name, np.empty(0), unit, step, None, {"direction": side}) for name, side in pairs)
        about = Record(self.name, channels_of, "", metadata)
        return side_by_side(source, about, first, int(counts[0]), peaks, (columns, width))

    def write(self, record: Record) -> bytes:
        """Return a file of up to six channels, in gal with 4 decimals."""
        table, step = columns_of(record, self.name, "gal", 6)
        table, count = table.round(4), len(record.components)
        largest = [f"{row[int(np.abs(row).argmax())]:.4f}" for row in table.T]
        names = [one_line(component.name, 9).replace("/", "-") for component in record.components]
        stated = {
            "NOMBRE DE LA ESTACION": record.text("station", 40),
            "NUMERO DE CANALES": str(count),
            "ORIENTACION C1-C6 (rumbo;orientacion)": "/" + "/".join(names),
            "INTERVALO DE MUESTREO, C1-C6 (s)": f"/{step:.9g}" * count,
            "FECHA DEL SISMO [GMT]": record.text("event", 40),
            "NUM. TOTAL DE MUESTRAS, C1-C6": f"/{len(table)}" * count,
            "ACEL. MAX.(Gal), C1-C6": "/" + "/".join(largest),
            "UNIDADES DE LOS DATOS": "Gal (cm/s/s)",
            "FORMATO DATOS (FORTRAN,10 campos/dato)": f"{count}F10.4",
        }
        lines = ["ARCHIVO ESTANDAR DE ACELERACION:", *(f"{key:<39}: {text}" for key, text in stated.items())]
        lines += ["DATOS DE ACELERACION:", _RULE, "".join(f"{name:>10}" for name in names), _RULE]
        return "\n".join([*lines, *numbers.in_width(table.ravel(), count, 10, 4), ""]).encode("latin-1")


def _listed(source: Source, last: int, key: str, channels: int, form: str) -> list[str]:
    """Return the values in the lines of channels 1 to 6 and 7 to 12, separated by slashes."""
    texts: list[str] = []
    for group in ("C1-C6", "C7-C12"):
        if len(texts) < channels:
            texts += header_value(source, last, rf"{key},?\s*{group}[^:]*:", r"/.*")[0][1:].split("/")
    texts = [word.strip() for word in texts]
    if len(texts) != channels or not all(re.fullmatch(form, word) for word in texts):
        raise source.error(
            None, "{key}: {channels} values after slashes expected, found {entry}", key=key.replace(chr(92), ""),
            channels=channels, entry=str(texts[:12]),
        )  # fmt: skip
    return texts
