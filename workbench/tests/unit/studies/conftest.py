"""Studies that are computed here, without a server and its processes."""

import json
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from campaign_jobs import map_tables
from waiting import HANG

from rocking.campaigns.jobs import Job, JobFolder
from rocking_workbench.records import RecordStore
from rocking_workbench.runs.folder import new_id
from rocking_workbench.runs.runner import Runner
from rocking_workbench.settings import Limits
from rocking_workbench.studies.finished import OpenStudy
from rocking_workbench.studies.job_document import JobDocument
from rocking_workbench.studies.manager import StudyManager
from rocking_workbench.studies.study_folder import Meta, StudyFolder

Tables = dict[str, Any]


@pytest.fixture(scope="module")
def map_job() -> Callable[..., Tables]:
    """Return a function that makes the job of a small map, with some tables replaced."""
    return lambda count=6, **tables: map_tables(count, **tables)


@pytest.fixture
def long_job(map_job: Callable[..., Tables]) -> Tables:
    """Return a job that takes many seconds in small chunks, however fast the engine."""
    return map_job(1000, campaign={"name": "long", "kind": "overturning-map", "chunk": 4096},
                   settings={"longest_step": 0.004})  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the data folder of what is computed here."""
    return tmp_path_factory.mktemp("data")


@pytest.fixture(scope="module")
def records(folder: Path) -> RecordStore:
    return RecordStore(folder, Limits())


@pytest.fixture(scope="module")
def computed(folder: Path, records: RecordStore) -> Callable[[Tables], OpenStudy]:
    """Return a function that computes a job as the process of a study does, and opens it; the same job once."""
    known: dict[str, OpenStudy] = {}

    def compute(job: Tables) -> OpenStudy:
        key = json.dumps(job, sort_keys=True)
        if key not in known:
            document = JobDocument.of(job)
            study = StudyFolder(folder / "studies" / new_id())
            meta = Meta(document.document.campaign.name, document.kind, "2026-01-01T00:00:00Z", document.histories)
            study.create(meta, document, records)
            JobFolder.create(study.campaign, Job.read(study.path / "job.toml")).run(workers=1)
            known[key] = OpenStudy.of(study)
        return known[key]

    return compute


@pytest.fixture
def manager(tmp_path: Path, records: RecordStore) -> Iterator[StudyManager]:
    made = StudyManager(tmp_path, Limits(), records, workers=1)
    yield made
    made.close()


@pytest.fixture
def idle(tmp_path: Path, records: RecordStore) -> Callable[..., StudyManager]:
    """Return a function that makes a manager which runs nothing, with some limits replaced."""
    return lambda **limits: StudyManager(tmp_path, Limits(**limits), records, Runner(at_once=0), workers=1)


@pytest.fixture(scope="session")
def until() -> Callable[..., Tables]:
    """Return a function that waits for a state of a study, with some histories finished, and returns its facts."""

    def wait(manager: StudyManager, study: str, *states: str, done: int = 0) -> Tables:
        deadline = time.monotonic() + HANG
        while True:
            facts = manager.get(study)
            if facts["state"] in states and facts["histories_done"] >= done:
                return facts
            assert time.monotonic() < deadline, facts
            time.sleep(0.02)

    return wait
