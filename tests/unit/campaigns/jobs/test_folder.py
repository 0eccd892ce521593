"""The folder of a campaign, its inputs and models in the user's own files: what is refused, and how it goes on."""

import hashlib
import json
import pickle
import subprocess
import sys

import numpy as np
import pytest
from campaign_jobs import BODY, PULSE, axes, finished
from campaign_jobs import job as text_of_job

from rocking import Block
from rocking.campaigns import CampaignDamagedError, CampaignMismatchError
from rocking.campaigns.jobs import Job, JobFolder, forecast, status_of, verified
from rocking.errors import InvalidValueError, UnknownModelError
from rocking.restitution.from_file import model_in_file


@pytest.fixture
def job(text, records):
    """Job of two records, in a file."""
    words = '[motions]\nrecords = "*.txt"\nunits = "m/s2"\n#'
    path = records / "job.toml"
    path.write_text(text("histories", 4).replace("[motions]\n", words), encoding="utf-8")
    return path


def test_begin_and_go_on(job, tmp_path):
    """The job is copied with the hashes of its inputs; another process opens it and goes on."""
    folder = JobFolder.create(tmp_path / "c", Job.read(job))
    kept = json.loads((tmp_path / "c" / "inputs.json").read_text())
    assert [item["path"] for item in kept["files"]] == ["one.txt", "two.txt"]
    assert (tmp_path / "c" / "job.toml").read_bytes() == job.read_bytes()
    assert status_of(tmp_path / "c").status.chunks_done == 0
    folder.campaign.run(workers=1)
    again = JobFolder.open(tmp_path / "c")
    assert again.campaign.run(workers=1).computed == 0
    assert status_of(tmp_path / "c").status.complete
    assert (status_of(tmp_path / "c").name, status_of(tmp_path / "c").kind) == ("a small histories", "histories")


def test_job_file_may_change_afterwards(job, tmp_path):
    """What counts is the copy."""
    JobFolder.create(tmp_path / "c", Job.read(job))
    job.unlink()
    assert JobFolder.open(tmp_path / "c").campaign.plan.count == 32


@pytest.mark.parametrize(
    ("change", "wanted"),
    [
        (
            lambda path: path.write_text("0.0 0.0\n0.1 1.0\n0.2 0.0\n"),
            r"one\.txt: The file changed after the start of the campaign",
        ),
        (
            lambda path: path.write_text("no record at all"),
            r"one\.txt: The file changed after the start of the campaign",
        ),
        (lambda path: path.unlink(), r"one\.txt: no such file"),
        (
            lambda path: path.with_name("zero.txt").write_bytes(path.read_bytes()),
            r"zero\.txt: The campaign does not use this new file",
        ),
    ],
)
def test_inputs_that_changed(job, tmp_path, records, change, wanted):
    """A record that changed, went or came between two runs is refused by name; as it was, it is taken again."""
    JobFolder.create(tmp_path / "c", Job.read(job))
    data = (records / "one.txt").read_bytes()
    change(records / "one.txt")
    with pytest.raises(InvalidValueError, match=wanted):
        JobFolder.open(tmp_path / "c")
    (records / "one.txt").write_bytes(data)
    (records / "zero.txt").unlink(missing_ok=True)
    assert JobFolder.open(tmp_path / "c").campaign.plan.count == 32


def test_inputs_that_moved(job, tmp_path, records):
    """Inputs in a new folder are taken if they are the same; otherwise the sentence says which folder is missing."""
    inputs = tmp_path / "inputs"
    inputs.mkdir()
    for name in ("one.txt", "two.txt", "job.toml"):
        (records / name).rename(inputs / name)
    JobFolder.create(tmp_path / "c", Job.read(inputs / "job.toml"))
    inputs.rename(tmp_path / "moved")
    with pytest.raises(InvalidValueError, match=r"inputs, does not exist; add --inputs"):
        JobFolder.open(tmp_path / "c")
    assert JobFolder.open(tmp_path / "c", tmp_path / "moved").campaign.plan.count == 32


def test_folders_in_use(job, tmp_path):
    """A folder with a campaign, with something else, and a file are refused; nothing in them changes."""
    JobFolder.create(tmp_path / "c", Job.read(job))
    with pytest.raises(CampaignMismatchError, match="already contains a campaign; go on with: rocking campaign resume"):
        JobFolder.create(tmp_path / "c", Job.read(job))
    other = tmp_path / "other"
    other.mkdir()
    (other / "thesis.tex").touch()
    with pytest.raises(CampaignMismatchError, match=r"not empty \(thesis.tex ...\)"):
        JobFolder.create(other, Job.read(job))
    with pytest.raises(CampaignMismatchError, match="this is a file; a folder is needed"):
        JobFolder.create(job, Job.read(job))
    with pytest.raises(CampaignMismatchError, match="contains no campaign of a job file"):
        status_of(other)


