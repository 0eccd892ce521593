"""Questions in a process of their own: answered as the command line does, with what was sent and nothing else."""

import asyncio
import json
import shutil
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from waiting import HANG, allowed, wait_for

from rocking import plausibility
from rocking.motions import processed
from rocking.motions.formats import read_motion
from rocking_workbench.errors import NotFound, Refused, TooLarge
from rocking_workbench.questions.desk import OUTPUTS, QuestionDesk, QuestionRun, refuse_outside
from rocking_workbench.records import RecordStore
from rocking_workbench.settings import Limits

OCTETS = {"Content-Type": "application/octet-stream"}
TABLES = {
    "body": {"units": "cm", "width": 50, "height": 200},
    "motion": {"pulse": "sine:amplitude=3,period=0.8"},
    "predict": {"count": 16},
}
LIST = "name,width_cm,depth_cm,height_cm\nvase,20,20,100\nbox,?,20,30\n"
INVENTORY = {
    "campaign": {"name": "hall", "kind": "inventory"},
    "inventory": {"objects": "list.csv", "pga": "0.3g"},
    "motions": [{"synthetic": "point-source", "count": 5, "seed": 1}],
}


@pytest.fixture
def desk(tmp_path):
    store = RecordStore(tmp_path, Limits(), "files")
    kept = QuestionDesk(tmp_path, (store,), Limits())
    kept.store = store
    yield kept
    kept.close()


def ended(desk, question):
    """Wait for the end of a question."""
    wait_for(lambda: desk.get(question).state not in {"waiting", "running"})
    return desk.get(question)


def test_the_answer_is_that_of_the_command_line(desk, tmp_path, run):
    """The same JSON as the command prints for the same file, with a picture and a report beside it."""
    asked = desk.ask("predict", TABLES, {}, "cabinet")
    found = ended(desk, asked.id)
    assert (found.state, found.message, found.files) == ("done", "", ["picture.svg", "report.pdf", "table.csv"])
    (tmp_path / "same.toml").write_text(desk.tables(asked.id))
    assert json.loads(desk.answer(asked.id)) == json.loads(run("predict", tmp_path / "same.toml", "--json")[1])
    assert desk.file(asked.id, "picture.svg").read_bytes().startswith(b"<?xml")
    assert desk.file(asked.id, "report.pdf").read_bytes().startswith(b"%PDF")
    with pytest.raises(NotFound, match="unknown file"):
        desk.file(asked.id, "state.json")


def test_a_question_that_ends_while_it_is_read(desk, monkeypatch):
    """State and answer are of one moment: a page that saw "done" without an answer would not look again."""
    from types import SimpleNamespace

    from rocking_workbench.questions import router

    asked = desk.ask("predict", TABLES, {})
    real = desk.tables

    def tables(question):
        ended(desk, question)  # between the two readings of its state
        return real(question)

    monkeypatch.setattr(desk, "tables", tables)
    monkeypatch.setattr(router, "_desk", lambda _: desk)
    for state in ("running", "done"):
        wait_for(lambda: desk.get(asked.id).state != "waiting")
        answered = json.loads(asyncio.run(router.get_question(SimpleNamespace(), asked.id)).body)
        assert (answered["state"] == "done") == (answered["answer"] is not None), state


def test_a_list_that_was_sent_is_assessed(desk):
    """The file is found by the name that the tables give it; one that was not sent is refused."""
    sent = desk.store.add(LIST.encode(), "my list.csv")
    asked = desk.ask("inventory", INVENTORY, {"list.csv": sent.record})
    found = ended(desk, asked.id)
    assert found.state == "done", found.message
    answer = json.loads(desk.answer(asked.id))
    assert [each["name"] for each in answer["objects"] + answer["not_assessed"]] == ["vase", "box"]
    without = ended(desk, desk.ask("inventory", INVENTORY, {}).id)
    assert without.state == "refused"
    assert "list.csv" in without.message
    assert str(desk.folder) not in without.message


def test_the_paper_takes_nothing(desk):
    """What is recomputed from published measurements alone takes neither tables nor files, and can be stopped."""
    for tables, files in ((TABLES, {}), ({}, {"list.csv": desk.store.add(LIST.encode(), "list.csv").record})):
        with pytest.raises(Refused, match="accepts no tables and no files"):
            desk.ask("reproduce", tables, files)
    asked = desk.ask("reproduce", {}, {})
    assert (desk.tables(asked.id).strip(), desk.stop(asked.id).state) == ("", "stopped")


