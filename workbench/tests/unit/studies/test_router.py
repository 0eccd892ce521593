"""Studies over HTTP and the websocket."""

import time
from typing import Any

import pytest
from starlette.websockets import WebSocketDisconnect
from waiting import HANG, allowed, wait_for

from rocking_workbench.settings import ServerSettings
from rocking_workbench.studies import router as live

Tables = dict[str, Any]
LIVE = f"{ServerSettings().origin.replace('http', 'ws')}/api/studies/live"


def _launched(client, job, name=None):
    answer = client.post("/api/studies", json={"name": name, "job": job})
    assert answer.status_code == 202, answer.text
    return str(answer.json()["id"])


def _wait(client, study, state):
    deadline = time.monotonic() + HANG
    while (facts := client.get(f"/api/studies/{study}").json())["state"] != state:
        assert time.monotonic() < deadline, facts
        time.sleep(0.05)
    return dict(facts)


def test_a_study_from_launch_to_file(client, map_job):
    """Launched, listed, done, looked at, a cell gone into by its inputs, taken away, deleted."""
    study = _launched(client, map_job(), "<b>Küste</b>")
    assert [each["id"] for each in client.get("/api/studies").json()["studies"]] == [study]
    _wait(client, study, "done")
    result = client.get(f"/api/studies/{study}/result").json()
    assert result["kind"] == "overturning-map"
    cell = client.get(f"/api/studies/{study}/cell", params={"x": 2, "y": 4, "restitution": 1}).json()
    assert cell["stored"]["outcome"] == result["outcome"][1][4][2]
    assert cell["stored"]["peak_ratio"] == result["peak"][1][4][2]
    answer = client.post("/api/response", json=cell["inputs"]).json()["answers"][0]
    for name in ("outcome", "peak_rotation", "impacts", "summary"):
        assert answer[name] == cell["answer"][name]
    file = client.get(f"/api/studies/{study}/export.csv")
    assert file.headers["content-disposition"] == 'attachment; filename="b-Kuste-b.csv"'
    assert file.headers["x-content-type-options"] == "nosniff"
    assert len(file.text.splitlines()) == 73
    assert client.delete(f"/api/studies/{study}").status_code == 200
    assert client.get(f"/api/studies/{study}").status_code == 404


@pytest.mark.speed
def test_a_result_is_quick(client, map_job):
    """A map of 100 x 100 with two restitutions has a limit of 100 ms once it was looked at."""
    study = _launched(client, map_job(100))
    _wait(client, study, "done")
    first = client.get(f"/api/studies/{study}/result")
    begun = time.perf_counter()
    again = client.get(f"/api/studies/{study}/result")
    assert time.perf_counter() - begun < allowed(0.1)
    assert again.content == first.content


@pytest.mark.parametrize(
    ("body", "status", "kind"),
    [
        ({}, 422, "invalid-value"), ({"job": 1}, 422, "invalid-value"), ({"job": {}}, 422, "invalid-value"),
        ({"job": {}, "x": 1}, 422, "invalid-value"), ({"name": 1, "job": {}}, 422, "invalid-value"),
        ({"name": "x" * 300, "job": {}}, 422, "invalid-value"),
    ],
)  # fmt: skip
def test_what_is_no_study_is_refused(body, status, kind, client):
    """In one sentence and with its kind."""
    answer = client.post("/api/studies", json=body)
    assert (answer.status_code, answer.json()["error"]["kind"]) == (status, kind)


def test_refusals_have_their_status(app, client, map_job):
    """Too large is 413, unknown 404, a file in the job or a result before its time 422."""
    large = map_job(10_000)
    assert client.post("/api/studies", json={"job": large}).status_code == 413
    hostile = map_job(motions={"records": ["/etc/passwd"]})
    assert client.post("/api/studies", json={"job": hostile}).status_code == 422
    assert client.post("/api/studies", json={"job": map_job(motions={"records": ["0" * 64]})}).status_code == 404
    for path in ("result", "cell", "export.csv", "export.svg"):
        assert client.get(f"/api/studies/{'0' * 16}/{path}").status_code == 404
    assert client.get(f"/api/studies/{'0' * 16}/export.exe").status_code == 422
    study = _launched(client, map_job(1000))
    assert client.get(f"/api/studies/{study}/result").status_code == 422
    assert client.get(f"/api/studies/{study}/export.csv").status_code == 422
    assert client.post(f"/api/studies/{study}/cancel").json()["state"] == "cancelled"


def test_a_full_line_is_429(app, client, map_job):
    """With the time after which to try again."""
    line = app.state.rocking.studies.queue
    line._at_once = 0
    for _ in range(8):
        _launched(client, map_job())
    answer = client.post("/api/studies", json={"job": map_job()})
    assert answer.status_code == 429
    assert int(answer.headers["retry-after"]) >= 1


def test_progress_is_pushed(client, long_job):
    """The websocket tells the list at once, then every change, at most five times a second, until the study is over."""
    with client.websocket_connect(LIVE) as socket:
        assert socket.receive_json() == {"studies": []}
        study = _launched(client, long_job)
        seen = []
        times = []
        while len(seen) < 8:
            (facts,) = socket.receive_json()["studies"]
            seen.append(facts)
            times.append(time.monotonic())
        client.post(f"/api/studies/{study}/cancel")
        while seen[-1]["state"] not in {"cancelled", "done", "failed"}:  # after these nothing more is told
            seen.append(socket.receive_json()["studies"][0])
    assert [each["state"] for each in seen][-1] == "cancelled"
    done = [each["histories_done"] for each in seen]
    assert done == sorted(done)
    assert done[-1] > 0
    assert (len(times) - 1) / (times[-1] - times[0]) < 6.0


def test_too_many_browsers_are_turned_away(client, monkeypatch):
    """One more than the server takes is closed; when one leaves there is room again."""
    monkeypatch.setattr(live, "MOST", 1)
    with client.websocket_connect(LIVE) as socket:
        socket.receive_json()
        with pytest.raises(WebSocketDisconnect), client.websocket_connect(LIVE) as other:
            other.receive_json()
    wait_for(lambda: not client.app.state.rocking.studies.queue.listeners)
    with client.websocket_connect(LIVE) as socket:
        assert socket.receive_json() == {"studies": []}


def test_strangers_see_nothing(stranger, settings):
    """Without a session there is no list, no study and no websocket."""
    assert stranger.get("/api/studies").status_code == 401
    with pytest.raises(WebSocketDisconnect), stranger.websocket_connect(LIVE, headers={"Origin": settings.origin}):
        pass


@pytest.mark.speed
def test_light_answers_stay_light_while_a_study_runs(client, long_job):
    """The list is answered from what is known: a hundred times in a row, in milliseconds each, while one computes."""
    study = _launched(client, long_job)
    _wait(client, study, "running")
    times = []
    for _ in range(100):
        begun = time.perf_counter()
        assert client.get("/api/studies").status_code == 200
        times.append(time.perf_counter() - begun)
    assert sorted(times)[98] < allowed(0.3)
    client.post(f"/api/studies/{study}/cancel")
