"""`rocking campaign`: what it prints and writes, its exit codes, and what a kill leaves behind."""

import json
import os
import signal
import subprocess
import sys
import time

import pytest
from campaign_jobs import BODY, PULSE, axes
from campaign_jobs import job as job_text
from waiting import HANG

from rocking.campaigns.disk import FolderLock
from rocking.campaigns.jobs import status_of
from rocking.cli.campaign_output import _span, executor_of

PROGRAM = """
import sys
from rocking.cli import main
if __name__ == "__main__":
    main(["campaign", *sys.argv[1:]])
"""


COMMAND = "campaign"


@pytest.fixture
def job(file):
    """Write a job file: 20 rows of as many columns as wanted."""

    def write(columns=30, chunk=100, more=""):
        tables = BODY, PULSE, axes((0.5, 7, columns), (1, 9, 20))
        return file(job_text("overturning-map", *tables, name="sines", chunk=chunk) + more, "job.toml")

    return write


def test_check(run, printed, job, tmp_path):
    """A job without a mistake: how many histories, chunks, time, memory, disk, also as JSON; nothing is written."""
    path = job()
    code, out, err = run("check", path, "--output", tmp_path / "c")
    assert (code, err) == (0, "")
    assert "600 = 20 amplitude_ratio x 30 frequency_ratio, in 6 chunks of 100" in out
    for word in ("time", "memory", "disk", "free"):
        assert word in out
    told = json.loads(printed("check", path, "--json", "--workers", 2))
    assert (told["histories"], told["chunks"], told["chunk"]) == (600, 6, 100)
    assert {"rate", "seconds", "memory", "disk", "free"} <= set(told)
    assert (told["units"]["memory"], told["units"]["seconds"]) == ("B", "s")
    assert not (tmp_path / "c").exists()


STATUS = [
    "campaign", "kind", "folder", "complete", "histories", "histories_done", "chunks", "chunks_done", "running",
    "worker_seconds", "retried", "damaged", "broken", "software",
]  # fmt: skip
RUN = ["computed_chunks", "resumed_chunks", "adopted_chunks", "set_aside", "retries", "run_seconds"]


@pytest.mark.slow
def test_run_status_resume_export(run, job, tmp_path):
    """The whole way in words, and again in JSON with keys that stay these."""
    folder = tmp_path / "c"
    code, out, err = run("run", job(), "--output", folder)
    assert (code, err) == (0, "")
    assert f"sines: all 600 histories (6 chunks) are stored in {folder}" in out
    assert "next: rocking campaign export" in out
    code, out, _ = run("status", folder)
    assert (code, "all 600 histories" in out) == (0, True)
    code, out, _ = run("resume", folder, "--json", "--executor", "serial", "--workers", 1)
    told = json.loads(out)
    assert (code, list(told)) == (0, [*STATUS, *RUN, "units"])
    assert (told["complete"], told["computed_chunks"], told["resumed_chunks"]) == (True, 0, 6)
    code, out, _ = run("status", folder, "--json")
    assert (code, list(json.loads(out))) == (0, [*STATUS, "units"])
    code, out, _ = run("export", folder, "--output", tmp_path / "r.csv", "--json")
    assert (code, list(json.loads(out))) == (0, ["file", "what", "histories", "bytes", "sha256", "units"])
    assert len((tmp_path / "r.csv").read_text().splitlines()) == 601
    code, out, _ = run("export", folder, "--output", tmp_path / "r.mat")
    assert (code, "wrote" in out) == (0, True)


@pytest.mark.parametrize("more", ["[restitution]\nmodel = 'kedd'\n", "[map.z]\n", "[settings]\norder = 5\n", "[["])
def test_mistakes_in_the_job(run, job, tmp_path, more):
    """A mistake in the job: check and run say the same sentence and leave with 2."""
    path = job(more=more)
    said = [run("check", path), run("run", path, "--output", tmp_path / "new")]
    assert said[0] == said[1]
    assert said[0][0] == 2
    assert said[0][2].startswith("rocking: job.toml: ")
    assert len(said[0][2].splitlines()) == 1
    assert not (tmp_path / "new").exists()