def test_commands_that_are_declared_are_those_that_run():
    """The schema names every command, and none that does not run."""
    from typing import get_args

    from rocking_workbench.questions.router import Command

    assert set(get_args(Command)) == set(OUTPUTS)


PLY = """ply
format ascii 1.0
element vertex 5
property float x
property float y
property float z
element face 6
property list uchar int vertex_indices
end_header
0 0 0
40 0 0
40 25 0
0 30 0
15 10 90
3 0 2 1
3 0 3 2
3 0 1 4
3 1 2 4
3 2 3 4
3 3 0 4
"""


def test_a_scan_is_asked_in_two_ways(desk, client):
    """One file with [response] serves both commands; each leaves a file of three dimensions; a cut one is refused."""
    tables = {"body": {"file": "spire.ply", "units": "cm"}, "response": {"friction": 0.5}}
    moved = {"motion": {"y": {"pulse": "sine:amplitude=4,period=0.5"}}, "restitution": {"value": 0.5}}
    sent = desk.store.add(PLY.encode(), "spire.ply")
    files = {"spire.ply": sent.record}
    for command, more, key in (("equilibria", {}, "stable"), ("simulate", moved, "intervals")):
        found = ended(desk, desk.ask(command, {**tables, **more}, files).id)
        assert (found.state, found.files) == ("done", ["picture.svg", "space.glb", "table.csv"]), found.message
        assert json.loads(desk.answer(found.id))[key]
        assert desk.file(found.id, "space.glb").read_bytes().startswith(b"glTF")
    cut = desk.store.add(PLY[:-20].encode(), "cut.ply")
    found = ended(desk, desk.ask("equilibria", tables, {"spire.ply": cut.record}).id)
    assert found.state == "refused"
    assert "file is complete" in found.message
    schema = client.get("/api/openapi.json").json()["paths"]["/api/questions/{question}/{file}"]
    assert "model/gltf-binary" in schema["get"]["responses"]["200"]["content"]


def test_what_is_refused_says_why(desk):
    """The sentence of the command line is the message; there is no answer, and no file."""
    wrong = {**TABLES, "body": {"units": "cm", "width": 50, "height": -2}}
    found = ended(desk, desk.ask("predict", wrong, {}).id)
    assert (found.state, found.files) == ("refused", [])
    assert "got -2" in found.message
    assert desk.answer(found.id) is None


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ({"body": {"file": "/etc/passwd"}}, "is a path"),
        ({"body": {"file": "../x.toml"}}, "is a path"),
        ({"body": {"file": "a/../../x.toml"}}, "is a path"),
        ({"motions": [{"records": ["~/x.at2"]}]}, "is a path"),
        ({"motions": [{"records": ["C:\\x.at2"]}]}, "is a path"),
        ({"restitution": {"model": "own.py:Model"}}, "code"),
    ],
)
def test_nothing_leads_out_of_a_question(desk, tables, words):
    """Paths of this computer and code are refused before anything runs."""
    with pytest.raises(Refused, match=words):
        desk.ask("predict", {**TABLES, **tables}, {})
    refuse_outside({"motion": {"units": "m/s2"}, "body": {"note": "as is... v1.2 / old"}})
    for name in ("../x", "state.json", "Report.pdf", "matplotlibrc", "a b"):
        with pytest.raises(Refused, match="plain"):
            desk.ask("predict", TABLES, {name: "0" * 64})


SPY = """
import sys
from pathlib import Path
from rocking_workbench.questions.child import keep_inside
inside, outside = Path(sys.argv[1]), Path(sys.argv[2])
if len(sys.argv) == 3:
    keep_inside(inside)
for path in (inside / "a.txt", outside / "b.txt", inside / "link.txt"):
    try:
        print(path.read_text())
    except PermissionError as error:
        print(error.strerror)
import json, tomllib, rocking, sqlite3, subprocess
for started in (lambda: subprocess.run(["true"]), lambda: sqlite3.connect(outside / "b.sqlite")):
    try:
        started()
        print("done")
    except PermissionError as error:
        print(error.strerror)
"""


