"""Projects: every state stays, undo and redo walk among them, and nothing is replaced without a way back."""

import json
import os
import signal
import subprocess
import sys
import time
from io import BytesIO
from zipfile import ZipFile

import numpy as np
import pytest
from hypothesis import given, settings, strategies
from web_clients import new_application, refusal

from rocking_workbench.errors import Conflict, NoRoom, NotFound, Refused, TooLarge
from rocking_workbench.projects import store as module
from rocking_workbench.projects.one_file import project_file, project_from_file
from rocking_workbench.projects.store import ProjectStore
from rocking_workbench.security.sessions import Sessions
from rocking_workbench.settings import Limits

OCTETS = {"Content-Type": "application/octet-stream"}


@pytest.fixture
def store(tmp_path):
    kept = ProjectStore(tmp_path, Limits())
    yield kept
    kept.close()


def test_undo_and_redo_walk_among_states(store):
    """Undo goes back, redo forth; what is saved after an undo begins another branch, and the first one stays."""
    project = store.create("A statue", {"n": 0})
    for n in (1, 2):
        project = store.save(project.id, project.version, {"n": n}, f"n = {n}")
    assert (store.document(project.id), project.can_undo, project.can_redo) == ({"n": 2}, True, False)
    project = store.undo(project.id, project.version)
    project = store.undo(project.id, project.version)
    assert (store.document(project.id), project.can_undo, project.can_redo) == ({"n": 0}, False, True)
    with pytest.raises(Refused, match="no earlier state"):
        store.undo(project.id, project.version)
    project = store.redo(project.id, project.version)
    assert store.document(project.id) == {"n": 1}
    project = store.save(project.id, project.version, {"n": 7}, "n = 7")
    assert not project.can_redo
    with pytest.raises(Refused, match="no later state"):
        store.redo(project.id, project.version)
    states = store.history(project.id)
    assert [store.document(project.id, each.number)["n"] for each in states] == [7, 2, 1, 0]
    assert [state.description for state in states] == ["n = 7", "n = 2", "n = 1", "begun"]
    assert [each.here for each in states] == [True, False, False, False]
    back = store.restore(project.id, project.version, states[1].number)
    assert store.document(back.id) == {"n": 2}
    assert back.can_undo
    assert store.document(store.undo(back.id, back.version).id) == {"n": 7}


class _Plain:
    """Undo and redo as a list of states and a place in it: what every program does."""

    def __init__(self):
        self.states, self.here = [0], 0

    def save(self, value):
        self.states = [*self.states[: self.here + 1], value]
        self.here += 1

    def move(self, by):
        self.here = min(max(self.here + by, 0), len(self.states) - 1)


@given(strategies.lists(strategies.sampled_from(["save", "undo", "redo"]), max_size=30))
@settings(max_examples=30, deadline=None)
def test_any_walk_is_that_of_a_list(tmp_path_factory, steps):
    """Whatever is done in whatever order, the project is where a plain list of states is."""
    store, plain = ProjectStore(tmp_path_factory.mktemp("data"), Limits()), _Plain()
    project = store.create("p", {"n": 0})
    for n, step in enumerate(steps, start=1):
        if step == "save":
            project = store.save(project.id, project.version, {"n": n}, "")
            plain.save(n)
        elif project.can_undo if step == "undo" else project.can_redo:
            project = getattr(store, step)(project.id, project.version)
            plain.move(-1 if step == "undo" else 1)
        assert store.document(project.id) == {"n": plain.states[plain.here]}
        assert (project.can_undo, project.can_redo) == (plain.here > 0, plain.here < len(plain.states) - 1)
    store.close()


def test_a_change_must_follow_the_latest(store):
    """Of two tabs that change the same version the second one is refused, and loses nothing of the first."""
    project = store.create("p", {})
    store.save(project.id, project.version, {"mine": 1}, "")
    for change in (store.undo, store.redo):
        with pytest.raises(Conflict, match="in another tab"):
            change(project.id, project.version)
    with pytest.raises(Conflict):
        store.save(project.id, project.version, {"yours": 1}, "")
    with pytest.raises(Conflict):
        store.rename(project.id, project.version, "q")
    assert store.document(project.id) == {"mine": 1}


