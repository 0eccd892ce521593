"""Studies in a queue: launched, watched, stopped, resumed; how fast they are."""

import json
import os
from typing import Any

import pytest

from rocking.campaigns.jobs import Job, JobFolder
from rocking.errors import InvalidValueError
from rocking_workbench.answers import JsonAnswer
from rocking_workbench.errors import Busy, NotFound, Refused, TooLarge
from rocking_workbench.settings import Limits
from rocking_workbench.studies.finished import OpenStudy
from rocking_workbench.studies.manager import StudyManager
from rocking_workbench.studies.results import kept_result, result_of
from rocking_workbench.studies.study import HostedStudy, StudyPace

Tables = dict[str, Any]


def test_a_study_is_computed_in_a_process(manager, map_job, until):
    """It is launched, runs, is done, and says how many histories it has."""
    study = manager.create("  My\n study ", map_job())
    assert manager.get(study)["name"] == "My study"
    facts = until(manager, study, "done")
    assert facts["histories"] == facts["histories_done"] == 72
    assert facts["message"] == ""
    folder = manager.finished(study)
    assert kept_result(folder) == bytes(JsonAnswer(result_of(OpenStudy.of(folder))).body)


def test_cancel_leaves_no_process_and_resume_goes_on(manager, long_job, until):
    """What was finished when it was cancelled is not computed again; no process is left."""
    study = manager.create(None, long_job)
    until(manager, study, "running", done=1)
    child = manager.queue.get(HostedStudy, study).process
    assert child is not None
    manager.cancel(study)
    facts = manager.get(study)
    assert facts["state"] == "cancelled"
    assert 0 < facts["histories_done"] < facts["histories"]
    with pytest.raises(ProcessLookupError):
        os.killpg(child._process.pid, 0)
    before = {path.name: path.stat().st_mtime_ns for path in (manager._folder / study).rglob("shards/*.shard")}
    manager.resume(study)
    until(manager, study, "running", done=facts["histories_done"] + 1)
    manager.cancel(study)
    after = {path.name: path.stat().st_mtime_ns for path in (manager._folder / study).rglob("shards/*.shard")}
    assert before.items() <= after.items()
    assert manager.get(study)["histories_done"] > facts["histories_done"]


def test_one_runs_and_the_others_wait(manager, long_job, map_job, until):
    """The second begins when the first is out of the way; one that waits is cancelled at once."""
    first, second, third = (manager.create(None, job) for job in (long_job, map_job(), map_job()))
    until(manager, first, "running")
    assert [manager.get(each)["state"] for each in (second, third)] == ["waiting", "waiting"]
    manager.cancel(second)
    assert manager.get(second)["state"] == "cancelled"
    manager.delete(first)
    until(manager, third, "done")
    with pytest.raises(NotFound):
        manager.get(first)
    assert not (manager._folder / first).exists()


def test_studies_of_a_closed_server_go_on_by_themselves(tmp_path, records, long_job, map_job, until):
    """What ran and what waited goes on with the next start, in the order it was launched; what was cancelled stays."""
    manager = StudyManager(tmp_path, Limits(), records, workers=1)
    studies = [manager.create(None, job) for job in (long_job, map_job(), map_job())]
    manager.cancel(studies[2])
    done = until(manager, studies[0], "running", done=1)["histories_done"]
    manager.close()
    told = [json.loads((tmp_path / "studies" / study / "meta.json").read_text()) for study in studies]
    assert [each["state"] for each in told] == ["interrupted", "interrupted", "cancelled"]
    assert all("with the next server" in each["message"] for each in told[:2])
    again = StudyManager(tmp_path, Limits(), records, workers=1)
    assert [again.get(study)["state"] for study in studies] in (
        ["waiting", "waiting", "cancelled"], ["running", "waiting", "cancelled"],
    )  # fmt: skip
    assert until(again, studies[0], "running", done=done + 1)["message"] == ""
    again.cancel(studies[0])
    assert until(again, studies[1], "done")["histories_done"] == 72
    assert again.get(studies[2])["state"] == "cancelled"
    again.close()