@pytest.mark.parametrize("guarded", [True, False])
def test_a_process_opens_only_what_was_sent(tmp_path, guarded):
    """Neither another folder nor a link to it is read, libraries still are; without the guard, all of it is."""
    import subprocess

    inside, outside = tmp_path / "inside", tmp_path / "outside"
    for folder, name in ((inside, "a.txt"), (outside, "b.txt")):
        folder.mkdir()
        (folder / name).write_text(name)
    (inside / "link.txt").symlink_to(outside / "b.txt")
    words = [sys.executable, "-c", SPY, str(inside), str(outside), *(["no"] * (not guarded))]
    said = subprocess.run(words, capture_output=True, text=True, check=True).stdout.split()
    refused = ["not", "among", "the", "files", "that", "were", "sent"]
    no_program = ["a", "question", "starts", "no", "other", "program"]
    no_thing = ["a", "question", "does", "no", "such", "thing"]
    held = ["a.txt", *refused, *refused, *no_program, *no_thing]
    assert sorted(said) == sorted(held if guarded else ["a.txt", "b.txt", "b.txt", "done", "done"])


def test_a_list_cannot_name_a_file_of_this_computer(desk, tmp_path):
    """A body file that a list names is looked for among what was sent alone."""
    secret = tmp_path / "secret.csv"
    secret.write_text("0,0\n1,0\n1,2\n0,2\n")
    text = f"name,body_file,units\nvase,../../{secret.name},m\nbox,{secret},m\n"
    sent = desk.store.add(text.encode(), "list.csv")
    found = ended(desk, desk.ask("inventory", INVENTORY, {"list.csv": sent.record}).id)
    said = found.message if found.state == "refused" else desk.answer(found.id).decode()
    assert "1,2" not in said
    if found.state == "done":
        assert len(json.loads(said)["not_assessed"]) == 2


SHAKEN = "# time [s], acceleration [m/s2]\n" + "\n".join(
    f"{0.01 * k:.2f} {np.sin(0.2 * k) * np.exp(-0.003 * k) + 0.05:.6f}" for k in range(1200)
)


def test_a_record_is_corrected(desk, tmp_path):
    """What is written is the record after its steps, in the chosen format too; a step that cannot be is named."""
    sha = desk.store.add(SHAKEN.encode(), "hall.txt").record
    chain = ["mean", "bandpass:low=0.5,high=20", "taper"]
    tables = {"motion": {"record": "hall.txt", "process": chain}}
    found = ended(desk, desk.ask("record convert", tables, {"hall.txt": sha}, format="smc-usgs").id)
    assert found.files == ["picture.svg", "record.csv", "provenance.json", "record.smc"], found.message
    (tmp_path / "hall.txt").write_text(SHAKEN)
    with plausibility.before_processing():
        expected = processed(read_motion(tmp_path / "hall.txt"), chain)
    for name, share in (("record.csv", 1e-12), ("record.smc", 1e-4)):
        written = read_motion(desk.file(found.id, name)).acceleration
        assert written == pytest.approx(expected.acceleration, abs=share * expected.peak)
    answer = json.loads(desk.answer(found.id))
    assert answer["provenance"][1:] == list(expected.provenance)[1:]
    assert "the integrated velocity ends at" in answer["before"]["warnings"][0]
    assert answer["after"]["warnings"] == []
    assert answer["before"]["peak_ground_acceleration"] != pytest.approx(
        answer["after"]["peak_ground_acceleration"], rel=0.01
    )
    for process, why in ((["mean", "bandpass:low=1,high=80"], "step bandpass: high must be in (1, 50) Hz, got 80"),
                         (["response:stations=no.xml"], "no.xml")):  # fmt: skip
        tables = {"motion": {"record": "hall.txt", "process": process}}
        wrong = ended(desk, desk.ask("record convert", tables, {"hall.txt": sha}).id)
        assert wrong.state == "refused"
        assert why in wrong.message
    for command, form in (("record convert", "word"), ("record batch", "peer")):
        with pytest.raises(Refused, match="is allowed with"):
            desk.ask(command, tables, {}, format=form)


def test_no_record_at_all(desk):
    """A text that is no record is refused in words, alone and among others."""
    prose = desk.store.add(b"Dear all, please find no record here.\n", "letter.txt").record
    alone = ended(desk, desk.ask("record convert", {"motion": {"record": "letter.txt"}}, {"letter.txt": prose}).id)
    assert (alone.state, "unknown format" in alone.message) == ("refused", True)
    sent = {"records/letter.txt": prose, "records/hall.txt": desk.store.add(SHAKEN.encode(), "hall.txt").record}
    found = ended(desk, desk.ask("record batch", {"motions": [{"records": ["records"]}]}, sent).id)
    answer = json.loads(desk.answer(found.id))
    assert [Path(each["file"]).name for each in answer["left_out"]] == ["letter.txt"]
    assert [each["samples"] for each in answer["records"]] == [1200]
    for name in ("records", "records/../x.txt", "records/a/b.txt", "record.csv", "record.xyz"):
        with pytest.raises(Refused):
            desk.ask("record batch", {}, {name: prose})


