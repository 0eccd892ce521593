"""An application in a folder of its own, and those who ask it: our page, a script, a stranger."""

import warnings
from collections.abc import Iterator
from pathlib import Path

import pytest
from fastapi import FastAPI

from rocking.app.application import create_app
from rocking.app.settings import ServerSettings

with warnings.catch_warnings():  # it says that another client than httpx is coming
    warnings.simplefilter("ignore")
    from fastapi.testclient import TestClient


@pytest.fixture
def settings(tmp_path: Path) -> ServerSettings:
    return ServerSettings(folder=tmp_path / "data")


@pytest.fixture
def app(settings: ServerSettings) -> FastAPI:
    settings.folder.mkdir()
    return create_app(settings)


@pytest.fixture
def client(app: FastAPI, settings: ServerSettings) -> Iterator[TestClient]:
    """Return a script that has the key and names its origin."""
    head = {"Authorization": f"Bearer {app.state.rocking.sessions.key}", "Origin": settings.origin}
    with TestClient(app, base_url=settings.origin, headers=head) as script:
        yield script


@pytest.fixture
def stranger(app: FastAPI, settings: ServerSettings) -> Iterator[TestClient]:
    """Return somebody who comes to the right address and is not signed in."""
    with TestClient(app, base_url=settings.origin) as somebody:
        yield somebody