def test_killed_before_it_began(job, tmp_path):
    """Killed between the job and the campaign: the status says so, and opening it begins it."""
    JobFolder.create(tmp_path / "c", Job.read(job))
    (tmp_path / "c" / "histories" / "campaign.json").unlink()
    (tmp_path / "c" / "histories" / "shards").rmdir()
    assert status_of(tmp_path / "c").status is None
    JobFolder.open(tmp_path / "c").campaign.run(workers=1)
    assert status_of(tmp_path / "c").status.complete


@pytest.mark.parametrize("data", [b"", b"{", b'{"files": [{}]}', b"[]", None])
def test_damaged_notes(job, tmp_path, data):
    """Notes of the inputs that are damaged or gone are a sentence, not a traceback."""
    JobFolder.create(tmp_path / "c", Job.read(job))
    path = tmp_path / "c" / "inputs.json"
    path.unlink() if data is None else path.write_bytes(data)
    with pytest.raises(CampaignDamagedError, match="is missing or damaged"):
        JobFolder.open(tmp_path / "c")


def test_changed_copy_is_refused(job, tmp_path):
    """A copied job that was edited is refused by all that read it; without its hash, by what differs."""
    folder = JobFolder.create(tmp_path / "c", Job.read(job))
    assert folder.campaign.plan.size == 4
    copy = tmp_path / "c" / "job.toml"
    copy.write_text(copy.read_text().replace("8.0", "8.5"))
    for ask in (JobFolder.open, status_of, verified):
        with pytest.raises(
            CampaignDamagedError, match=r"job\.toml has changed since the campaign began; restore the file"
        ):
            ask(tmp_path / "c")
    noted = tmp_path / "c" / "inputs.json"
    assert json.loads(noted.read_text())["job_sha256"] == hashlib.sha256(folder.job.text.encode()).hexdigest()
    noted.write_text(json.dumps({k: v for k, v in json.loads(noted.read_text()).items() if k != "job_sha256"}))
    with pytest.raises(CampaignMismatchError, match=r"this campaign has other histories: content\.scales"):
        _ = JobFolder.open(tmp_path / "c").campaign
    copy.write_text(folder.job.text)
    assert JobFolder.open(tmp_path / "c").campaign.plan == folder.campaign.plan


def test_kept_jobs_of_schema_1_have_the_default_of_their_time(tmp_path):
    """A kept job of schema 1 without restitution was computed with ked; one of today with the default of today."""
    bare = text_of_job("histories", BODY, PULSE, "[histories]\nscales = [1.0, 2.0]\n")
    folder = JobFolder.create(tmp_path / "c", Job.of_text(f'{bare}[restitution]\nmodel = "ked"\n'))
    plan = folder.campaign.plan
    (tmp_path / "c" / "job.toml").write_text(bare)
    noted = tmp_path / "c" / "inputs.json"
    content = json.loads(noted.read_text())
    content["job_sha256"] = hashlib.sha256(bare.encode()).hexdigest()
    noted.write_text(json.dumps({name: value for name, value in content.items() if name != "schema"}))
    assert JobFolder.open(tmp_path / "c").campaign.plan == plan
    noted.write_text(json.dumps(content))
    with pytest.raises(CampaignMismatchError, match="has other histories"):
        _ = JobFolder.open(tmp_path / "c").campaign


def test_forecast(job, tmp_path):
    """A forecast counts right, finds a rate, and writes nothing."""
    found = forecast(Job.read(job), workers=2, folder=tmp_path / "none" / "c")
    assert (found.histories, found.chunk, found.chunks) == (32, 4, 8)
    assert found.seconds == pytest.approx(32 / found.rate / 2)
    assert found.disk >= 75 * 32
    assert found.free > 0
    assert not (tmp_path / "none").exists()


MINE = """import rocking as rk


class Mine(rk.restitution.RestitutionModel):
    name = "mine"

    def raw_coefficient(self, body, foot):
        return {value}
"""


def job_of(restitution):
    """Text of a job with a restitution."""
    return text_of_job(
        "overturning-map", BODY, PULSE, f"[restitution]\n{restitution}\n", axes((1, 7, 6), (1, 9, 5)), chunk=10
    )


@pytest.fixture
def own(tmp_path):
    """A folder with a job, and the file of the model that it names."""
    (tmp_path / "mine.py").write_text(MINE.format(value=0.9), encoding="utf-8")
    (tmp_path / "job.toml").write_text(job_of('model = "mine.py:Mine"'), encoding="utf-8")
    return tmp_path


def digest(folder, restitution):
    """Hash of the results of the same job with another restitution."""
    return finished(folder, job_of(restitution)).campaign.sha256()