def test_a_list_of_records_names_none_of_this_computer(desk, tmp_path):
    """What a list names is looked for among what was sent; another file of this computer is not opened."""
    (tmp_path / "secret.txt").write_text(SHAKEN)
    for name in (f"{tmp_path}/secret.txt", "../../../secret.txt"):
        sha = desk.store.add(f"motion\n{name}\n".encode(), "list.csv").record
        asked = desk.ask("record batch", {"motions": [{"records": ["records/list.csv"]}]}, {"records/list.csv": sha})
        found = ended(desk, asked.id)
        assert found.state == "refused"
        assert "1200" not in found.message


def test_crossings(desk):
    """The lowest acceleration at which a block overturns under a pulse, and where it stands again."""
    body = {"units": "cm", "width": 50, "height": 200, "depth": 50, "density": 2400}
    tables = {
        "campaign": {"name": "crossings", "kind": "minimum-acceleration"}, "body": body,
        "motions": [{"pulse": ["sine:amplitude=3,period=0.8"]}], "minimum": {"samples": 40, "bisections": 1},
    }  # fmt: skip
    found = ended(desk, desk.ask("overturning-pga", tables, {}).id)
    answer = json.loads(desk.answer(found.id))
    assert found.files == ["picture.svg", "table.csv"]
    assert answer["minimum_acceleration"] == answer["crossings"][0]["peak_ground_acceleration"]
    assert answer["minimum_acceleration"] > answer["uplift_acceleration"]


def test_a_body_cannot_name_a_file_of_this_computer(desk, tmp_path):
    """A mesh that a body file names is looked for among what was sent alone: beside it, it is read."""
    for where, state in ((tmp_path / "secret.ply", "refused"), (None, "done")):
        if where:
            where.write_text(PLY)
        name = "spire.ply" if where is None else str(where)
        text = f'units = "cm"\n[[solid.part]]\nmesh = {{ file = "{name}", units = "cm" }}\ndensity = 2000.0\n'
        files = {"body.toml": desk.store.add(text.encode(), "body.toml").record}
        files |= {"spire.ply": desk.store.add(PLY.encode(), "spire.ply").record}
        asked = desk.ask("equilibria", {"body": {"file": "body.toml"}, "response": {"friction": 0.5}}, files)
        found = ended(desk, asked.id)
        assert found.state == state, found.message
        assert state == "done" or "must be in the folder of the body file" in found.message


def test_what_cannot_be_run_stops_no_other(desk):
    """A folder that cannot be made refuses its question; the next one is answered."""
    cache = desk.folder.with_name("cache")
    cache.write_text("in the way")
    found = ended(desk, desk.ask("predict", TABLES, {}).id)
    assert (found.state, "could not start" in found.message) == ("refused", True)
    cache.unlink()
    assert ended(desk, desk.ask("predict", TABLES, {}).id).state == "done"


def test_stopped_deleted_and_gone_on_with(tmp_path):
    """One that waits or runs can be stopped; what a restart interrupts is answered after it; files go with it."""
    store = RecordStore(tmp_path, Limits(), "files")
    desk = QuestionDesk(tmp_path, (store,), Limits())
    long = {**TABLES, "predict": {"count": 20_000}, "motion": {"pulse": "sine:amplitude=4,period=0.8"}}
    first, second, third = (desk.ask("predict", each, {}) for each in (long, TABLES, TABLES))
    while desk.get(first.id).state == "waiting":
        time.sleep(0.01)
    assert desk.stop(second.id).state == "stopped"
    desk.close()
    again = QuestionDesk(tmp_path, (store,), Limits())
    assert [again.get(each.id).state for each in (second, third)] == ["stopped", "waiting"]
    assert again.stop(first.id).state == "stopped"
    assert ended(again, third.id).state == "done"
    again.delete(third.id)
    assert not (again.folder / third.id).exists()
    with pytest.raises(NotFound):
        again.get(third.id)
    assert [each.id for each in again.all()] == [second.id, first.id]
    again.close()


