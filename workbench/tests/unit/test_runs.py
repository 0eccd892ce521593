"""Commands and studies in one runner: neither waits for the other, and each kind has its limit."""

import json
import os
import sys

import pytest
from campaign_jobs import map_tables
from waiting import wait_for

from rocking_workbench.errors import NotFound
from rocking_workbench.questions.desk import QuestionDesk, QuestionFolder, QuestionRun
from rocking_workbench.records import RecordStore
from rocking_workbench.runs.runner import Runner
from rocking_workbench.settings import Limits
from rocking_workbench.studies.manager import StudyManager
from rocking_workbench.studies.study import HostedStudy

SPECTRUM = {"body": {"units": "cm", "width": 50, "height": 200}, "motion": {"pulse": "sine:amplitude=3,period=0.8"},
            "predict": {"count": 16}}  # fmt: skip
LONG = map_tables(1000, campaign={"name": "long", "kind": "overturning-map", "chunk": 4096},
                  settings={"longest_step": 0.004})  # fmt: skip


def served(folder, at_once=1):
    """Return desk and manager with one runner, as the application has them."""
    store, runner = RecordStore(folder, Limits()), Runner(at_once)
    desk = QuestionDesk(folder, (store,), Limits(), runner)
    return desk, StudyManager(folder, Limits(), store, runner, workers=1)


def test_a_command_does_not_wait_for_a_study(tmp_path):
    """Both run at the same time, the second of each kind waits, and the command has the higher priority."""
    desk, manager = served(tmp_path)
    studies = [manager.create(None, LONG) for _ in range(2)]
    wait_for(lambda: manager.get(studies[0])["state"] == "running")
    first, second = (desk.ask("predict", SPECTRUM, {}).id for _ in range(2))
    wait_for(lambda: desk.get(first).state != "waiting")
    assert (manager.get(studies[0])["state"], manager.get(studies[1])["state"]) == ("running", "waiting")
    assert desk.get(second).state == "waiting"
    if sys.platform != "win32":
        of_command = desk.runner.get(QuestionRun, first).process._process.pid
        of_study = desk.runner.get(HostedStudy, studies[0]).process._process.pid
        assert os.getpriority(os.PRIO_PROCESS, of_command) < os.getpriority(os.PRIO_PROCESS, of_study)
    assert (desk.stop(first).state, desk.stop(second).state) == ("stopped", "stopped")
    assert manager.get(studies[0])["state"] == "running"
    desk.close()
    assert [manager.get(study)["state"] for study in studies] == ["interrupted", "interrupted"]


def test_kinds_are_told_apart(tmp_path):
    """A study is no run of a command, a command is no study; a change of one is not told to listeners of the other."""
    desk, manager = served(tmp_path, at_once=0)
    told = []
    manager.queue.listeners.add((HostedStudy, lambda: told.append(1)))
    question = desk.ask("predict", SPECTRUM, {}).id
    assert told == []
    study = manager.create(None, LONG)
    assert told == [1]
    for act, name in ((desk.get, study), (desk.delete, study), (manager.get, question), (manager.cancel, question)):
        with pytest.raises(NotFound):
            act(name)
    assert (desk.get(question).state, manager.get(study)["state"]) == ("waiting", "waiting")
    desk.close()


def test_a_state_that_the_disk_did_not_take_is_written_later(tmp_path, monkeypatch):
    """The state of a command too, once there is room again."""
    monkeypatch.setattr("rocking_workbench.runs.runner.SAVE_AGAIN", 0.1)
    desk, _ = served(tmp_path, at_once=0)
    asked = desk.ask("predict", SPECTRUM, {})
    path = desk.folder / asked.id / "state.json"

    def full(*_):
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as without_room:
        without_room.setattr(QuestionFolder, "write", full)
        assert desk.stop(asked.id).state == "stopped"
        assert json.loads(path.read_bytes())["state"] == "waiting"
    wait_for(lambda: json.loads(path.read_bytes())["state"] == "stopped")
    desk.close()