@pytest.mark.slow
@pytest.mark.parametrize("executor", ["serial", "processes"])
def test_own_model_computes_in_every_process(own, executor):
    """A model that returns 0.9 gives the bits of the value 0.9, in this process and in spawned ones; not of 0.8."""
    made = JobFolder.create(own / "c", Job.read(own / "job.toml"))
    made.run(executor, workers=1)
    assert made.campaign.sha256() == digest(own / "same", "value = 0.9")
    assert made.campaign.sha256() != digest(own / "other", "value = 0.8")
    assert [item["path"] for item in json.loads((own / "c" / "inputs.json").read_text())["files"]] == ["mine.py"]


def test_own_model_may_stand_among_others(own):
    """In a list beside a name, and as what a distribution multiplies."""
    (own / "job.toml").write_text(job_of('models = ["ked", "mine.py:Mine"]'), encoding="utf-8")
    assert list(Job.read(own / "job.toml").study.dims.values()) == [2, 5, 6]
    drawn = 'distribution = { mean = 0.95, deviation = 0.01, times = "mine.py" }'
    (own / "job.toml").write_text(job_of(drawn), encoding="utf-8")
    rows = Job.read(own / "job.toml").study.histories.rows(0, 30)
    assert np.array_equal(rows.values["r_right"], np.full(30, 0.9))


def test_changed_model_is_refused(own):
    """Another number in the file, or none of it: the campaign is not gone on with, and says why."""
    JobFolder.create(own / "c", Job.read(own / "job.toml"))
    (own / "mine.py").write_text(MINE.format(value=0.9) + "# a remark\n", encoding="utf-8")
    with pytest.raises(InvalidValueError, match=r"mine\.py: The file changed after the start of the campaign"):
        JobFolder.open(own / "c")
    (own / "mine.py").unlink()
    with pytest.raises(InvalidValueError, match=r"mine\.py: no such file"):
        JobFolder.open(own / "c")
    (own / "mine.py").write_text(MINE.format(value=0.9), encoding="utf-8")
    assert JobFolder.open(own / "c").run(workers=1).computed == 3


@pytest.mark.slow
def test_model_travels_with_its_source(own):
    """A process without the file makes the same model; with a remark in the file it is another class."""
    made = model_in_file(f"{own / 'mine.py'}:Mine")
    sent = pickle.dumps(made)
    (own / "mine.py").unlink()
    code = "import pickle, sys, rocking as rk; made = pickle.load(sys.stdin.buffer)\n"
    code += "print(type(made).__name__, made.raw_coefficient(None, None), "
    code += "isinstance(made, rk.restitution.RestitutionModel))"
    told = subprocess.run([sys.executable, "-c", code], input=sent, capture_output=True, check=True).stdout
    assert told.split() == [b"Mine", b"0.9", b"True"]
    (own / "mine.py").write_text(MINE.format(value=0.9) + "# a remark\n", encoding="utf-8")
    assert type(model_in_file(str(own / "mine.py"))) is not type(made)


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("import nothing_of_that_name", "ModuleNotFoundError"),
        ("x = 1", "has no restitution model Mine; its models: none"),
        ("def", "SyntaxError"),
    ],
)
def test_what_is_wrong_with_the_file_is_said(own, source, words):
    """A file that fails, twice in a row, and one without the class: with the key of the job."""
    (own / "mine.py").write_text(source, encoding="utf-8")
    for _ in range(2):
        with pytest.raises(UnknownModelError, match=f"job.toml: restitution: .*mine.py.*{words}"):
            Job.read(own / "job.toml")
    with pytest.raises(UnknownModelError, match=r"nowhere\.py: no such file"):
        model_in_file("nowhere.py:Mine")


SHARED = """from dataclasses import dataclass
from rocking.restitution import RestitutionModel
@dataclass(frozen=True)
class Shared(RestitutionModel):
    share: float
    name = "shared"
    title = "a share"
    def raw_coefficient(self, body, foot):
        return self.share / (1.0 - self.share)
"""


def test_parameters_and_factor_of_an_own_model(own):
    """They are written as those of every model, go with it to another process, and are missed by name."""
    (own / "shared.py").write_text(SHARED, encoding="utf-8")
    word = f"{own / 'shared.py'}:Shared"
    made = pickle.loads(pickle.dumps(model_in_file(f"0.5*{word}:share=0.25")))
    block = Block(width=1.0, height=4.0)
    assert made.coefficient(block, "right") == pytest.approx(0.5 / 3.0, rel=1e-15)
    assert model_in_file(f"{word}:share=0.25").coefficient(block, "right") == pytest.approx(1.0 / 3.0, rel=1e-15)
    for wrong in ("", ":part=0.3", ":share=0.3,part=1"):
        with pytest.raises(UnknownModelError, match=r"'shared.py:Shared' accepts share, got"):
            model_in_file(word + wrong)
