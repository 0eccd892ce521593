"""What comments above columns say of them: names, unit, step and number, or that they are no accelerations."""

import re
from dataclasses import dataclass

from rocking.motions.formats import headers, numbers
from rocking.motions.formats.column_text import ColumnName, kind_of, names_on, readable, unit_named
from rocking.motions.formats.record import Source

_NUMBER = r"(\d*\.?\d+(?:[eE][-+]?\d+)?)"
_SAYS = r"\b[^\d=:]{0,20}[=:]\s*"
_BOTH = re.compile(rf"\bNPTS\s*,\s*DT\s*[=:]?\s*(\d+)[\s,]+{_NUMBER}", re.IGNORECASE)
_COUNT = re.compile(rf"\b(?:npts|nsamples|number of (?:points|samples|data)){_SAYS}(\d+)\b", re.IGNORECASE)
_STEP = re.compile(
    rf"\b(?:(?:dt|delta_?t|time[_ -]?(?:step|increment)|sampling[_ -](?:interval|period|step)){_SAYS}"
    rf"|(?:zeitschritt|abtastintervall|passo temporale|paso de tiempo)\b\s*[=:]?\s*)"
    r"(\d*[.,]?\d+(?:[eE][-+]?\d+)?)\s*(ms\b)?",
    re.I,
)
_SPECTRUM = re.compile(
    r"^\W*(?:periods?|t)\s*[\[(]\s*s(?:ec)?\s*[\])][\s,;|]+(?:p?s[adv]|spectral)(?![^\W_])", re.IGNORECASE
)
_COUNTS = re.compile(r"^\W*(?:raw\s+)?counts?\b(?!\s*[:=]?\s*\d)", re.IGNORECASE)
_RATE = re.compile(rf"\b(?:sampling|sample)[_ -](?:rate|freq\w*){_SAYS}{_NUMBER}", re.IGNORECASE)
_UNIT = re.compile(r"\bunits?\b\s*(?:[:=]|of|are|is|in)\s*[\[(]?\s*([A-Za-z][\w/^*.-]*)", re.IGNORECASE)
_UNIT_OF = re.compile(r"\b(?:accel|veloc|displ)\w*\s+(?:in\s+|\[|\()\s*([A-Za-z][\w/^*.-]*)", re.IGNORECASE)
_OTHER = re.compile(
    r"^\W*(?:ground )?(velocity|displacement)(?:\b.*(?:series|histor|record|trace)|\s*$)", re.IGNORECASE
)


@dataclass(frozen=True)
class Said:
    """What the comments of a file say; None and nothing where they are silent."""

    names: tuple[str, ...] | None = None
    unit: str | None = None  # a key of `rocking.conventions.ACCELERATION_UNITS`
    step: float | None = None  # [s]
    count: int | None = None

    @classmethod
    def of(cls, source: Source, comments: list[tuple[int, str]], columns: int) -> "Said":
        """Read comments by their lines; what speaks of velocities or displacements alone is refused."""
        names, unit, step, count = None, None, None, None
        for line, text in comments:
            bare = readable(text.strip().lstrip("#% \t")[:400])
            if _SPECTRUM.search(bare):
                raise source.error(line, f"{bare[:40]!r}: a response spectrum is no record; motion.target= takes one")
            if _COUNTS.search(bare):
                raise source.error(line, f"{bare[:40]!r}: counts of a recorder are no accelerations; divide them first")
            if both := _BOTH.search(bare):
                count, step = int(both[1][:9]), numbers.number(source, line, both[2])
            elif found := _COUNT.search(bare):
                count = int(found[1][:9])
            if not both and (found := _STEP.search(bare)):
                step = numbers.number(source, line, found[1].replace(",", ".")) * (1e-3 if found[2] else 1.0)
            if (found := _RATE.search(bare)) and (rate := numbers.number(source, line, found[1])) > 0.0:
                step = 1.0 / rate
            for word in (*_UNIT.findall(bare), *_UNIT_OF.findall(bare)):
                said = unit_named(source, line, word.rstrip(".-"))
                unit = headers.acceleration_unit(source, unit, said) if said else unit
            called = names_on(bare)
            found_names = [ColumnName.of(place, one) for place, one in enumerate(called or ())]
            # words with a unit somewhere are names if they name a time, or are accelerations all
            named = any(one.is_time for one in found_names) or all(one.unit for one in found_names)
            if len(found_names) == columns and named and any(kind_of(one.behind)[1] for one in found_names):
                names = called
        spoken = " ".join(text for _, text in comments).lower()
        other = next((one for _, text in comments if (one := _OTHER.match(text[:200]))), None)
        if other and not unit and not names and "accel" not in spoken:
            headers.refuse_other(source, other[1])
        return cls(names, unit, step, count)


def is_understood(text: str) -> bool:
    """Return whether a comment that speaks of a sampling says it in a way that is read here."""
    return any(form.search(text[:400]) for form in (_BOTH, _COUNT, _STEP, _RATE))