def begun(tmp_path, path):
    """A campaign that was stopped after one chunk of six, by Ctrl-C in its progress."""
    from rocking.campaigns import CampaignInterrupted
    from rocking.campaigns.jobs import Job, JobFolder

    folder = JobFolder.create(tmp_path / "c", Job.read(path))

    def stop(progress):
        if progress.chunks_done == 1:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(CampaignInterrupted):
        folder.campaign.run(workers=1, progress=stop)
    return tmp_path / "c"


def test_half_done(run, printed, job, tmp_path):
    """A campaign that stopped names what is missing, says how to go on, exports nothing, and goes on."""
    folder = begun(tmp_path, job())
    code, out, _ = run("verify", folder)
    assert (code, "missing: histories 100 to 599" in out) == (6, True)
    out = printed("status", folder)
    assert "100 of 600 histories (1 of 6 chunks)" in out
    assert "rocking campaign resume" in out
    code, _, err = run("export", folder, "--output", tmp_path / "r.nc")
    assert code == 2
    assert err.startswith("rocking: nothing to export because 1 of 6 chunks")
    code, out, _ = run("resume", folder, "--json")
    assert (code, json.loads(out)["computed_chunks"]) == (0, 5)


def test_busy(run, job, tmp_path):
    """Another process runs it: exit code 5, and the status names it."""
    folder = begun(tmp_path, job())
    with FolderLock(folder / "histories"):
        code, _, err = run("resume", folder)
        assert (code, len(err.splitlines())) == (5, 1)
        assert str(os.getpid()) in err
        assert str(os.getpid()) in run("status", folder)[1]


def test_disk_full(run, job, tmp_path, monkeypatch):
    """A full disk: exit code 4, and a sentence that says what is safe."""
    folder = begun(tmp_path, job())

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("rocking.campaigns.disk.write_new", full)
    code, _, err = run("resume", folder)
    assert (code, len(err.splitlines())) == (4, 1)
    assert "No space left on device; 1 of 6 chunks are safe" in err


def test_damage_is_told(run, printed, job, tmp_path):
    """A shard that changed on disk is computed again, and the status goes on saying so."""
    folder = begun(tmp_path, job())
    (shard,) = (folder / "histories" / "shards").glob("*.shard")
    shard.write_bytes(shard.read_bytes()[:-40])
    out = printed("resume", folder)
    assert [line[:6] for line in out.splitlines()].count("note: ") == 1
    assert "note: " in run("status", folder)[1]
    assert json.loads(run("status", folder, "--json")[1])["damaged"]


HARMS = {"flip": "has changed", "cut": "incomplete", "lose": "is missing", "swap": "the shard contains chunk"}


