"""Header text above columns of numbers: names, unit, time step, number of samples and direction."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from rocking.motions.formats import headers
from rocking.motions.formats.column_text import (
    ColumnName,
    kind_of,
    looks_like_unit,
    names_on,
    states_sampling,
    unit_named,
)
from rocking.motions.formats.directions import orientation
from rocking.motions.formats.numbers import number
from rocking.motions.formats.record import Source, readable

_NUMBER = r"(\d*[.,]?\d+(?:[eE][-+]?\d+)?)"
_IN_BRACKETS = r"(?:[\[(]\s*[^\W\d]+\.?\s*[\])])"
_SEPARATED = rf"(?![^\W_])(?:[^\d=:]{{0,20}}[=:;]\s*|\s*{_IN_BRACKETS}\s*[=:;,]?\s*)"
_COUNT_AND_STEP = re.compile(r"\bNPTS\s*,\s*DT\s*[=:]?\s*(\d+)[\s,]+(\d*\.?\d+(?:[eE][-+]?\d+)?)", re.IGNORECASE)
_COUNT = re.compile(
    rf"\b(?:npts|nsamples|ndata|number of (?:points|samples|data)|num\w* de muestras|anzahl){_SEPARATED}(\d+)\b",
    re.IGNORECASE,
)
_LENGTH = re.compile(r"\W*length\s*[:=]\s*(\d+)\W*", re.IGNORECASE)
_SAMPLED = r"(?:sampl\w*|digiti\w*|abtast\w*|scan|acquisition|recording|[öo]rnekleme)"
_STEPS = (
    r"(?:dt|d_t|delta[ _]?t|t[ _]?step|time[ _-]?(?:step|increment|interval)"
    rf"|{_SAMPLED}[ _-]?(?:interval|period|step|time|spacing)|step[ _]?size|(?:x[_ ])?interval|delta[ _]?x"
    r"|zeitschritt|abtastintervall|abtastschritt"
    r"|passo temporale|intervallo di campionamento|paso de tiempo|intervalo de muestreo|pas de temps"
    r"|[öo]rnekleme aral[\u0131i][ğg][\u0131i])"
)
_UNIT_OF_TIME = r"\s*(m(?:illi)?s(?:ec\w*)?\b|us\b|µs\b)?"
_STEP = re.compile(
    rf"(?:\b{_STEPS}{_SEPARATED}|^\W*{_STEPS}\s+|^\W*(?:delta|step|interval|increment|pas|passo|paso)\s*{_IN_BRACKETS}?\s*[:=]\s*)"
    rf"{_NUMBER}{_UNIT_OF_TIME}",
    re.IGNORECASE,
)
_STEP_IN_WORDS = re.compile(
    rf"\b(?:{_STEPS}|step|interval)\s+(?:of\s+|is\s+|in\s+\w+\s+)?{_NUMBER}\s*(m(?:illi)?s(?:ec\w*)?|s(?:ec\w*)?|sek\w*)\b",
    re.I,
)
_RATES = (
    rf"(?:{_SAMPLED}[_ -]?(?:rate|freq\w*|frequenz|frekans\w*|h[\u0131i]z\w*)|abtastrate|abtastfrequenz|sps|fs|f_s"
    r"|frequenza di campionamento|frecuencia de muestreo|tasa de muestreo|fr[eé]quence d.[eé]chantillonnage"
    r"|(?:samples|points) per sec\w*|samples/s(?:ec)?)"
)
_RATE = re.compile(rf"\b{_RATES}{_SEPARATED}{_NUMBER}\s*(kHz)?", re.IGNORECASE)
_RATE_IN_WORDS = re.compile(
    rf"\b(?:{_RATES}\s+(?:of\s+|is\s+)?{_NUMBER}\s*(k?Hz|sps)\b|{_NUMBER}\s*(?:sps\b|(?:samples?|points?|pts)\s*(?:per|/)\s*s\w*))",
    re.IGNORECASE,
)
_OF_SAMPLING = (_COUNT_AND_STEP, _COUNT, _STEP, _STEP_IN_WORDS, _RATE, _RATE_IN_WORDS)
_NOT_UNDERSTOOD = re.compile(
    r"\W*((?:[^\W\d_]|[ _.'-]){0,40}(?:rate|step|interval|delta|dt|sps"
    r"|sampling|freq\w*|frec\w*|tast\w*|[ée]chantillon\w*"
    r"|scal\w*|factor|faktor|multipl\w*|gain)[^=:;\d]{0,20})[:=;]\s*[\d.,]+",
    re.IGNORECASE,
)
_NOT_OF_SAMPLING = re.compile(
    r"filt|corner|cut|pass|natural|band|fault|strike|dip|epic|hypo|distance|angle|azim", re.IGNORECASE
)
_SPECTRUM = re.compile(
    r"^\W*(?:periods?|t)\s*[\[(]\s*s(?:ec)?\s*[\])][\s,;|]+(?:p?s[adv]|spectral)(?![^\W_])"
    r"|\b(?:response|fourier)\b.{0,30}\bspectr(?:um|a)\b(?!.{0,20}(?:compatible|match))",
    re.IGNORECASE,
)
_RECORDER_COUNTS = re.compile(r"^\W*(?:raw\s+)?counts?\b(?!\s*[:=]?\s*\d)", re.IGNORECASE)
_UNIT_WORD = r"\b(?:units?|einheit|unidad(?:es)?|unit[àa]|birim)\b\s*"
_UNIT = re.compile(_UNIT_WORD + r"(?:[:=]|of|are|is|in)\s*[\[(]?\s*([A-Za-z][\w/^*.-]*)", re.IGNORECASE)
_UNIT_OF = re.compile(
    r"\b(?:(?:accel|veloc|displ|beschleun|aceler|ivme|İvme)\w*\s+(?:in\s+|\[|\()|data in)\s*([A-Za-z][\w/^*.-]*)"
    r"|\bacc\w*\s*[=:]\s*([A-Za-z][\w/^*.-]*)\s*$",
    re.IGNORECASE,
)
_STATED_UNIT = re.compile(_UNIT_WORD + r"[:=]\s*[\[(]?\s*(\S+?)[\])]?\s*$", re.IGNORECASE)
_OTHER_QUANTITY = re.compile(
    r"^\W*(?:ground )?(velocity|displacement)(?:\b.*(?:series|histor|record|trace)|\s*$)", re.IGNORECASE
)
_COMPONENT_WORDS = r"comp(?:onente?)?|channel|direction|richtung|bile[sş]en"
_COMPONENT = re.compile(
    rf"\W*(?:{_COMPONENT_WORDS}|orientation|azimuth|dir)\b\.?\s*[:=]?\s*"
    r"([\w+./-]+(?: ?[EW])?)\s*(?:\([\w -]*\))?\W*",
    re.IGNORECASE,
)
_BEFORE_COMPONENT = re.compile(rf"\W*([\w+/-]+)[ -](?:{_COMPONENT_WORDS}|bile[sş]en[i\u0131])\b\W*", re.IGNORECASE)
_VERTICAL = re.compile(
    r"(?<![^\W_])(?:verti[ck]al\w*|vert|senkrecht\w*|d[üu][sş]ey|up-down|(?-i:U-?D|[BHEL][HN]Z|(?<=[A-Z0-9]-)(?<!SET-)UP))(?![^\W_])(?!.{0,20}(?:datum|scale|exagg))",
    re.IGNORECASE,
)
_HORIZONTAL = re.compile(r"horizontal|peak|pga|max|(?<![^\W_])(?:N-?S|E-?W|[BHEL][HN][NE12])(?![^\W_])", re.IGNORECASE)


@dataclass(frozen=True)
class HeaderWords:
    """Properties in the header text above columns; None or empty if missing."""

    names: tuple[str, ...] | None = None
    unit: str | None = None  # a key of `rocking.conventions.ACCELERATION_UNITS`
    unknown_unit: str = ""  # unknown unit in the header
    step: float | None = None  # time step [s]
    count: int | None = None
    direction: str = ""  # direction of the component, as in the header
    perhaps_upright: bool = False  # True if the header may refer to a vertical component

    @classmethod
    def of(cls, source: Source, lines: Sequence[tuple[int, str]], columns: int) -> "HeaderWords":
        """Return the properties in lines by line index.

        Raise an error for headers of velocities, displacements or spectra.
        """
        stated = cls()
        bare = [(line, readable(text.strip().lstrip("#% \t")[:400])) for line, text in lines]
        for line, text in bare:
            _refuse_others(source, line, text)
            stated = stated._with_sampling(source, line, text)._with_unit(source, line, text)._with_direction(text)
            if names := _names_of(text, columns):
                stated = replace(stated, names=names)
        texts = [text for _, text in bare]
        other = next((match for text in texts if (match := _OTHER_QUANTITY.match(text))), None)
        if other and not stated.unit and not stated.names and "accel" not in " ".join(texts).lower():
            headers.refuse_other(source, other[1])
        return stated._with_length(texts)

    def _with_direction(self, text: str) -> "HeaderWords":
        match = _COMPONENT.fullmatch(text) or _BEFORE_COMPONENT.fullmatch(text)
        direction = orientation(match[1]) if match else None
        if match and direction is not None and not (isinstance(direction, float) and _VERTICAL.search(text)):
            return replace(self, direction=match[1])
        if _VERTICAL.search(text) and not _HORIZONTAL.search(text):
            return replace(self, perhaps_upright=True)
        return self

    def _with_sampling(self, source: Source, line: int, text: str) -> "HeaderWords":
        step, count = None, self.count
        if both := _COUNT_AND_STEP.search(text):
            count, step = int(both[1][:9]), number(source, line, both[2])
        elif match := _COUNT.search(text):
            count = int(match[1][:9])
        for form in (_STEP, _STEP_IN_WORDS):
            if not both and step is None and (match := form.search(text)):
                step = _decimal(source, line, match[1]) * _seconds_in(match[0])
        for form in (_RATE, _RATE_IN_WORDS):
            if (match := form.search(text)) and (rate := _decimal(source, line, match[1] or match[3])) > 0.0:
                by_rate = 1.0 / (rate * (1000.0 if "khz" in match[0].lower() else 1.0))
                step = self._agreed(source, line, step, by_rate)
        unread = _NOT_UNDERSTOOD.match(text) if step is None and count == self.count else None
        if unread and not _NOT_OF_SAMPLING.search(unread[1]):
            source.doubt(line, f"{text[:60]!r} is not understood and ignored")
        return replace(self, step=self._agreed(source, line, self.step, step), count=count)

    @staticmethod
    def _agreed(source: Source, line: int, stated: float | None, step: float | None) -> float | None:
        if stated is not None and step is not None and abs(stated - step) > 1e-6 * stated:
            raise source.error(
                line, "the time step {step:g} s contradicts {stated:g} s elsewhere in the header", step=step,
                stated=stated,
            )  # fmt: skip
        return step if stated is None else stated

    def _with_unit(self, source: Source, line: int, text: str) -> "HeaderWords":
        unit, unknown = self.unit, self.unknown_unit
        for word in (*_UNIT.findall(text), *(first or second for first, second in _UNIT_OF.findall(text))):
            recognised = "g" if word == "G" else unit_named(source, line, word.rstrip(".-"))
            unit = headers.acceleration_unit(source, unit, recognised) if recognised else unit
        stated = _STATED_UNIT.search(text)
        if stated and unit_named(source, line, stated[1].rstrip(".-")) is None and looks_like_unit(stated[1]):
            unknown = stated[1] if kind_of(stated[1])[1] != "other" else unknown
        return replace(self, unit=unit, unknown_unit=unknown)

    def _with_length(self, texts: Sequence[str]) -> "HeaderWords":
        """Return the properties with the number of samples from LENGTH, as in files of SeismicHandler with DELTA."""
        length = next((int(match[1][:9]) for text in texts if (match := _LENGTH.fullmatch(text))), None)
        has_delta = any(re.match(r"delta\s*[:=]", text, re.IGNORECASE) for text in texts)
        return replace(self, count=length) if length and has_delta and self.count is None else self


def is_understood(text: str) -> bool:
    """Return True if no unread text about the sampling remains in a line."""
    remaining = text[:400]
    for form in _OF_SAMPLING:
        remaining = form.sub(" ", remaining)
    return not states_sampling(remaining)


def _seconds_in(text: str) -> float:
    """Return the unit of time before or after a time step [s]."""
    small = re.search(r"(?:[\W_]|\d)(?:(m(?:illi)?s(?:ec\w*)?)|[uµμ]s|micros(?:ec\w*)?)(?![^\W_])", text, re.IGNORECASE)
    return (1e-3 if small[1] else 1e-6) if small else 1.0


def _decimal(source: Source, line: int, word: str) -> float:
    return number(source, line, word.replace(",", "."))


def _names_of(text: str, columns: int) -> tuple[str, ...] | None:
    names = names_on(text)
    read = [ColumnName.of(index, name) for index, name in enumerate(names or ())]
    # words with units are names if one word is a time or all words are accelerations
    are_names = any(column.is_time for column in read) or all(column.unit for column in read)
    has_unit = any(kind_of(column.suffix)[1] for column in read)
    return names if len(read) == columns and are_names and has_unit else None


def _refuse_others(source: Source, line: int, text: str) -> None:
    if _SPECTRUM.search(text):
        raise source.error(
            line, "{entry!r} is a response spectrum, not a record; use motion.target= for spectra", entry=text[:40]
        )
    if _RECORDER_COUNTS.search(text):
        raise source.error(
            line, "{entry!r} contains counts of a recorder; convert them to accelerations first", entry=text[:40]
        )