def test_a_server_that_was_killed_finds_its_studies(tmp_path, map_job, idle):
    """Running waits again at the next start, but is done where all is finished; what was half made or deleted goes."""
    manager = idle()
    running, complete, torn = (manager.create(None, map_job()) for _ in range(3))
    for study in (running, complete):
        path = tmp_path / "studies" / study / "meta.json"
        path.write_text(json.dumps(json.loads(path.read_text()) | {"state": "running"}))
    folder = manager.queue.get(HostedStudy, complete).folder
    JobFolder.create(folder.campaign, Job.read(folder.path / "job.toml")).run(workers=1)
    (tmp_path / "studies" / torn / "meta.json").unlink()
    (tmp_path / "studies" / ".deleted-x").mkdir()
    again = idle()
    assert {each["id"]: each["state"] for each in again.overview()} == {running: "waiting", complete: "done"}
    assert again.get(complete)["histories_done"] == 72
    assert sorted(path.name for path in (tmp_path / "studies").iterdir()) == sorted([running, complete])


def test_links_and_strange_names_are_no_studies(tmp_path, idle):
    """A link in the folder of studies is not followed, nor removed with what it points to."""
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "kept").write_text("x")
    studies = tmp_path / "studies"
    studies.mkdir()
    (studies / ("0" * 16)).symlink_to(outside)
    (studies / "something").mkdir()
    assert idle().overview() == []
    assert (outside / "kept").exists()


def test_too_many_histories_are_refused_with_the_number(tmp_path, map_job, idle):
    """The limit itself is allowed, one more is not; refinement counts, and nothing is made of what is refused."""
    manager = idle(histories=72)
    manager.create(None, map_job())
    with pytest.raises(TooLarge, match="98 simulations, 72 are allowed"):
        manager.create(None, map_job(7))
    refined = map_job(restitution={"model": "ked"})
    refined["map"]["refine"] = 12
    with pytest.raises(TooLarge, match="simulations"):
        manager.create(None, refined)
    huge = map_job()
    huge["map"]["x"]["count"] = huge["map"]["y"]["count"] = 10_000_000
    with pytest.raises(TooLarge, match="200000000000000 simulations"):
        manager.create(None, huge)
    assert len(list((tmp_path / "studies").iterdir())) == 1


def test_only_so_many_wait(map_job, idle):
    """The line has an end; a place that is given up can be taken."""
    manager = idle(studies_waiting=2)
    first, _ = manager.create(None, map_job()), manager.create(None, map_job())
    with pytest.raises(Busy) as caught:
        manager.create(None, map_job())
    assert caught.value.seconds
    manager.cancel(first)
    manager.create(None, map_job())
    with pytest.raises(Busy):
        manager.resume(first)


def test_the_disk_has_a_limit(tmp_path, map_job, idle):
    """A study whose results do not fit is refused with both sizes, before anything is written."""
    manager = idle(studies_bytes=20_000)
    manager.create(None, map_job())
    with pytest.raises(TooLarge, match=r"0\.2 MB, 0\.0 MB are free"):
        manager.create(None, map_job(30))
    assert len(list((tmp_path / "studies").iterdir())) == 1


def test_what_is_refused_leaves_nothing(tmp_path, records, map_job, idle):
    """A job whose axes do not fit, or whose record is unknown, is refused without a path, and its folder is gone."""
    manager = idle()
    both = {"axis": "pga", "values": [1.0, 2.0]}
    with pytest.raises(InvalidValueError, match="map: x and y must set different parameters") as caught:
        manager.create(None, map_job(map={"x": both, "y": both}))
    assert str(tmp_path) not in str(caught.value)
    with pytest.raises(NotFound, match="upload"):
        manager.create(None, map_job(motions={"records": ["0" * 64]}))
    assert list((tmp_path / "studies").iterdir()) == []
    assert manager.create(None, map_job())


def test_a_study_needs_nobody_elses_files(manager, records, map_job, until):
    """A record may be deleted from the store once a study has it."""
    text = "\n".join(f"{0.01 * k:.2f} {(-1) ** (k // 20) * 3.0}" for k in range(200)).encode()
    record = records.add(text, "a b?.txt").record
    motions = {"records": [record], "units": "m/s2"}
    axes = {"x": {"axis": "width", "values": [0.3, 0.6]}, "y": {"axis": "scale", "values": [0.5, 2.0]}}
    study = manager.create(None, map_job(motions=motions, map=axes))
    records.delete(record)
    assert until(manager, study, "done", "failed")["state"] == "done"