def test_questions_of_schema_1_open(tmp_path):
    """Notes with the command names of schema 1 have those of today; one of a later schema is left as it is."""
    kept = Path(__file__).parent / "kept_questions"
    shutil.copytree(kept, tmp_path / "questions")
    later = tmp_path / "questions/later"
    later.mkdir()
    (later / "state.json").write_text('{"schema": 99, "id": "later"}')
    desk = QuestionDesk(tmp_path, (RecordStore(tmp_path, Limits(), "files"),), Limits())
    opened = {question.name: (question.command, question.state) for question in desk.all()}
    assert opened == {
        "My cor": ("restitution", "done"), "My minimum": ("overturning-pga", "done"),
        "My convert": ("record convert", "done"), "My motions": ("record batch", "done"),
        "My paper": ("reproduce", "stopped"),
    }  # fmt: skip
    (crossings,) = (question for question in desk.all() if question.command == "overturning-pga")
    assert json.loads(desk.answer(crossings.id))["minimum_acceleration"] > 0.0
    desk.runner.get(QuestionRun, crossings.id).become("done")
    assert json.loads((desk.folder / crossings.id / "state.json").read_bytes())["schema"] == 2
    assert later.exists()
    desk.close()


def test_what_brings_the_server_down_is_not_asked_for_ever(tmp_path):
    """A note that says it was running when the server ended: begun anew twice, then refused; closing counts nothing."""
    store = RecordStore(tmp_path, Limits(), "files")
    long = {**TABLES, "predict": {"count": 20_000}, "motion": {"pulse": "sine:amplitude=4,period=0.8"}}
    for turn in range(4):
        desk = QuestionDesk(tmp_path, (store,), Limits())
        one = desk.get(desk.all()[0].id) if turn else desk.ask("predict", long, {})
        while desk.get(one.id).state == "waiting":
            time.sleep(0.01)
        while desk.get(one.id).state == "running" and desk.runner.get(QuestionRun, one.id).process is None:
            time.sleep(0.01)
        note = (desk.folder / one.id / "state.json").read_bytes()
        desk.close()
        if turn < 3:
            assert json.loads(note)["starts"] == turn + 1
            assert json.loads((desk.folder / one.id / "state.json").read_bytes())["starts"] == turn
            (desk.folder / one.id / "state.json").write_bytes(note)  # as a server that was killed leaves it
    assert (desk.get(one.id).state, "ended 3 times" in desk.get(one.id).message) == ("refused", True)


def test_the_disk_is_shared(tmp_path):
    """Questions have a limit of disk; of files that were sent the oldest go where a new one needs their room."""
    files = RecordStore(tmp_path, Limits(records_bytes=3000), "files", forgets=True)
    kept = []
    for k in range(4):
        kept.append(files.add(bytes([65 + k]) * 1000, f"{k}.txt").record)
        note = files.folder / f"{kept[-1]}.json"
        note.write_text(json.dumps({**json.loads(note.read_text()), "uploaded": f"200{k}"}))
    assert [each.record for each in files.stored()] == kept[:0:-1]
    with pytest.raises(TooLarge, match="may take up to"):
        files.add(b"x" * 3001, "large.txt")
    assert len(files.stored()) == 3
    desk = QuestionDesk(tmp_path, (files,), Limits(questions_bytes=1000))
    with pytest.raises(TooLarge, match="delete questions"):
        desk.ask("predict", TABLES, {})
    desk.close()


def test_over_the_api(client, stranger):
    """Sent, asked, watched and taken away."""
    assert stranger.get("/api/questions").status_code == 401
    sent = client.post("/api/files", params={"name": "list.csv"}, content=LIST.encode(), headers=OCTETS).json()
    asked = client.post(
        "/api/questions", json={"command": "inventory", "tables": INVENTORY, "files": {"list.csv": sent["record"]}}
    )
    assert asked.status_code == 202, asked.text
    where = f"/api/questions/{asked.json()['id']}"
    deadline = time.monotonic() + HANG
    while (found := client.get(where).json())["state"] in {"waiting", "running"}:
        assert time.monotonic() < deadline
        time.sleep(0.05)
    assert found["state"] == "done", found["message"]
    assert found["answer"]["objects"][0]["name"] == "vase"
    assert 'objects = "list.csv"' in found["toml"]
    page = client.get(f"{where}/inventory.html")
    assert page.headers["Content-Disposition"].startswith("attachment")
    assert client.get(f"{where}/answer.json").status_code == 404
    assert client.post("/api/questions", json={"command": "serve", "tables": {}}).status_code == 422
    assert client.post("/api/questions", json={"command": "predict", "tables": {}, "project": "x"}).status_code == 404
    assert client.delete(where).json() == {"deleted": asked.json()["id"]}
    assert client.get(where).status_code == 404


