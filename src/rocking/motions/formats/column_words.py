"""The words above columns of numbers, in comments or without a mark: names, unit, step, count and direction."""

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
_SAYS = rf"(?![^\W_])(?:[^\d=:]{{0,20}}[=:;]\s*|\s*{_IN_BRACKETS}\s*[=:;,]?\s*)"
_BOTH = re.compile(r"\bNPTS\s*,\s*DT\s*[=:]?\s*(\d+)[\s,]+(\d*\.?\d+(?:[eE][-+]?\d+)?)", re.IGNORECASE)
_COUNT = re.compile(
    rf"\b(?:npts|nsamples|ndata|number of (?:points|samples|data)|num\w* de muestras|anzahl){_SAYS}(\d+)\b",
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
    rf"(?:\b{_STEPS}{_SAYS}|^\W*{_STEPS}\s+|^\W*(?:delta|step|interval|increment|pas|passo|paso)\s*{_IN_BRACKETS}?\s*[:=]\s*)"
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
_RATE = re.compile(rf"\b{_RATES}{_SAYS}{_NUMBER}\s*(kHz)?", re.IGNORECASE)
_RATE_IN_WORDS = re.compile(
    rf"\b(?:{_RATES}\s+(?:of\s+|is\s+)?{_NUMBER}\s*(k?Hz|sps)\b|{_NUMBER}\s*(?:sps\b|(?:samples?|points?|pts)\s*(?:per|/)\s*s\w*))",
    re.IGNORECASE,
)
_OF_STEPS = (_BOTH, _COUNT, _STEP, _STEP_IN_WORDS, _RATE, _RATE_IN_WORDS)
_ODD = re.compile(
    r"\W*((?:[^\W\d_]|[ _.'-]){0,40}(?:rate|step|interval|delta|dt|sps"
    r"|sampling|freq\w*|frec\w*|tast\w*|[ée]chantillon\w*"
    r"|scal\w*|factor|faktor|multipl\w*|gain)[^=:;\d]{0,20})[:=;]\s*[\d.,]+",
    re.IGNORECASE,
)
_OF_OTHERS = re.compile(
    r"filt|corner|cut|pass|natural|band|fault|strike|dip|epic|hypo|distance|angle|azim", re.IGNORECASE
)
_SPECTRUM = re.compile(
    r"^\W*(?:periods?|t)\s*[\[(]\s*s(?:ec)?\s*[\])][\s,;|]+(?:p?s[adv]|spectral)(?![^\W_])"
    r"|\b(?:response|fourier)\b.{0,30}\bspectr(?:um|a)\b(?!.{0,20}(?:compatible|match))",
    re.IGNORECASE,
)
_COUNTS = re.compile(r"^\W*(?:raw\s+)?counts?\b(?!\s*[:=]?\s*\d)", re.IGNORECASE)
_UNIT = re.compile(
    r"\b(?:units?|einheit|unidad(?:es)?|unit[àa]|birim)\b\s*(?:[:=]|of|are|is|in)\s*[\[(]?\s*([A-Za-z][\w/^*.-]*)", re.I
)
_UNIT_OF = re.compile(
    r"\b(?:(?:accel|veloc|displ|beschleun|aceler|ivme|İvme)\w*\s+(?:in\s+|\[|\()|data in)\s*([A-Za-z][\w/^*.-]*)"
    r"|\bacc\w*\s*[=:]\s*([A-Za-z][\w/^*.-]*)\s*$",
    re.IGNORECASE,
)
_STATED_UNIT = re.compile(
    r"\b(?:units?|einheit|unidad(?:es)?|birim)\b\s*[:=]\s*[\[(]?\s*(\S+?)[\])]?\s*$", re.IGNORECASE
)
_OTHER = re.compile(
    r"^\W*(?:ground )?(velocity|displacement)(?:\b.*(?:series|histor|record|trace)|\s*$)", re.IGNORECASE
)
_SIDE = re.compile(
    r"\W*(?:comp(?:onente?)?|channel|direction|orientation|azimuth|dir|richtung|bile[sş]en)\b\.?\s*[:=]?\s*"
    r"([\w+./-]+(?: ?[EW])?)\s*(?:\([\w -]*\))?\W*",
    re.IGNORECASE,
)
_SIDE_FIRST = re.compile(
    r"\W*([\w+/-]+)[ -](?:comp(?:onente?)?|channel|direction|richtung|bile[sş]en[i\u0131]?)\b\W*", re.IGNORECASE
)
_UPRIGHT = re.compile(
    r"(?<![^\W_])(?:verti[ck]al\w*|vert|senkrecht\w*|d[üu][sş]ey|up-down|(?-i:U-?D|[BHEL][HN]Z|(?<=[A-Z0-9]-)(?<!SET-)UP))(?![^\W_])(?!.{0,20}(?:datum|scale|exagg))",
    re.IGNORECASE,
)
_LEVEL = re.compile(r"horizontal|peak|pga|max|(?<![^\W_])(?:N-?S|E-?W|[BHEL][HN][NE12])(?![^\W_])", re.IGNORECASE)


@dataclass(frozen=True)
class Said:
    """What the words of a file say; None and nothing where they are silent."""

    names: tuple[str, ...] | None = None
    unit: str | None = None  # a key of `rocking.conventions.ACCELERATION_UNITS`
    odd_unit: str = ""  # a unit that is stated and not known
    step: float | None = None  # [s]
    count: int | None = None
    side: str = ""  # direction of the component, as it stands
    perhaps_upright: bool = False  # whether a line names the vertical, in words of which no direction is read

    @classmethod
    def of(cls, source: Source, words: Sequence[tuple[int, str]], columns: int) -> "Said":
        """Read words by their lines; what speaks of velocities, displacements or spectra alone is refused."""
        said = cls()
        for line, text in words:
            bare = readable(text.strip().lstrip("#% \t")[:400])
            _refuse_others(source, line, bare)
            said = said._with_sampling(source, line, bare)._with_unit(source, line, bare)
            found = _SIDE.fullmatch(bare) or _SIDE_FIRST.fullmatch(bare)
            side = orientation(found[1]) if found else None
            if found and side is not None and not (isinstance(side, float) and _UPRIGHT.search(bare)):
                said = replace(said, side=found[1])
            elif _UPRIGHT.search(bare) and not _LEVEL.search(bare):
                said = replace(said, perhaps_upright=True)
            if names := _names_of(bare, columns):
                said = replace(said, names=names)
        spoken = " ".join(text for _, text in words).lower()
        other = next((one for _, text in words if (one := _OTHER.match(text[:200]))), None)
        if other and not said.unit and not said.names and "accel" not in spoken:
            headers.refuse_other(source, other[1])
        return said._with_length(words)

    def _with_sampling(self, source: Source, line: int, bare: str) -> "Said":
        step, count = None, self.count
        if both := _BOTH.search(bare):
            count, step = int(both[1][:9]), number(source, line, both[2])
        elif found := _COUNT.search(bare):
            count = int(found[1][:9])
        for form in (_STEP, _STEP_IN_WORDS):
            if not both and step is None and (found := form.search(bare)):
                step = _decimal(source, line, found[1]) * _seconds_in(found[0])
        for form in (_RATE, _RATE_IN_WORDS):
            if (found := form.search(bare)) and (rate := _decimal(source, line, found[1] or found[3])) > 0.0:
                other = 1.0 / (rate * (1000.0 if "khz" in found[0].lower() else 1.0))
                step = self._agreed(source, line, step, other)
        if step is None and count == self.count and (odd := _ODD.match(bare)) and not _OF_OTHERS.search(odd[1]):
            source.doubt(line, f"{bare[:60]!r} is not understood, and not used")
        return replace(self, step=self._agreed(source, line, self.step, step), count=count)

    @staticmethod
    def _agreed(source: Source, line: int, stated: float | None, step: float | None) -> float | None:
        if stated is not None and step is not None and abs(stated - step) > 1e-6 * stated:
            raise source.error(line, f"a time step of {step:g} s, and one of {stated:g} s elsewhere in the header")
        return step if stated is None else stated

    def _with_unit(self, source: Source, line: int, bare: str) -> "Said":
        unit, odd = self.unit, self.odd_unit
        for word in (*_UNIT.findall(bare), *(one or other for one, other in _UNIT_OF.findall(bare))):
            found = "g" if word == "G" else unit_named(source, line, word.rstrip(".-"))
            unit = headers.acceleration_unit(source, unit, found) if found else unit
        stated = _STATED_UNIT.search(bare)
        if stated and unit_named(source, line, stated[1].rstrip(".-")) is None and looks_like_unit(stated[1]):
            odd = stated[1] if kind_of(stated[1])[1] != "other" else odd
        return replace(self, unit=unit, odd_unit=odd)

    def _with_length(self, words: Sequence[tuple[int, str]]) -> "Said":
        """SeismicHandler's files state the number of samples as LENGTH, beside DELTA."""
        bare = [text.strip().lstrip("#% \t")[:200] for _, text in words]
        length = next((int(found[1][:9]) for text in bare if (found := _LENGTH.fullmatch(text))), None)
        has_delta = any(re.match(r"delta\s*[:=]", text, re.IGNORECASE) for text in bare)
        return replace(self, count=length) if length and has_delta and self.count is None else self


def is_understood(text: str) -> bool:
    """Return whether what words say of a sampling is read here, all of it."""
    rest = text[:400]
    for form in _OF_STEPS:
        rest = form.sub(" ", rest)
    return not states_sampling(rest)


def _seconds_in(words: str) -> float:
    """Return the unit of time that the words around a step state, before or behind it [s]."""
    small = re.search(
        r"(?:[\W_]|\d)(?:(m(?:illi)?s(?:ec\w*)?)|[uµμ]s|micros(?:ec\w*)?)(?![^\W_])", words, re.IGNORECASE
    )
    return (1e-3 if small[1] else 1e-6) if small else 1.0


def _decimal(source: Source, line: int, word: str) -> float:
    return number(source, line, word.replace(",", "."))


def _names_of(bare: str, columns: int) -> tuple[str, ...] | None:
    called = names_on(bare)
    found = [ColumnName.of(place, one) for place, one in enumerate(called or ())]
    # words with a unit somewhere are names if they name a time, or are accelerations all
    named = any(one.is_time for one in found) or all(one.unit for one in found)
    return called if len(found) == columns and named and any(kind_of(one.behind)[1] for one in found) else None


def _refuse_others(source: Source, line: int, bare: str) -> None:
    if _SPECTRUM.search(bare):
        raise source.error(line, f"{bare[:40]!r}: a response spectrum is no record; motion.target= takes one")
    if _COUNTS.search(bare):
        raise source.error(line, f"{bare[:40]!r}: counts of a recorder are no accelerations; divide them first")
