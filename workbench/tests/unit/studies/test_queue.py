"""What goes wrong with one study touches no other: full disks, folders that are gone, requests that cross."""

import errno
import json
import random
import shutil
import signal
import subprocess
import sys
import threading
import time
from typing import Any

import pytest
from waiting import HANG, wait_for

from rocking.errors import RockingError
from rocking_workbench.errors import NoRoom, NotFound, Refused
from rocking_workbench.runs import runner
from rocking_workbench.studies import router
from rocking_workbench.studies.study import HostedStudy
from rocking_workbench.studies.study_folder import StudyFolder

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="other signals")

Tables = dict[str, Any]
ORPHAN = """
import signal, threading, time
signal.signal(signal.SIGINT, signal.SIG_IGN)
from rocking_workbench.runs.process import end_with_the_server
threading.Thread(target=end_with_the_server, daemon=True).start()
print("ready", flush=True)
time.sleep(3000.0)
"""


def _full(*_):
    raise OSError(errno.ENOSPC, "No space left on device")


def _told(manager, study):
    return dict(json.loads((manager._folder / study / "meta.json").read_text()))


def test_a_full_disk_stops_no_other_study(manager, map_job, monkeypatch, until):
    """States that cannot be written are known all the same, and written once there is room; the next study runs."""
    monkeypatch.setattr(runner, "SAVE_AGAIN", 0.1)
    manager.queue._at_once = 0
    first, second = manager.create(None, map_job()), manager.create(None, map_job())
    with monkeypatch.context() as full:
        full.setattr(StudyFolder, "write", _full)
        manager.queue._at_once = 1
        manager.queue.changed()
        for study in (first, second):
            assert until(manager, study, "done", "failed")["state"] == "done"
        assert _told(manager, first)["state"] == "waiting"
    wait_for(lambda: _told(manager, first)["state"] == "done")


def test_a_study_for_which_the_disk_is_full_is_refused(tmp_path, map_job, monkeypatch, idle):
    """In a sentence, and nothing is left of it."""
    manager = idle()
    monkeypatch.setattr(StudyFolder, "write", _full)
    with pytest.raises(NoRoom, match="full"):
        manager.create(None, map_job())
    assert list((tmp_path / "studies").iterdir()) == []


def test_a_folder_that_is_gone_stops_no_other_study(manager, map_job, until):
    """The study whose folder somebody removed fails, the one behind it is computed."""
    manager.queue._at_once = 0
    first, second = manager.create(None, map_job()), manager.create(None, map_job())
    shutil.rmtree(manager._folder / first)
    manager.queue._at_once = 1
    manager.queue.changed()
    assert until(manager, second, "done", "failed")["state"] == "done"
    assert "could not be started" in until(manager, first, "failed")["message"]
    manager.delete(first)
    with pytest.raises(NotFound):
        manager.get(first)


def test_a_study_that_cannot_be_looked_at_stops_no_other(manager, map_job, monkeypatch, until):
    """Whatever is raised: it fails, the next one is computed."""
    manager.queue._at_once = 0
    first, second = manager.create(None, map_job()), manager.create(None, map_job())
    look = HostedStudy.look

    def refuse(study):
        if study.folder.id == first and study.process is None and study.note.state == "running":
            raise ZeroDivisionError
        return look(study)

    monkeypatch.setattr(HostedStudy, "look", refuse)
    manager.queue._at_once = 1
    manager.queue.changed()
    assert "ZeroDivisionError" in until(manager, first, "failed")["message"]
    assert until(manager, second, "done", "failed")["state"] == "done"


def test_a_thread_that_died_is_begun_anew(manager, map_job, until):
    """The next change finds it dead, and studies run again."""
    dead = threading.Thread(target=lambda: None)
    dead.start()
    dead.join()
    manager.queue._thread = dead
    study = manager.create(None, map_job())
    assert until(manager, study, "done", "failed")["state"] == "done"


def test_what_was_deleted_does_not_come_back(tmp_path, map_job, idle):
    """A study that is deleted while it is put in line again is not there afterwards."""
    manager = idle()
    study = manager.create(None, map_job())
    found = manager.queue.get(HostedStudy, study)

    def crossed():
        manager.delete(study)
        return found

    with pytest.raises(NotFound):
        manager.queue.enter(HostedStudy, crossed)
    found.become("waiting")
    assert manager.overview() == []
    assert list((tmp_path / "studies").iterdir()) == []