def test_a_question_knows_the_owners_own_models(desk, tmp_path, monkeypatch):
    """A model of the file that the owner names is known in the process of a question, which cannot read the file."""
    (tmp_path / "own.py").write_text(
        "import rocking as rk\nclass Own(rk.restitution.RestitutionModel):\n    name = 'own'\n"
        "    def raw_coefficient(self, body, foot):\n        return 0.5\n"
    )
    pulses = [{"pulse": ["sine:amplitude=3,period=0.8"]}]
    tables = {"body": TABLES["body"], "restitution": {"model": "own"}, "motions": pulses, "minimum": {"samples": 40}}
    asked = desk.ask("overturning-pga", tables, {})
    assert "unknown restitution model 'own'" in ended(desk, asked.id).message
    monkeypatch.setenv("ROCKING_MODELS", str(tmp_path / "own.py"))
    asked = desk.ask("overturning-pga", tables, {})
    assert ended(desk, asked.id).state == "done", desk.get(asked.id).message


def waits(process):
    """Wait until a process has loaded what it can, and waits for a question."""
    import psutil

    known, still = psutil.Process(process.pid), 0
    while still < 10:
        used = sum(known.cpu_times()[:2])
        time.sleep(0.05)
        still = still + 1 if sum(known.cpu_times()[:2]) == used > 0.3 else 0


def test_a_process_is_ready_before_it_is_asked(desk, monkeypatch):
    """It answers the next question, alone; other surroundings get another; without a server or questions it ends."""
    desk.prepare()
    first = desk._ahead
    desk.prepare()
    assert desk._ahead is first
    monkeypatch.setenv("ROCKING_MODELS", "")
    desk.prepare()
    second = desk._ahead
    assert (first.code is None, second is first) == (False, False)
    second.stop()
    desk.prepare()
    third = desk._ahead
    assert ended(desk, desk.ask("predict", TABLES, {}).id).state == "done"
    assert (third.code, desk._ahead) == (0, None)
    left = desk._process()._process
    left.stdin.close()
    assert left.wait(HANG) == 0
    desk.prepare()
    fourth = desk._ahead
    monkeypatch.setattr("rocking_workbench.runs.runner.IDLE", 0.1)
    desk.runner.changed()
    wait_for(lambda: fourth.code is not None)
    desk.prepare()
    desk.close()
    assert desk._ahead is None


@pytest.mark.speed
def test_a_question_about_a_record_is_quick(desk):
    """Half of the time of a processor goes into what was loaded ahead: the rest has a limit of 1.5 s."""
    sha = desk.store.add(SHAKEN.encode(), "hall.txt").record
    desk.prepare()
    waits(desk._ahead._process)
    begun = time.monotonic()
    tables = {"motion": {"record": "hall.txt", "process": ["mean", "taper"]}}
    assert ended(desk, desk.ask("record convert", tables, {"hall.txt": sha}).id).state == "done"
    assert time.monotonic() - begun < allowed(1.5)


def test_records_of_mixed_units(desk):
    """The options of single files go from the question to its records; a name that is none of them is refused."""
    wave = np.cos(0.2 * np.arange(200)) * 0.99 ** np.arange(200)
    sent = {name: desk.store.add("\n".join(f"{peak * value:.8f}" for value in wave).encode(), name).record
            for name, peak in (("a.txt", 0.3), ("b.txt", 300.0))}  # fmt: skip
    files = {f"records/{name}": sha for name, sha in sent.items()}
    table = {"records": ["records"], "time_step": 0.01, "units": "cm/s2"}

    def asked(options):
        return ended(desk, desk.ask("record batch", {"motions": [{**table, "files": options}]}, files).id)

    found = asked({"a.txt": {"units": "g"}})
    assert found.state == "done", found.message
    peaks = [row["pga_x"] for row in json.loads(desk.answer(found.id))["records"]]
    assert peaks == pytest.approx([0.3 * 9.80665, 3.0], rel=1e-6)
    assert '[motions.files."a.txt"]' in desk.tables(found.id)
    refused = asked({"c.txt": {"units": "g"}})
    assert (refused.state, "files: this set does not contain the file 'c.txt'" in refused.message) == ("refused", True)
    refused = asked({"a.txt": {"time_step": -1.0}})
    assert refused.message.startswith("motions[0].files.a.txt.time_step must be a number > 0, got -1")
