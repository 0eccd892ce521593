"""Endpoints of projects: create, read, save, undo, redo, history, delete, restore, export and import."""

from collections.abc import Callable
from dataclasses import asdict
from typing import Annotated, Any

from fastapi import APIRouter, Request
from pydantic import BaseModel, ConfigDict, Field
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from rocking_workbench.answers import FILE_SENT, JsonAnswer, answered, answered_with_file, attachment, shape, shape_of
from rocking_workbench.projects.one_file import project_file, project_from_file
from rocking_workbench.projects.store import Project, ProjectState, ProjectStore
from rocking_workbench.settings import state_of
from rocking_workbench.work import heavy

router = APIRouter(prefix="/api/projects", tags=["projects"])
Name = Annotated[str, Field(min_length=1, max_length=200, description="display name")]
Version = Annotated[int, Field(ge=1, description="version before this change; a change of an older version is refused")]
_DOCUMENT = "body, motion, restitution and further inputs, possibly incomplete"

ProjectFacts: Any = shape_of(Project, "ProjectFacts")
Projects: Any = shape(
    "Projects", "All projects, last changed first.", projects=list[ProjectFacts], deleted=list[ProjectFacts]
)
WholeProject: Any = shape("WholeProject", "A project and its content.", ProjectFacts, document=dict[str, Any])
StateFacts: Any = shape_of(ProjectState, "StateFacts")
History: Any = shape("History", "All stored states, newest first.", states=list[StateFacts])


class _Request(BaseModel):
    model_config = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)


class NewProject(_Request):
    """A new project, with content or as a copy of another project."""

    name: Name
    document: Annotated[dict[str, Any], Field(description=_DOCUMENT)] = Field(default_factory=dict)
    copy_of: Annotated[str | None, Field(max_length=40, description="another project")] = None
    description: Annotated[
        str, Field(max_length=400, description="text of the first entry in the history of the project")
    ] = ""


class ProjectChange(_Request):
    """The new content of a project."""

    version: Version
    document: Annotated[dict[str, Any], Field(description=_DOCUMENT)]
    description: Annotated[str, Field(max_length=200, description="description of the change")] = "changed"


class ProjectStep(_Request):
    """A change with the version on which it is based."""

    version: Version


class ProjectName(ProjectStep):
    """The new name of a project."""

    name: Name


class ProjectPast(ProjectStep):
    """A state of the history."""

    state: Annotated[int, Field(ge=1)]


_WHOLE = answered(WholeProject, "The current project.")
_FACTS = answered(ProjectFacts, "The current project.")


def _store(request: Request) -> ProjectStore:
    return state_of(request).projects


async def _whole(request: Request, change: Callable[[ProjectStore], Project], status: int = 200) -> JsonAnswer:
    def changed() -> dict[str, Any]:
        store = _store(request)
        with store.lock:
            project = change(store)
            return {**asdict(project), "document": store.document(project.id)}

    return JsonAnswer(await run_in_threadpool(changed), status_code=status)


@router.get("", summary="All projects", responses=answered(Projects, "The projects."))
async def list_projects(request: Request) -> JsonAnswer:
    """Return all projects, and the deleted projects that can be restored."""
    store = _store(request)
    there, gone = await run_in_threadpool(lambda: (store.all(), store.all(deleted=True)))
    return JsonAnswer({"projects": [*map(asdict, there)], "deleted": [*map(asdict, gone)]})


@router.post("", status_code=201, summary="Make a project", responses=answered(WholeProject, "The project.", 201))
async def create_project(request: Request, new: NewProject) -> JsonAnswer:
    """Create a project, optionally as a copy."""

    def made(store: ProjectStore) -> Project:
        if new.copy_of is None:
            return store.create(new.name, new.document)
        description = new.description or f"a copy of {store.get(new.copy_of).name}"
        return store.create(new.name, store.document(new.copy_of), description)

    return await _whole(request, made, 201)


@router.post(
    "/import",
    status_code=201,
    openapi_extra=FILE_SENT,
    summary="Import a project file",
    responses=answered(WholeProject, "The project.", 201),
)
async def import_project(request: Request) -> JsonAnswer:
    """Store the project of a file and queue its studies."""
    state, data = state_of(request), await request.body()
    project = await heavy(request, project_from_file, state, data)
    return await _whole(request, lambda store: store.get(project.id), 201)


@router.get("/{project}", summary="One project", responses=_WHOLE)
async def get_project(request: Request, project: str) -> JsonAnswer:
    """Return a project and its content."""
    return await _whole(request, lambda store: store.get(project))


@router.post("/{project}", summary="Save a project", responses=_FACTS)
async def save_project(request: Request, project: str, change: ProjectChange) -> JsonAnswer:
    """Save a new state of a project; earlier states are kept."""
    saved = await run_in_threadpool(
        _store(request).save, project, change.version, change.document, change.description or "changed"
    )
    return JsonAnswer(asdict(saved))


@router.post("/{project}/undo", summary="Undo the last change", responses=_WHOLE)
async def undo_project(request: Request, project: str, step: ProjectStep) -> JsonAnswer:
    """Restore the previous state."""
    return await _whole(request, lambda store: store.undo(project, step.version))


@router.post("/{project}/redo", summary="Redo the last undone change", responses=_WHOLE)
async def redo_project(request: Request, project: str, step: ProjectStep) -> JsonAnswer:
    """Restore the state that was undone last."""
    return await _whole(request, lambda store: store.redo(project, step.version))


@router.get("/{project}/history", summary="Every state of a project", responses=answered(History, "The states."))
async def project_history(request: Request, project: str) -> JsonAnswer:
    """Return all stored states, newest first."""
    states = await run_in_threadpool(_store(request).history, project)
    return JsonAnswer({"states": [*map(asdict, states)]})


@router.post("/{project}/restore", summary="Restore a state of the history", responses=_WHOLE)
async def restore_project(request: Request, project: str, past: ProjectPast) -> JsonAnswer:
    """Save an earlier state of a project as a new state."""
    return await _whole(request, lambda store: store.restore(project, past.version, past.state))


@router.post("/{project}/name", summary="Rename a project", responses=_FACTS)
async def rename_project(request: Request, project: str, named: ProjectName) -> JsonAnswer:
    """Rename a project."""
    return JsonAnswer(asdict(await run_in_threadpool(_store(request).rename, project, named.version, named.name)))


@router.delete("/{project}", summary="Delete a project", responses=_FACTS)
async def delete_project(request: Request, project: str) -> JsonAnswer:
    """Delete a project; it can be restored."""
    return JsonAnswer(asdict(await run_in_threadpool(_store(request).delete, project)))


@router.post("/{project}/back", summary="Restore a deleted project", responses=_FACTS)
async def bring_project_back(request: Request, project: str) -> JsonAnswer:
    """Restore a deleted project."""
    return JsonAnswer(asdict(await run_in_threadpool(_store(request).bring_back, project)))


@router.get(
    "/{project}/file", summary="Export a project as one file", responses=answered_with_file("The project.", "zip")
)
async def project_as_file(request: Request, project: str) -> Response:
    """Return a project with its records and the jobs of its studies."""
    state = state_of(request)
    kept = state.projects.get(project)
    return attachment(await heavy(request, project_file, state, kept), f"{kept.name} project.zip")