def test_what_is_deleted_comes_back_for_a_while(store, tmp_path, monkeypatch):
    """A deleted project is not in the list, takes no change, and comes back as it was; after 90 days it is gone."""
    project = store.create("p", {"n": 1})
    gone = store.delete(project.id)
    assert store.all() == []
    assert [each.id for each in store.all(deleted=True)] == [project.id]
    with pytest.raises(Conflict, match="restore it first"):
        store.save(project.id, gone.version, {}, "")
    store.bring_back(project.id)
    assert store.document(project.id) == {"n": 1}
    assert store.all(deleted=True) == []
    store.delete(project.id)
    store.close()
    monkeypatch.setattr(module, "KEPT_DAYS", -1)
    later = ProjectStore(tmp_path, Limits())
    with pytest.raises(NotFound):
        later.get(project.id)
    assert later._database.execute("SELECT count(*) FROM states").fetchone() == (0,)
    later.close()


def test_limits(store, monkeypatch):
    """Size, number of projects, and states: the oldest go, and undo ends where they are gone."""
    with pytest.raises(TooLarge, match="1 MiB"):
        store.create("p", {"text": "x" * (1 << 20)})
    with pytest.raises(Refused, match="name"):
        store.create("  ", {})
    with pytest.raises(ValueError, match="Out of range"):
        store.create("p", {"n": float("nan")})
    monkeypatch.setattr(module, "MOST_STATES", 3)
    project = store.create("p", {"n": 0})
    for n in range(1, 6):
        project = store.save(project.id, project.version, {"n": n}, "")
    assert [store.document(project.id, each.number)["n"] for each in store.history(project.id)] == [5, 4, 3]
    for n in (4, 3):
        project = store.undo(project.id, project.version)
        assert store.document(project.id) == {"n": n}
    assert not project.can_undo
    with pytest.raises(NotFound, match="no state 1"):
        store.document(project.id, 1)
    monkeypatch.setattr(module, "MOST_PROJECTS", 1)
    with pytest.raises(TooLarge, match="up to 1 projects"):
        store.create("q", {})


def test_projects_have_a_limit_of_disk(tmp_path):
    """A database that is full refuses the next state, and keeps those that were saved."""
    store = ProjectStore(tmp_path, Limits(projects_bytes=1 << 16))
    project, noise = store.create("p", {}), np.random.default_rng(1)

    def saved(project):
        return store.save(project.id, project.version, {"noise": noise.bytes(5000).hex()}, "")

    for _ in range(4):
        project = saved(project)
    with pytest.raises(NoRoom, match="number of projects"):  # noqa: PT012 - one of them
        for _ in range(9):
            project = saved(project)
    assert len(store.history(project.id)) >= 5
    assert store.document(project.id)["noise"]
    store.close()


WRITER = """
import sys
from pathlib import Path
from rocking_workbench.projects.store import ProjectStore
from rocking_workbench.settings import Limits
store = ProjectStore(Path(sys.argv[1]), Limits())
project = store.create("p", {"n": 0}) if not store.all() else store.all()[0]
while True:
    n = store.document(project.id)["n"] + 1
    project = store.save(project.id, project.version, {"n": n, "text": "x" * 3000}, f"n = {n}")
    print(n, flush=True)
"""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="this system has no SIGKILL")
def test_killed_at_any_instant_it_loses_nothing_that_was_saved(tmp_path):
    """Killed while it saves, again and again: all that was said to be saved is there, and whole."""
    for turn in range(6):
        with subprocess.Popen([sys.executable, "-c", WRITER, str(tmp_path)], stdout=subprocess.PIPE, text=True) as one:
            first = int(one.stdout.readline())
            time.sleep(0.03 + 0.017 * turn)
            os.kill(one.pid, signal.SIGKILL)
            said = [first, *map(int, one.stdout.read().split())]
        store = ProjectStore(tmp_path, Limits())
        (project,) = store.all()
        n = store.document(project.id)["n"]
        assert said[-1] <= n <= said[-1] + 1
        assert [store.document(project.id, each.number)["n"] for each in store.history(project.id)] == [
            *range(n, -1, -1)
        ]
        store.close()


