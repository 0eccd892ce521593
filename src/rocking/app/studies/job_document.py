"""The job that a browser sends: checked before anything is opened, and written as the job file of a campaign."""

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rocking.app.errors import TooLarge
from rocking.app.plain_text import toml_of
from rocking.errors import InvalidValueError
from rocking.restitution.from_file import file_of

if TYPE_CHECKING:
    from rocking.spec.document import CampaignDocument

KINDS = (
    "overturning-map", "minimum-acceleration", "rocking-spectrum", "stripes", "incremental", "cloud", "histories",
)  # fmt: skip
"""Kinds of campaigns that the application launches."""

_MEASURED = {"stripes", "incremental", "cloud", "minimum-acceleration"}
"""Kinds that need every motion before they begin."""

_QUICKLY_MADE = 200
_RECORD = re.compile(r"[0-9a-f]{64}\Z")
_FILES = {"file", "dxf", "geojson", "path"}
_DEEPEST, _MOST_VALUES = 12, 500_000


@dataclass(frozen=True)
class JobDocument:
    """A job as it came, and as its tables say it."""

    given: dict[str, Any]  # as it came; records are named by their hashes
    document: "CampaignDocument"  # the same, checked

    @classmethod
    def of(cls, given: object) -> "JobDocument":
        """Return a job that names no file, opens nothing, and fits its own kind."""
        from pydantic import ValidationError

        from rocking.bodies.formats.words import sentence
        from rocking.spec.document import CampaignDocument

        if not isinstance(given, dict):
            raise InvalidValueError(f"job must be an object of tables, as a job file has them, got {given!r:.60}")
        _refuse_what_is_too_much(given)
        _refuse_files(given)
        campaign = given.get("campaign")
        kind = campaign.get("kind") if isinstance(campaign, dict) else None
        if isinstance(kind, str) and kind not in KINDS:
            raise InvalidValueError(f"campaign.kind must be one of {', '.join(KINDS)}, got {kind!r:.60}")
        try:
            made = cls(given, CampaignDocument.model_validate(given))
        except ValidationError as error:
            raise InvalidValueError(f"job: {sentence(error, None)}") from error
        made._refuse_too_many()
        return made

    def _refuse_too_many(self) -> None:
        """Refuse what takes long to be made, however few its histories are."""
        document = self.document
        regions = sum(_checked_regions(table) for table in document.body or [])
        counts = {
            "regions of bodies": (regions, 1000),
            "restitutions": (_choices(document), 64),
            "bodies": (len(document.body or []), 1000),
            "states": (len(document.fragility.states) if document.fragility else 0, 20),
        }
        if document.spectrum is not None:
            table = document.spectrum
            blocks = _count(table.slenderness_angles) * _count(table.periods) * _choices(document)
            counts["blocks times restitutions"] = (blocks, 100_000)
        if self.kind in _MEASURED:
            counts["motions"] = (sum(_motions(each) for each in document.motions), 2000)
        for name, (count, most) in counts.items():
            if count > most:
                raise TooLarge(f"the job has {count} {name}; a page takes up to {most}, `rocking campaign` any number")

    @property
    def needs_long(self) -> bool:
        """Whether its motions take so long to be made that only its own process checks them."""
        many = sum(_motions(each) for each in self.document.motions) > _QUICKLY_MADE
        return self.kind in _MEASURED and many

    @property
    def kind(self) -> str:
        """What it computes."""
        return str(self.document.campaign.kind)

    @property
    def name(self) -> str:
        """What it is called there."""
        return str(self.document.campaign.name)

    @property
    def records(self) -> list[str]:
        """Hashes of the records that it names, each once."""
        return list(dict.fromkeys(name for table in self.document.motions for name in table.records or []))

    @property
    def histories(self) -> int:
        """How many histories it has, from its tables alone; of an adaptive study those of the first round."""
        return math.prod(_sizes(self.document))

    @property
    def most(self) -> int:
        """How many histories it may come to, roughly: a refined map goes on along its boundaries."""
        table = self.document.map
        if table is None or not table.refine:
            return self.histories
        boundary = 4 * (_count(table.x) + _count(table.y)) * 2**table.refine
        return int(self.histories + boundary * _choices(self.document))

    def toml(self, path_of: Callable[[str], str]) -> str:
        """Return the job as a job file."""
        told = {name: value for name, value in self.given.items() if value is not None}
        motions = told["motions"] if isinstance(told["motions"], list) else [told["motions"]]
        told["motions"] = [_with_paths(table, path_of) for table in motions]
        return toml_of(told)