def test_a_failure_is_told_in_a_sentence(tmp_path, records, map_job, idle, until):
    """Where a process ends on its own, its sentence is told without a path; once it is mended, a resume goes on."""
    idle = idle()
    study = idle.create(None, map_job())
    idle.close()
    job = tmp_path / "studies" / study / "job.toml"
    whole = job.read_text()
    job.write_text(whole.replace("0.5", "-0.5"))
    manager = StudyManager(tmp_path, Limits(), records, workers=1)  # it begins by itself
    message = until(manager, study, "failed", "done")["message"]
    assert message.startswith("body: ")
    assert "-0.5" in message
    assert str(tmp_path) not in message
    job.write_text(whole)
    manager.resume(study)
    assert until(manager, study, "failed", "done")["message"] == ""
    manager.close()


@pytest.mark.parametrize("act", ["cancel", "resume", "delete", "get", "finished"])
def test_unknown_studies_are_not_there(act, manager):
    """Whatever is asked of them, also by names that are paths."""
    for name in ("0" * 16, "../x", ".."):
        with pytest.raises(NotFound):
            getattr(manager, act)(name)


def test_what_is_over_cannot_be_cancelled(manager, map_job, until):
    """A study that is done is neither cancelled nor resumed; one that runs has no results yet."""
    study = manager.create(None, map_job())
    until(manager, study, "done")
    with pytest.raises(Refused, match="done"):
        manager.cancel(study)
    with pytest.raises(Refused, match="cannot be resumed"):
        manager.resume(study)


def test_listeners_are_told_until_they_leave(map_job, idle):
    """A change is told once to everybody who still listens."""
    manager, told = idle(), []
    listener = (HostedStudy, lambda: told.append(1))
    manager.queue.listeners.add(listener)
    study = manager.create(None, map_job())
    manager.queue.publish()
    assert len(told) == 1
    manager.queue.listeners.discard(listener)
    manager.cancel(study)
    assert len(told) == 1
    manager.close()


def test_nothing_is_finished_that_is_not(map_job, idle):
    """Results of a study that waits are refused with how far it is."""
    manager = idle()
    study = manager.create(None, map_job())
    with pytest.raises(Refused, match="is waiting: 0 of 72 simulations"):
        manager.finished(study)


def test_folders_are_private(tmp_path, map_job, idle):
    """Nobody else on this machine reads studies."""
    manager = idle()
    study = manager.create(None, map_job())
    assert (tmp_path / "studies").stat().st_mode & 0o077 == 0
    assert (tmp_path / "studies" / study).stat().st_mode & 0o077 == 0


def test_a_steady_study_has_its_rate():
    """Fifty histories a second, looked at five times a second, are fifty histories a second."""
    pace = StudyPace()
    rates = [pace.look(10 * k, 0.0, now=0.2 * k)[0] for k in range(100)]
    assert rates[0] == 0.0
    assert rates[-1] == pytest.approx(50.0, rel=0.05)


def test_jumps_do_not_move_the_rate():
    """Chunks that are finished every two seconds give the mean rate between the jumps, too."""
    pace = StudyPace()
    rates = [pace.look(100 * (k // 10), 0.0, now=0.2 * k)[0] for k in range(200)]
    assert rates[150:] == pytest.approx([50.0] * 50, rel=0.25)


def test_a_study_that_hangs_slows_down():
    """Where nothing is finished for long, the rate goes down instead of promising an end."""
    pace = StudyPace()
    for k in range(50):
        pace.look(10 * k, 0.0, now=0.2 * k)
    assert pace.look(490, 0.0, now=60.0)[0] < 10.0


def test_work_of_two_workers_is_two_seconds_a_second():
    """Pieces of a second each from two workers, noticed in jumps, after a start that took long, and an earlier run."""
    pace = StudyPace()
    pace.look(1000, 500.0, now=0.0)
    speeds = [pace.look(1000 + 20 * (k // 5), 500.0 + 2.0 * (k // 5), now=7.0 + 0.2 * k)[1] for k in range(100)]
    assert speeds[0] == 0.0
    assert speeds[30:] == pytest.approx([2.0] * 70)