def test_a_late_end_does_not_end_the_next_process(manager, long_job, until):
    """Of two requests that cancel one process the slower one does not touch the process of a resume between them."""
    study = manager.create(None, long_job)
    until(manager, study, "running")
    found = manager.queue.get(HostedStudy, study)
    before = found.process
    assert before is not None
    manager.cancel(study)
    manager.resume(study)
    until(manager, study, "running")
    manager.queue.end(found, before)
    assert found.process is not None
    assert manager.get(study)["state"] == "running"


def test_a_study_deleted_while_it_is_read_is_not_there(manager, map_job, monkeypatch, until):
    """Whoever reads its results is told that it is not there, not of a file that is missing."""
    study = manager.create(None, map_job())
    until(manager, study, "done")
    monkeypatch.setattr(manager.answers, "get", lambda *_: manager.delete(study) or _gone())
    with pytest.raises(NotFound):
        router._result(manager, study)


def _gone():
    raise FileNotFoundError(errno.ENOENT, "No such file or directory")


def test_requests_that_cross_are_refused_in_words(manager, map_job, until):
    """Eight at once create, cancel, resume and delete what they find: nothing but refusals, and the line goes on."""
    wrong = []
    end = time.monotonic() + 4.0

    def user(seed):
        draw = random.Random(seed)
        while time.monotonic() < end:
            names = [each["id"] for each in manager.overview()] or [""]
            acts = {
                "create": (None, map_job(2)),
                **dict.fromkeys(("cancel", "resume", "delete"), (draw.choice(names),)),
            }
            act = draw.choice(list(acts))
            try:
                getattr(manager, act)(*acts[act])
            except RockingError:
                continue
            except BaseException as error:  # noqa: BLE001 - any other class is what this looks for
                wrong.append(error)

    users = [threading.Thread(target=user, args=(seed,)) for seed in range(8)]
    for each in users:
        each.start()
    for each in users:
        each.join()
    assert not wrong, wrong[:3]
    for facts in manager.overview():
        manager.delete(facts["id"])
    assert until(manager, manager.create(None, map_job(2)), "done", "failed")["state"] == "done"


@pytest.mark.parametrize("told", ["{", '{"name": "x"}', "", '{"state": "archived"}'])
def test_a_study_that_is_not_understood_is_left_as_it_is(told, map_job, idle):
    """It is listed with the reason and neither resumed nor changed; it goes when the user says so."""
    manager = idle()
    study = manager.create(None, map_job())
    (manager._folder / study / "meta.json").write_text(told)
    before = sorted(path.name for path in (manager._folder / study).iterdir())
    again = idle()
    facts = again.get(study)
    assert facts["state"] == "failed"
    assert "cannot be read" in facts["message"]
    with pytest.raises(Refused, match="cannot be read"):
        again.resume(study)
    assert (manager._folder / study / "meta.json").read_text() == told
    assert sorted(path.name for path in (manager._folder / study).iterdir()) == before
    again.delete(study)
    assert not (manager._folder / study).exists()


def test_a_campaign_without_its_words_is_kept(map_job, idle):
    """Results are not removed because `meta.json` is not there."""
    manager = idle()
    study = manager.create(None, map_job())
    (manager._folder / study / "meta.json").unlink()
    (manager._folder / study / "campaign").mkdir()
    assert idle().get(study)["state"] == "failed"
    assert (manager._folder / study / "campaign").is_dir()


def test_a_server_starts_on_a_full_disk(map_job, monkeypatch, idle):
    """A study that was waiting waits again, though nothing can be written."""
    study = idle().create(None, map_job())
    monkeypatch.setattr(StudyFolder, "write", _full)
    again = idle()
    assert again.get(study)["state"] == "waiting"


def test_a_process_that_does_not_listen_ends_with_its_server():
    """Where the signal is ignored it is killed after the end of the pipe."""
    command = [sys.executable, "-c", ORPHAN]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True, text=True
    ) as orphan:
        assert orphan.stdin is not None
        assert orphan.stdout is not None
        assert orphan.stdout.readline() == "ready\n"
        orphan.stdin.close()
        try:
            code = orphan.wait(HANG)
        finally:
            orphan.kill()
        assert code == -signal.SIGKILL