def _with_paths(table: dict[str, Any], path_of: Callable[[str], str]) -> dict[str, Any]:
    names = table.get("records")
    if names is None:
        return table
    return {**table, "records": [path_of(name) for name in ([names] if isinstance(names, str) else names)]}


def _refuse_what_is_too_much(given: Any) -> None:
    """Refuse what is nested or long beyond any job, before anything walks through it by recursion."""
    level, count = [given], 0
    for _ in range(_DEEPEST):
        level = [item for each in level for item in _inside(each)]
        count += len(level)
        if count > _MOST_VALUES:
            raise InvalidValueError(f"job must have at most {_MOST_VALUES} values, got more; write ranges for lists")
        if not level:
            return
    raise InvalidValueError(f"job must be nested at most {_DEEPEST} deep, got more; as job files are")


def _inside(value: Any) -> list[Any]:
    if isinstance(value, dict):
        return list(value.values())
    return value if isinstance(value, list) else []


def _refuse_files(given: dict[str, Any]) -> None:
    """Refuse files by name: what is not on this page is uploaded, and then named by its hash."""
    for key in _keys(given.get("body")):
        if key in _FILES:
            raise InvalidValueError(f"body: {key} names a file, which a page cannot do; upload the file instead")
    for word in _words(given.get("restitution")):
        if file_of(word.strip()):  # it would be run
            raise InvalidValueError(
                f"restitution: {word!r:.60} names a file, which a page cannot do; see rocking campaign"
            )
    motions = given.get("motions")
    for table in motions if isinstance(motions, list) else [motions]:
        if isinstance(table, dict) and "vertical_file" in table:
            raise InvalidValueError(
                "motions.vertical_file names a file, which a page cannot do; upload one that has both components"
            )
        names = table.get("records") if isinstance(table, dict) else None
        for name in names if isinstance(names, list) else [names]:
            if name is not None and not (isinstance(name, str) and _RECORD.match(name)):
                raise InvalidValueError(
                    f"motions.records must be SHA-256 hashes of uploaded records (64 hexadecimal digits), "
                    f"got {name!r:.60}; upload the file first"
                )


def _words(value: Any) -> list[str]:
    inside = [value] if isinstance(value, str) else []
    return inside + [word for each in _inside(value) for word in _words(each)]


def _keys(value: Any) -> Iterator[str]:
    if isinstance(value, dict):
        yield from value
    for item in _inside(value):
        yield from _keys(item)


def _sizes(document: "CampaignDocument") -> list[int]:
    """Return the numbers whose product is that of the histories."""
    choices, motions = _choices(document), sum(_motions(each) for each in document.motions)
    kind, bodies = document.campaign.kind, len(document.body or [])
    if kind == "overturning-map" and document.map is not None:
        return [_count(document.map.x), _count(document.map.y), choices]
    if kind == "rocking-spectrum" and document.spectrum is not None:
        return [motions, _count(document.spectrum.slenderness_angles), _count(document.spectrum.periods), choices]
    if kind == "histories":
        scales = 1 if document.histories is None else _count(document.histories.scales)
        return [motions, bodies, scales, choices]
    if kind == "minimum-acceleration" and document.minimum is not None:
        return [motions, bodies, document.minimum.points, choices]
    levels = document.fragility.levels if document.fragility is not None else None
    return [motions, choices, 1 if levels is None else _count(levels)]


def _choices(document: "CampaignDocument") -> int:
    table = document.restitution
    return max(1, len(table.models or []) + len(table.values or []))


def _motions(table: Any) -> int:
    return int(table.count or 0) or len(table.records or []) or len(table.pulse or [])


def _checked_regions(table: dict[str, Any]) -> int:
    """Return the regions of a body, unless the body alone is larger than a page takes."""
    from pydantic import ValidationError

    from rocking.app.inputs import BodyInput

    try:
        body = BodyInput.model_validate(table)
    except ValidationError:  # the job is read later on, and refused in its own words
        return 0
    texts = [region.wkt or "" for region in body.section.region] if body.section else []
    return sum(max(1, text.count("((")) for text in texts)


def _count(values: Any) -> int:
    return len(values.values) if values.values is not None else int(values.count or 0)
