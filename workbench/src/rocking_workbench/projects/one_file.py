"""A project as one file with inputs, records, other files, and the jobs of its studies."""

import io
import json
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Literal
from zipfile import ZipFile

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from rocking.bodies.formats.words import from_pydantic
from rocking.errors import RecordError, RockingError, located
from rocking.spec.schema import migrated_document
from rocking.version import __version__
from rocking_workbench.api.records import record_facts
from rocking_workbench.downloads.archive import Archive, add_file
from rocking_workbench.errors import NotFound, Refused, TooLarge
from rocking_workbench.inputs import levels
from rocking_workbench.plain_text import record_file_name
from rocking_workbench.projects.store import LARGEST, Project
from rocking_workbench.records import is_hash
from rocking_workbench.security.request_body import check_json
from rocking_workbench.studies.job_document import JobDocument

if TYPE_CHECKING:
    from rocking_workbench.settings import AppState

MOST_FILES, MOST_STUDIES = 1_000, 100  # largest numbers of files and of studies of a project
_WHAT = "project.json"
_FORMAT = "rocking project 1"
_DEEPEST = 32


class _Study(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)

    name: str
    job: dict[str, Any]


class _ProjectFile(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)

    format: Literal["rocking project 1"]
    version: str
    name: str
    document: dict[str, Any]
    records: dict[str, str]
    studies: list[_Study]
    files: dict[str, str] = Field(default_factory=dict)


def project_file(state: "AppState", project: Project) -> bytes:
    """Return a project as a reproducible archive."""
    document = state.projects.document(project.id)
    studies = [{"name": name, "job": job} for name, job in state.studies.of_project(project.id)]
    contents, records, files = dict[str, bytes](), dict[str, str](), dict[str, str]()
    for sha in _hashes([document, studies]):
        for store, names in ((state.records, records), (state.files, files)):
            with suppress(NotFound):  # a deleted file is omitted; the project reports the missing file later
                names[sha], contents[sha] = store.get(sha).file_name, store.content(sha)
    stream = io.BytesIO()
    with ZipFile(stream, "w") as archive:
        manifest = {
            "format": _FORMAT, "version": __version__, "name": project.name, "document": document, "records": records,
            "studies": studies, **({"files": files} if files else {}),
        }  # fmt: skip
        add_file(archive, _WHAT, json.dumps(manifest, indent=1, ensure_ascii=False).encode())
        for sha, content in contents.items():
            add_file(archive, f"{sha[:12]}-{record_file_name({**files, **records}[sha])}", content)
    data, most = stream.getvalue(), state.settings.limits.project_bytes
    if len(data) > most or len(contents) >= MOST_FILES:
        largest = max(contents, key=lambda sha: len(contents[sha]))
        named = record_file_name({**files, **records}[largest])
        raise TooLarge(
            "the project has {count} files with {size:.0f} MiB; {most_files} files with {most_size} MiB are allowed. "
            "Remove files (the largest is {largest}, {largest_size:.0f} MiB), delete studies with many files, or "
            "copy the data folder",
            count=len(contents),
            size=len(data) / 2**20,
            most_files=MOST_FILES - 1,
            most_size=most >> 20,
            largest=named,
            largest_size=len(contents[largest]) / 2**20,
        )
    return data


def project_from_file(state: "AppState", data: bytes) -> Project:
    """Store the project of a file under a new identifier and queue its studies."""
    if not Archive.begins(data):
        raise Refused("not a rocking project; a project is one ZIP archive")
    archive = Archive(data, MOST_FILES)
    if _WHAT not in archive.names:
        raise Refused("the archive is not a rocking project: {file} is missing", file=_WHAT)
    with located(_WHAT, "file"):
        content = archive.content(_WHAT, 8 * LARGEST)
        check_json(content, _DEEPEST)
        try:
            project_file = _ProjectFile.model_validate_json(content)
        except ValidationError as error:
            raise from_pydantic(error.errors(include_url=False), kind=Refused) from error
    if len(project_file.studies) > MOST_STUDIES:
        raise TooLarge(
            "a project file may contain {limit} studies, got {count}",
            limit=MOST_STUDIES,
            count=len(project_file.studies),
        )
    for study in project_file.studies:
        JobDocument.of(study.job)  # raises an error before any file is stored
    _keep_files(state, archive, project_file)
    project = state.projects.create(project_file.name, migrated_document(project_file.document), "from a file")
    try:
        for study in project_file.studies:
            state.studies.create(study.name, study.job, project.id, brought=True)
    except RockingError:
        state.projects.delete(project.id)
        raise
    return project


def _keep_files(state: "AppState", archive: Archive, project_file: _ProjectFile) -> None:
    for store, names in ((state.records, project_file.records), (state.files, project_file.files)):
        for sha, name in names.items():
            content = archive.content(_entry(archive, sha), store.largest)
            store.check_upload(content)
            if store is state.records:
                record_facts(content, name, {"format": None, "units": None, "time_step": None})
            if store.add(content, name).record != sha:
                raise RecordError("{record} in the archive does not match its hash", record=record_file_name(name))


def _entry(archive: Archive, sha: str) -> str:
    entry = next((name for name in archive.names if is_hash(sha) and name.startswith(f"{sha[:12]}-")), None)
    if entry is None:
        raise Refused("record {record:.12} is missing in the archive", record=sha)
    return entry


def _hashes(value: Any) -> list[str]:
    return list(dict.fromkeys(item for level in levels(value) for item in level if is_hash(item)))
