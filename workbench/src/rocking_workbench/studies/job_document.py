"""Jobs from browsers, checked and written as job files of campaigns."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import chain
from typing import Any

from pydantic import ValidationError

from rocking.bodies.formats.schema import TABLES, RegionTable
from rocking.errors import InvalidValueError, located
from rocking.restitution.from_file import file_of
from rocking.spec.motion_tables import MotionTable
from rocking.spec.question import StudyQuestion
from rocking.spec.questions import question_in, questions
from rocking_workbench.errors import TooLarge
from rocking_workbench.inputs import MOTION_KEYS, BodyInput, levels
from rocking_workbench.plain_text import toml_of
from rocking_workbench.records import is_hash

_QUICKLY_MADE = 200
MOST_MOTIONS = 2000
_MOST = {
    "restitutions": 64, "bodies": 1000, "states": 20, "blocks times restitutions": 100_000, "motions": MOST_MOTIONS
}  # fmt: skip
_FILES = {"file", "dxf", "geojson", "path"}
_BODY_KEYS = {
    "slenderness_angle", "semi_diagonal", *BodyInput.model_fields, *RegionTable.model_fields,
    *(key for table in TABLES.values() for key in table.model_fields),
} - {*_FILES, "layers"}  # fmt: skip
"""Keys of a body that a request may use. No key names a file of the server."""

_DEEPEST, _MOST_VALUES = 12, 500_000


def launched_kinds() -> tuple[str, ...]:
    """Return the kinds of campaigns without file names in their own table."""
    return tuple(kind for kind, question in questions().items() if not question.names_files)


@dataclass(frozen=True)
class JobDocument:
    """A job: received tables and checked document."""

    tables: dict[str, Any]  # received tables, with records named by their hashes
    document: StudyQuestion  # checked tables

    @classmethod
    def of(cls, tables: object) -> "JobDocument":
        """Return a checked job without file names."""
        if not isinstance(tables, dict):
            raise InvalidValueError(
                parameter="job", allowed="an object of tables, as a job file has them", value=tables
            )
        _check_extent(tables)
        _refuse_files(tables)
        campaign = tables.get("campaign")
        kind = campaign.get("kind") if isinstance(campaign, dict) else None
        if isinstance(kind, str) and kind not in (kinds := launched_kinds()):
            raise InvalidValueError(parameter="campaign.kind", allowed=f"one of {', '.join(kinds)}", value=kind)
        with located("job"):
            job = cls(tables, question_in(tables))
        job._check_counts()
        return job

    def _check_counts(self) -> None:
        """Refuse jobs with too many elements."""
        document = self.document
        counts = {"restitutions": document.choices, "bodies": len(document.bodies), **document.elements}
        counts |= {"motions": document.motion_count} if document.needs_motions else {}
        most = {"regions of bodies": 1000} | dict.fromkeys(counts, 100_000) | _MOST
        for name, count in {"regions of bodies": sum(map(_checked_regions, document.bodies)), **counts}.items():
            if count > most[name]:
                raise TooLarge(
                    "the job has {count} {items}; {limit} are allowed here, `rocking campaign` has no limit",
                    count=count, items=name, limit=most[name],
                )  # fmt: skip

    @property
    def needs_long(self) -> bool:
        """True if the motions are checked only in the process of the study."""
        return self.document.needs_motions and self.document.motion_count > _QUICKLY_MADE

    @property
    def kind(self) -> str:
        """Kind of the study."""
        return self.document.kind

    @property
    def records(self) -> list[str]:
        """Unique hashes of the records."""
        return list(dict.fromkeys(name for table in self.document.motions for name in table.records or []))

    @property
    def histories(self) -> int:
        """Number of simulations; for an adaptive study, in the first round."""
        return math.prod(self.document.sizes)

    @property
    def most(self) -> int:
        """Approximate largest number of simulations."""
        return self.histories + self.document.later_histories

    def toml(self, path_of: Callable[[str], str]) -> str:
        """Return the job as a job file."""
        motions = [dict(table) for table in _listed(self.tables.get("motions") or [])]
        for table in motions:
            if table.get("records") is not None:
                table["records"] = [path_of(name) for name in _listed(table["records"])]
        return toml_of({**self.tables, **({"motions": motions} if motions else {})})


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value]


def _check_extent(tables: Any) -> None:
    """Refuse jobs with too many values or too deep nesting."""
    count = -1  # the job itself does not count
    for depth, level in enumerate(levels(tables)):
        count += len(level)
        if count > _MOST_VALUES:
            raise InvalidValueError(
                "{parameter} must have at most {limit} values, got more", parameter="job", limit=_MOST_VALUES,
                hint="use ranges instead of lists",
            )  # fmt: skip
        if depth >= _DEEPEST:
            raise InvalidValueError(
                "{parameter} must be nested at most {limit} deep, got more", parameter="job", limit=_DEEPEST,
                hint="use the structure of a job file",
            )  # fmt: skip


def _refuse_files(tables: dict[str, Any]) -> None:
    """Refuse file names; files are uploaded and named by hash."""
    for item in chain.from_iterable(levels(tables.get("body"))):
        for key in item if isinstance(item, dict) else ():
            if key in _FILES:
                raise InvalidValueError(
                    "body: {key} names a file, which is not allowed here", key=key, hint="upload the file instead"
                )
            if key not in _BODY_KEYS:
                raise InvalidValueError("body: unknown key {key!r:.60}", key=key)
    for word in chain.from_iterable(levels(tables.get("restitution"))):
        if isinstance(word, str) and file_of(word.strip()):  # a file would be run as code
            raise InvalidValueError(
                "restitution: {model!r:.60} names a file, which is not allowed here", model=word,
                hint="use rocking campaign",
            )  # fmt: skip
    for table in _listed(tables.get("motions")):
        if isinstance(table, dict):
            _refuse_record_files(table)


def _refuse_record_files(table: dict[str, Any]) -> None:
    """Refuse keys of a motion that name a file."""
    if table.get("files") is not None:
        raise InvalidValueError(
            "motions.files is not allowed here; write one table of motions per unit, with the hashes of its records"
        )
    for key in sorted(MotionTable.model_fields.keys() & table.keys() - MOTION_KEYS - {"records"}):
        raise InvalidValueError(
            "{parameter} names a file, which is not allowed here", parameter=f"motions.{key}",
            hint="upload one file with both components",
        )  # fmt: skip
    for name in _listed(table.get("records")):
        if name is not None and not is_hash(name):
            raise InvalidValueError(
                parameter="motions.records", allowed="SHA-256 hashes of uploaded records (64 hexadecimal digits)",
                value=name, hint="upload the file first",
            )  # fmt: skip


def _checked_regions(table: dict[str, Any]) -> int:
    """Return the number of regions of a body, 0 for an invalid body."""
    try:
        body = BodyInput.model_validate(table)
    except ValidationError:  # the error follows when the job is read
        return 0
    texts = [region.wkt or "" for region in body.section.region] if body.section else []
    return sum(max(1, text.count("((")) for text in texts)