def test_over_the_api(client, stranger):
    """Made, saved, undone, renamed, copied, deleted and brought back; a stranger sees nothing."""
    assert stranger.get("/api/projects").status_code == 401
    made = client.post("/api/projects", json={"name": "Hall \u202e 3", "document": {"body": {"width": 1}}})
    assert made.status_code == 201
    project = made.json()
    assert (project["name"], project["document"], project["version"]) == ("Hall 3", {"body": {"width": 1}}, 1)
    where = f"/api/projects/{project['id']}"
    change = {"version": 1, "document": {"body": {"width": 2}}, "description": "width of the body"}
    saved = client.post(where, json=change)
    assert saved.json()["can_undo"] is True
    late = client.post(where, json=change)
    assert (late.status_code, late.json()["error"]["kind"]) == (409, "conflict")
    assert client.get(f"{where}/history").json()["states"][0]["description"] == "width of the body"
    undone = client.post(f"{where}/undo", json={"version": 2}).json()
    assert undone["document"] == {"body": {"width": 1}}
    assert client.post(f"{where}/redo", json={"version": 3}).json()["document"] == {"body": {"width": 2}}
    assert client.post(f"{where}/restore", json={"version": 4, "state": 1}).json()["document"] == project["document"]
    assert client.post(f"{where}/name", json={"version": 5, "name": "Hall 4"}).json()["name"] == "Hall 4"
    copy = client.post("/api/projects", json={"name": "Another", "copy_of": project["id"]}).json()
    assert copy["document"] == project["document"]
    assert copy["id"] != project["id"]
    assert client.delete(where).json()["deleted"]
    assert [each["id"] for each in client.get("/api/projects").json()["projects"]] == [copy["id"]]
    assert client.post(f"{where}/back").json()["deleted"] is None
    assert client.get("/api/projects/nowhere").status_code == 404
    assert client.post(where, json={"version": 1, "document": {}, "more": 1}).status_code == 422


def test_one_file_holds_all_of_it(client, tmp_path, monkeypatch):
    """Out as one file, and in on another computer: document, record and study are there, and the same file again."""
    wave = 0.3 * np.sin(2.0 * np.pi * np.arange(400) * 0.01)
    content = "\n".join(f"{k * 0.01:.2f} {value:.6f}" for k, value in enumerate(wave)).encode()
    record = client.post("/api/records", params={"name": "a.txt", "units": "g"}, content=content, headers=OCTETS)
    sha = record.json()["record"]
    sent = client.post("/api/files", params={"name": "vase.stl"}, content=b"solid vase", headers=OCTETS)
    scan = sent.json()["record"]
    forms = {"space": {"files": [{"name": "vase.stl", "sha": scan}]}}
    document = {"inputs": {"motion": {"record": sha, "units": "g"}}, "forms": forms}
    project = client.post("/api/projects", json={"name": "Hall 3", "document": document}).json()
    job = {
        "campaign": {"name": "s", "kind": "histories"},
        "body": [{"units": "m", "width": 0.5, "height": 2.0}],
        "motions": [{"records": [sha], "units": "g"}],
        "restitution": {"models": ["housner"]},
        "histories": {"scales": {"values": [1.0, 2.0]}},
    }
    launched = client.post("/api/studies", json={"job": job, "name": "scaled", "project": project["id"]})
    assert launched.status_code == 202, launched.text
    assert client.post("/api/studies", json={"job": job, "project": "nowhere"}).status_code == 404
    data = client.get(f"/api/projects/{project['id']}/file").content
    again = client.get(f"/api/projects/{project['id']}/file").content
    assert data == again
    assert ZipFile(BytesIO(data)).namelist() == ["project.json", f"{sha[:12]}-a.txt", f"{scan[:12]}-vase.stl"]

    state = new_application(tmp_path / "elsewhere").state.rocking
    other = project_from_file(state, data)
    assert (other.name, state.projects.document(other.id)) == ("Hall 3", document)
    assert (state.records.content(sha), state.files.content(scan)) == (content, b"solid vase")
    assert state.studies.of_project(other.id) == [("scaled", job)]
    assert project_file(state, other) == data
    twelve = ZipFile(BytesIO(data))
    whole = json.loads(twelve.read("project.json"))
    whole["studies"] *= 12
    with ZipFile(many := BytesIO(), "w") as archive:
        archive.writestr("project.json", json.dumps(whole))
        for name in twelve.namelist()[1:]:
            archive.writestr(name, twelve.read(name))
    brought = project_from_file(state, many.getvalue())
    assert len(state.studies.of_project(brought.id)) == 12 > state.settings.limits.studies_waiting
    monkeypatch.setattr("rocking_workbench.projects.one_file.MOST_FILES", 1)
    with pytest.raises(TooLarge, match=r"2 files with 0 MiB.*the largest is a\.txt, 0 MiB"):
        project_file(state, other)
    state.studies.close()
    state.projects.close()


