"""An application in a folder of its own, and those who ask it: our page, a script, a stranger."""

import pytest
from fastapi.testclient import TestClient
from web_clients import script_of

from rocking_workbench.application import create_app
from rocking_workbench.settings import ServerSettings


@pytest.fixture
def settings(tmp_path):
    return ServerSettings(folder=tmp_path / "data")


@pytest.fixture
def app(settings):
    settings.folder.mkdir()
    return create_app(settings)


@pytest.fixture
def client(app, settings):
    """Return a script that has the key and names its origin."""
    with script_of(app) as asking:
        yield asking


@pytest.fixture
def stranger(app, settings):
    """Return somebody who comes to the right address and is not signed in."""
    with TestClient(app, base_url=settings.origin) as somebody:
        yield somebody