@pytest.mark.slow
@pytest.mark.parametrize("harm", HARMS)
def test_verify_names_what_is_damaged(run, job, tmp_path, harm):
    """A flipped bit, a file cut short, lost, or of other histories: named, not counted, exit code 6; resume mends."""
    folder = tmp_path / "c"
    assert run("run", job(), "--output", folder)[0] == 0
    code, out, _ = run("verify", folder)
    assert (code, "600 of 600 histories verified, in 6 chunks" in out) == (0, True)
    one, other = sorted((folder / "histories" / "shards").glob("*.shard"))[:2]
    data = bytearray(one.read_bytes())
    if harm == "flip":
        data[len(data) // 2] ^= 1
    one.write_bytes({"cut": data[:-9], "swap": other.read_bytes()}.get(harm, data))
    if harm == "lose":
        one.unlink()
    code, out, _ = run("verify", folder)
    (damaged, missing) = (line for line in out.splitlines() if line.startswith(("damaged: ", "missing: ")))
    assert (code, one.name in damaged, HARMS[harm] in damaged) == (6, True, True)
    first = int(missing.split()[2])
    assert missing == f"missing: histories {first} to {first + 99}"
    told = json.loads(run("verify", folder, "--json")[1])
    assert (told["is_complete"], told["verified"], told["missing"]) == (False, 500, [[first, first + 100]])
    code, out, _ = run("status", folder)
    assert (code, "500 of 600 histories (5 of 6 chunks) are stored" in out, one.name in out) == (6, True, True)
    assert json.loads(run("status", folder, "--json")[1])["broken"]
    assert run("resume", folder)[0] == 0
    assert run("verify", folder)[0] == 0


@pytest.mark.slow
def test_damaged_ledger_is_told_and_mended(run, job, tmp_path):
    """Verify, status and export say that the ledger is damaged, with exit code 6; resume mends it, as verify says."""
    folder = tmp_path / "c"
    assert run("run", job(), "--output", folder)[0] == 0
    (folder / "histories" / "ledger.sqlite").write_bytes(b"xx")
    code, out, err = run("verify", folder)
    assert (code, "ledger.sqlite is damaged" in out, err) == (6, True, "")
    assert out.endswith(f"go on with: rocking campaign resume {folder}\n")
    assert json.loads(run("verify", folder, "--json")[1])["is_complete"] is False
    for words in (("status", folder), ("export", folder, "--output", tmp_path / "r.csv")):
        code, _, err = run(*words)
        assert (
            code,
            "run the campaign again: the run rebuilds the ledger from the shards" in err,
            len(err.splitlines()),
        ) == (
            6,
            True,
            1,
        )
    code, out, _ = run("resume", folder)
    assert (code, "kept as ledger.sqlite.damaged-1" in out) == (0, True)
    assert run("verify", folder)[0] == 0


def test_changed_job_is_told_alike(run, job, tmp_path):
    """Verify, status and resume refuse a job that was edited with the same sentence, and none sends to another one."""
    folder = tmp_path / "c"
    assert run("run", job(), "--output", folder)[0] == 0
    (folder / "job.toml").write_text((folder / "job.toml").read_text() + "# mine\n")
    told = {run(word, folder) for word in ("verify", "status", "resume")}
    (((code, out, err)),) = told
    assert (code, out, "job.toml has changed since the campaign began; restore the file" in err) == (6, "", True)


@pytest.mark.slow
def test_verify_reads_every_round(run, job, tmp_path):
    """A refined map, whose rounds are campaigns of their own: one bit of the last one is noticed."""
    folder = tmp_path / "c"
    assert run("run", job(columns=8, more="refine = 1\n"), "--output", folder)[0] == 0
    assert run("verify", folder)[0] == 0
    shard = next(iter(sorted(folder.glob("round-*"))[-1].glob("shards/*.shard")))
    data = bytearray(shard.read_bytes())
    data[-50] ^= 8
    shard.write_bytes(data)
    code, out, _ = run("verify", folder, "--json")
    assert (code, shard.name in json.loads(out)["damaged"][0]) == (6, True)
    assert run("resume", folder)[0] == 0
    assert run("verify", folder)[0] == 0


def test_killed_before_it_began(run, job, tmp_path):
    """A folder with a job and nothing else: nothing is computed yet, and how to go on."""
    folder = tmp_path / "c"
    folder.mkdir()
    (folder / "job.toml").write_bytes(job().read_bytes())
    (folder / "inputs.json").write_text(json.dumps({"job_file": "a", "job_folder": str(tmp_path), "files": []}))
    code, out, _ = run("status", folder)
    assert (code, "no history is computed yet; go on with: rocking campaign resume" in out) == (0, True)
    told = json.loads(run("status", folder, "--json")[1])
    assert (list(told), told["chunks"], told["complete"]) == ([*STATUS, "units"], None, False)
    assert run("resume", folder)[0] == 0


def test_check_of_a_small_disk(run, job, tmp_path, monkeypatch):
    """A disk without room: what it would take, then exit code 4."""
    usage = type("Usage", (), {"free": 1000})
    monkeypatch.setattr("shutil.disk_usage", lambda _: usage)
    code, out, err = run("check", job(), "--output", tmp_path / "c")
    assert (code, "0 MB free" in out) == (4, True)
    assert err.startswith(f"rocking: {tmp_path / 'c'}: the campaign needs 0 MB")


@pytest.mark.slow
def test_run_on_a_cluster(run, job, tmp_path):
    """A cluster that is there already computes the same file."""
    distributed = pytest.importorskip("distributed")
    path = job()
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster:
        there = ("--executor", "dask", "--address", cluster.scheduler_address)
        assert run("run", path, "--output", tmp_path / "a", *there)[0] == 0
    assert executor_of("dask", None, there[-1])[0].address == there[-1]
    assert run("run", path, "--output", tmp_path / "b")[0] == 0
    for name in "ab":
        assert run("export", tmp_path / name, "--output", tmp_path / f"{name}.csv")[0] == 0
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()


@pytest.mark.parametrize(
    ("seconds", "words"), [(0.04, "0.0 s"), (119.0, "119.0 s"), (150.0, "2.5 min"), (9000.0, "2.5 h")]
)
def test_times_in_words(seconds, words):
    """Times in the unit that people would take."""
    assert _span(seconds) == words


def started(tmp_path, *words):
    """The command in a process of its own."""
    program = tmp_path / "program.py"
    program.write_text(PROGRAM, encoding="utf-8")
    return subprocess.Popen(
        [sys.executable, str(program), *(str(word) for word in words)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip


def wait_for(folder, chunks):
    """Wait until some chunks are recorded."""
    until = time.monotonic() + HANG
    while time.monotonic() < until:
        if (folder / "histories" / "campaign.json").exists():
            done = status_of(folder).status.chunks_done
            if done >= chunks:
                return done
        time.sleep(0.01)
    raise AssertionError("it never started")


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_kill_resume_export(run, job, tmp_path):
    """SIGKILL in the middle, resume, then SIGINT, resume: the file is byte for byte that of an undisturbed run."""
    path = job(columns=3000, chunk=250)
    assert run("run", path, "--output", tmp_path / "whole")[0] == 0
    assert run("export", tmp_path / "whole", "--output", tmp_path / "whole.nc")[0] == 0
    folder = tmp_path / "c"
    process = started(tmp_path, "run", path, "--output", folder, "--workers", 1)
    wait_for(folder, 3)
    os.killpg(process.pid, signal.SIGKILL)
    assert process.wait() == -signal.SIGKILL
    process.communicate()
    before = status_of(folder).status.chunks_done
    assert 3 <= before < 240
    process = started(tmp_path, "resume", folder, "--executor", "processes", "--workers", 1)
    wait_for(folder, before + 3)
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=HANG)
    assert (process.returncode, out) == (3, "")
    *progress, last = err.strip().splitlines()
    assert last.startswith("rocking: stopped: ")
    assert all(line.startswith("rocking: sines: ") for line in progress)  # on a busy machine
    code, out, _ = run("resume", folder, "--json")
    assert (code, json.loads(out)["resumed_chunks"] >= before + 3) == (0, True)
    assert run("export", folder, "--output", tmp_path / "r.nc")[0] == 0
    assert (tmp_path / "r.nc").read_bytes() == (tmp_path / "whole.nc").read_bytes()


def test_help_says_the_exit_codes(run):
    """The codes are in the help of every command."""
    for words in ((), ("check",), ("run",), ("status",), ("resume",), ("export",)):
        code, out, _ = run(*words, "--help")
        assert code == 0
        assert all(word in out for word in ("Exit codes", "0 done", "2 invalid input", "3 interrupted"))