def test_files_that_are_no_project_are_refused(client):
    """A text, an archive of something else, a changed record, a record that is missing: each says why."""

    def sent(files):
        stream = BytesIO()
        with ZipFile(stream, "w") as archive:
            for name, content in files.items():
                archive.writestr(name, content)
        return client.post("/api/projects/import", content=stream.getvalue(), headers=OCTETS)

    whole = {"format": "rocking project 1", "version": "1", "name": "p", "document": {}, "records": {}, "studies": []}
    assert sent({"project.json": json.dumps(whole)}).status_code == 201
    count = len(client.get("/api/projects").json()["projects"])
    sha = "0" * 64
    for files, words in (
        ({"readme.txt": "x"}, "project.json is missing"),
        ({"project.json": "{"}, "project.json"),
        ({"project.json": json.dumps({**whole, "format": "rocking project 9"})}, "rocking project 1"),
        ({"project.json": json.dumps({**whole, "records": {sha: "a.txt"}})}, "is missing in the archive"),
        (
            {
                "project.json": json.dumps({**whole, "records": {sha: "a.txt"}}),
                f"{sha[:12]}-a.txt": "0.0 1.0\n0.01 2.0\n",
            },
            "does not match its hash",
        ),
    ):
        answer = sent(files)
        assert words in refusal(answer)
    assert "one ZIP archive" in refusal(client.post("/api/projects/import", content=b"not a zip", headers=OCTETS))
    assert len(client.get("/api/projects").json()["projects"]) == count


def test_a_session_survives_a_restart(settings):
    """Whoever was signed in still is, after the server was ended and started; not with another cookie, nor for ever."""
    settings.folder.mkdir()
    kept, now = settings.folder / "sessions.json", [1000.0]
    before = Sessions(Limits(), lambda: now[0], kept)
    cookie, left = (before.sign_in(before.new_link()) for _ in range(2))
    before.sign_out(left)
    assert cookie not in kept.read_text()
    assert os.name == "nt" or kept.stat().st_mode & 0o77 == 0
    after = Sessions(Limits(), lambda: now[0], kept)
    assert (after.knows(cookie), after.knows(left), after.knows("x" + cookie)) == (True, False, False)
    now[0] += 12 * 3600.0 + 1.0
    assert not Sessions(Limits(), lambda: now[0], kept).knows(cookie)
    kept.write_text('{"ab": 1}')
    assert not Sessions(Limits(), lambda: 1000.0, kept).knows(cookie)
