"""`rocking identify`: a student with a phone, tables of every kind, folders with bad files, resumed, and refusals."""

import csv
import json
import os
import time

import numpy as np
import pytest
import rocking_sounds
from benchmarks import identification_video
from rocking_sounds import RATE, wav
from waiting import allowed

import rocking as rk
from rocking.identification import identify, read_measurement
from rocking.restitution.bed import ContactBed, KelvinVoigt, bed_free_rocking
from rocking.spec import identification

pytestmark = pytest.mark.slow

COMMAND = "identify"
SIZE = ("--width", 10, "--height", 40, "--units", "cm")
BLOCK = rk.Block(width=0.1, height=0.4)


@pytest.fixture(scope="module")
def rocked():
    """A block on a contact bed: touches of the ground, speeds, and the mean of its coefficients."""
    law = KelvinVoigt(BLOCK.mass * (2.0 * np.pi * 1500.0) ** 2, damping_ratio=1.0)
    bed = ContactBed.uniform(BLOCK, 2, law)
    found = bed_free_rocking(BLOCK, bed, rotation=0.6 * BLOCK.slenderness_angle, peaks=12)
    return found.touches, np.cumprod(found.coefficients), float(np.exp(np.log(found.coefficients[1:]).mean()))


@pytest.fixture(scope="module")
def phone(rocked, tmp_path_factory):
    """What a phone recorded of it in a room: reverberation, hum and noise."""
    times, speeds, _ = rocked
    random = np.random.default_rng(5)
    size = int((times[-1] + 2.0) * RATE)
    direct, peaks = rocking_sounds.Clicks(random).at(times + 1.0, speeds, size)
    path = tmp_path_factory.mktemp("phone") / "phone.wav"
    path.write_bytes(wav(rocking_sounds.recorded(random, direct, peaks.min(), 25.0)))
    return path


def times_file(path, times, jitter=1e-4, seed=1):
    """A table of times with jitter."""
    noisy = np.sort(times + jitter * np.random.default_rng(seed).normal(size=times.size))
    path.write_text("impact [s]\n" + "\n".join(f"{time:.6f}" for time in noisy), "utf-8")
    return path


@pytest.mark.verifies("behaviour", room="doors")
def test_a_student_with_a_phone(printed, phone, rocked, tmp_path, monkeypatch):
    """One command, one picture, one number whose interval has the coefficient with which the block rocked."""
    monkeypatch.chdir(tmp_path)
    page = printed(phone, *SIZE, "--output", "phone.png")
    said = page.splitlines()[0]
    assert said.startswith("The coefficient of restitution is 0.91")
    low, high = (float(word) for word in said.partition("(")[2].partition(")")[0].split(" to "))
    assert low < rocked[2] < high < low + 0.01
    assert "Landing left" in page
    assert "housner" in page
    assert (tmp_path / "phone.png").read_bytes().startswith(b"\x89PNG")


def test_json_is_the_python_call(answered, rocked, tmp_path):
    """By sizes, by a body file before or after it, and by a question's file: the same as in Python."""
    times = times_file(tmp_path / "times.csv", rocked[0])
    body, question = tmp_path / "body.toml", tmp_path / "question.toml"
    body.write_text('units = "cm"\n[block]\nwidth = 10\nheight = 40\n', "utf-8")
    question.write_text(
        '[body]\nunits = "m"\nwidth = 0.1\nheight = 0.4\n'
        '[measurement]\nfile = "times.csv"\n[identify]\ntilt = [0, 0.001]\n',
        "utf-8",
    )
    found = identify(read_measurement(times), BLOCK, tilt=(0.0, 0.001)).answer().plain()
    known = ("--set", "identify.tilt=[0,0.001]")
    for words in ((times, *SIZE, *known), (body, times, *known), (times, body, *known), (question,)):
        answer = answered(*words)
        assert answer == json.loads(json.dumps(found))
    assert answered(times)["models"] == []
    assert answered(question, "--set", "identify.tilt=0")["tilt"]["high"] == 0.0


def test_every_file_says_the_same(run, rocked, tmp_path):
    """Tables, pictures and reports, of times of impacts; the report names models and doubts."""
    path = times_file(tmp_path / "times.csv", rocked[0])
    files = [tmp_path / f"found.{ending}" for ending in ("csv", "nc", "xlsx", "png", "html")]
    code, out, err = run(path, *SIZE, *(f"--output={file}" for file in files))
    assert (code, err) == (0, "")
    with files[0].open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 10
    assert {row["foot"] for row in rows} == {"left", "right"}
    xarray = pytest.importorskip("xarray")
    with xarray.open_dataset(files[1], engine="h5netcdf") as dataset:
        assert out.splitlines()[0] == dataset.attrs["verdict"]
        assert dataset.sizes == {
            "impact": 10,
            "model": len(rk.restitution.models()) - 1,
            "sample": 12,
        }  # fixed has no r
    text = files[4].read_text("utf-8")
    assert out.splitlines()[0] in text
    assert "horizontal-momentum" in text
    assert "Design of a more precise experiment" in text


def test_rotations_need_what_they_say(printed, refuses, tmp_path):
    """A laser at a height: columns and units are asked for as the command calls them, and then taken."""
    response = rk.free_rocking(BLOCK, 0.5 * BLOCK.slenderness_angle, restitution=0.9)
    time = np.arange(0.0, 2.5, 0.002)
    noise = np.random.default_rng(2).normal(size=time.size)
    moved = 300.0 * np.sin(np.interp(time, response.time, response.rotation)) + noise
    path = tmp_path / "laser.csv"
    lines = (f"{t:.4f},{u:.4f},1" for t, u in zip(time, moved, strict=True))
    path.write_text("\n".join(["time [s],top,other", *lines]), "utf-8")
    column = ("--set", "measurement.column=top")
    refuses((path, *SIZE), "add --set measurement.column= with one of")
    refuses((path, *SIZE, *column), "or use --set measurement.unit=")
    unit = (*column, "--set", "measurement.unit=mm")
    refuses((path, *SIZE, *unit), "--set measurement.height= of the sensor [m] is missing")
    page = printed(path, *SIZE, *unit, "--set", "measurement.height=0.3", "--output", tmp_path / "laser.png")
    low, high = (float(word) for word in page.partition("(")[2].partition(")")[0].split(" to "))
    assert low < 0.9 < high < low + 0.02
    assert (tmp_path / "laser.png").stat().st_size > 10_000


def test_a_shaken_floor(answered, refuses, tmp_path):
    """Under a record, with what is known of the clocks: the same as in Python; a clock alone is refused."""
    time = np.arange(0.0, 4.0, 0.01)
    shakes = 3.0 * np.sin(4.0 * np.pi * time) * np.clip(3.0 - np.abs(time - 1.7), 0.0, 1.0) * (time < 3.0)
    motion = rk.GroundMotion(shakes, 0.01)
    response = rk.simulate(BLOCK, motion, 0.9)
    noisy = response.rotation + 2e-4 * np.random.default_rng(1).normal(size=response.time.size)
    tables = {"rotation": (response.time, noisy, "rad"), "floor": (time, shakes, "m/s2")}
    for name, (at, values, unit) in tables.items():
        rows = "\n".join(f"{t!r},{v!r}" for t, v in zip(at.tolist(), values.tolist(), strict=True))
        (tmp_path / f"{name}.csv").write_text(f"time [s],{name} [{unit}]\n{rows}", "utf-8")
    clock = ("--set", "identify.clock=[0,0.01]")
    found = answered(tmp_path / "rotation.csv", *SIZE, "--motion", tmp_path / "floor.csv", *clock)
    record = rk.read_motion(tmp_path / "floor.csv")
    here = identify(read_measurement(tmp_path / "rotation.csv"), BLOCK, motion=record, clock=(0.0, 0.01))
    assert found == json.loads(json.dumps(here.answer().plain()))
    assert found["forced"]["measured"] > 1.0
    assert found["mean"]["low"] < 0.9 < found["mean"]["high"]
    refuses((tmp_path / "rotation.csv", *SIZE, *clock), "identify.clock needs [motion]")


@pytest.fixture
def folder(phone, rocked, tmp_path):
    """Four good trials, clapping, a damaged file, a body, and what is no trial."""
    path = tmp_path / "trials"
    path.mkdir()
    for k in range(3):
        times_file(path / f"times_{k}.csv", rocked[0], seed=k)
    (path / "phone.wav").write_bytes(phone.read_bytes())
    (path / "clapping.wav").write_bytes(wav(rocking_sounds.no_rocking("clapping", 1)))
    (path / "damaged.wav").write_bytes(phone.read_bytes()[:-500])
    (path / "body.toml").write_text('units = "cm"\n[block]\nwidth = 10\nheight = 40\n', "utf-8")
    (path / "notes.md").write_text("let go by hand", "utf-8")
    return path


@pytest.mark.verifies("damage", "a trial that claps and one that is cut off", room="doors")
def test_a_bad_file_touches_no_other(answered, printed, folder, rocked):
    """Every trial is what it is alone; two are told why not; the mean of the others has the true coefficient."""
    found = answered(folder)
    by_name = {row["trial"]: row for row in found["trials"]}
    assert list(by_name) == ["clapping.wav", "damaged.wav", "phone.wav", *(f"times_{k}.csv" for k in range(3))]
    assert "not the sound of a rocking body" in by_name["clapping.wav"]["refused"]
    assert "the header states" in by_name["damaged.wav"]["refused"]
    assert by_name["damaged.wav"]["coefficient"] is None
    alone = identify(read_measurement(folder / "times_1.csv"), BLOCK)
    assert by_name["times_1.csv"]["coefficient_high"] == alone.mean.high
    assert found["mean"]["low"] < rocked[2] < found["mean"]["high"] < found["mean"]["low"] + 0.01
    assert found["verdict"].endswith("%.")
    page = printed(folder)
    assert "4 of 6 trials" in page
    assert "! clapping.wav: not the sound" in page


@pytest.mark.verifies("damage", "a run that is interrupted, and a table that is cut off", room="doors")
def test_a_folder_is_resumed(run, printed, folder, tmp_path, monkeypatch):
    """What was finished is kept as it is and not computed again; what changed is, and so is all of another question."""
    table, done, stopped = tmp_path / "all.csv", [], []
    answer = identification.IdentificationProblem.answer

    def interrupted(problem, path=None):
        done.append(path.name)
        if len(done) == 5 and not stopped:
            stopped.append(path)
            raise KeyboardInterrupt
        return answer(problem, path)

    monkeypatch.setattr(identification.IdentificationProblem, "answer", interrupted)
    assert run(folder, "--output", table)[0] == 130
    assert len(table.read_text("utf-8").splitlines()) == 5  # a header, two good trials, two refused
    out = printed(folder, "--output", table)
    assert done[5:] == ["clapping.wav", "damaged.wav", "times_1.csv", "times_2.csv"]
    assert "2 of 6 trials were stored" in out
    whole = table.read_bytes()
    done.clear()
    table.write_bytes(whole[:-20])  # cut off in the last line
    run(folder, "--output", table)
    assert done == ["clapping.wav", "damaged.wav", "times_2.csv"]
    assert table.read_bytes() == whole
    done.clear()
    run(folder, "--output", table, "--set", "identify.tilt=0")
    assert len(done) == 6
    for what in (folder, folder / "times_0.csv"):
        assert "would overwrite an input file" in run(what, *SIZE, "--output", folder / "times_0.csv")[2]
    (folder / "all.csv").write_bytes(whole)  # a table of trials is no trial
    assert "4 of 6 trials" in run(folder)[1]


def trials_of(*middles, common):
    """Trials whose own intervals are of +-0.001."""
    numbers = [{"coefficient": r, "coefficient_low": r / 1.001, "coefficient_high": r * 1.001} for r in middles]
    rows = [{"trial": f"{k}.csv", "refused": "", "impacts": 9, "scatter": 0.01 + k} for k in range(len(middles))]
    rows = [row | more | {"common": common} for row, more in zip(rows, numbers, strict=True)]
    return identification.IdentifiedTrials("folder", BLOCK, tuple(rows), len(rows))


@pytest.mark.parametrize(
    ("middles", "common", "reach"),
    [
        ((0.9, 0.9 * np.exp(1e-6)), 0.0, 0.001 / np.sqrt(2.0)),  # by luck as good as the same
        ((0.9, 0.9 * np.exp(1e-6)), 0.001 / 1.96, 0.001),  # all of what is not known is of the body
        ((0.9,) * 400, 0.0004 / 1.96, np.hypot(np.sqrt(0.001**2 - 0.0004**2) / 20.0, 0.0004)),
        ((0.89, 0.91), 0.0, 12.706 * np.log(0.91 / 0.89) / 2.0),  # they differ: Student's t
    ],
)
def test_luck_narrows_no_interval(middles, common, reach):
    """Of trials that agree it is what their own intervals allow, and what is common never falls away."""
    mean = trials_of(*middles, common=common).mean
    assert 0.5 * np.log(mean.high / mean.low) == pytest.approx(reach, rel=1e-3)


def test_other_files_are_passed_over(printed, answered, refuses, rocked, tmp_path):
    """Files that are no recordings are counted and named with the reason; a damaged recording stays a trial.

    Decimal commas and a gap are numbers. Negative control: a folder without recordings is refused.
    """
    for k in range(2):
        times_file(tmp_path / f"{k}.csv", rocked[0], seed=k)
    (tmp_path / "damaged.wav").write_bytes(b"RIFF")
    (tmp_path / "gap.csv").write_text("time [s];rotation [deg]\n0,1;0,5\n0,2;NaN\n", "utf-8")
    (tmp_path / "notes.csv").write_text("trial;operator\n1;A\n2;B\n", "utf-8")
    (tmp_path / "readme.txt").write_text("Measured on a Monday.\n", "utf-8")
    (tmp_path / "photo.jpg").write_bytes(b"JFIF")
    (tmp_path / "more").mkdir()
    found = answered(tmp_path, *SIZE)
    assert [row["trial"] for row in found["trials"]] == ["0.csv", "1.csv", "damaged.wav", "gap.csv"]
    assert found["passed_over"] == {
        "more": "a folder", "notes.csv": "no row of numbers", "photo.jpg": "another kind of file",
        "readme.txt": "no row of numbers",
    }  # fmt: skip
    said = (
        "Ignored 4 files without a recording: more (a folder); notes.csv, readme.txt (no row of numbers); "
        "photo.jpg (another kind of file)."
    )
    page = " ".join(printed(tmp_path, *SIZE, "--output", tmp_path / "all.html").split())
    assert said in page
    assert "the mean of 2 of 4 trials" in page
    assert said in (tmp_path / "all.html").read_text("utf-8")
    for name in ("0.csv", "1.csv", "damaged.wav", "gap.csv"):
        (tmp_path / name).unlink()
    refuses((tmp_path, *SIZE), "No trials. Use files with .wav")
    refuses((tmp_path, *SIZE), "Ignored: ")


def test_two_files_of_one_event_are_told(printed, answered, rocked, tmp_path):
    """The same times in two files; those of another trial are not."""
    for k in range(2):
        times_file(tmp_path / f"{k}.csv", rocked[0], seed=k)
    times_file(tmp_path / "again.csv", rocked[0])
    again = "1.csv and again.csv have equal results. If they record one event, remove the duplicates."
    assert answered(tmp_path, *SIZE)["doubts"] == [again]
    assert f"! {again}" in printed(tmp_path, *SIZE, "--output", tmp_path / "all.html")
    assert again in (tmp_path / "all.html").read_text("utf-8")


def test_processes_change_nothing(answered, rocked, tmp_path, monkeypatch):
    """Trials in two processes, as one after the other."""
    monkeypatch.setattr(identification, "_FEW", 1)
    for k in range(3):
        times_file(tmp_path / f"{k:02d}.csv", rocked[0][: 6 if k else 3], seed=k)
    one, two = (answered(tmp_path, *SIZE, "--workers", count) for count in (1, 2))
    assert one == two


def test_a_video_is_one_command(printed, refuses, tmp_path):
    """Slow motion of a block, and a region that is none."""
    pytest.importorskip("cv2", reason="OpenCV is not installed")
    path, case = tmp_path / "drop.mp4", identification_video.rocked(1)
    identification_video.filmed(path, case, 1, 30.0, 4.0)
    sizes = ("--width", case["body"].width, "--height", case["body"].height)
    page = printed(path, *sizes, "--set", "measurement.frame_rate=30", "--set", "identify.size_error=0.02")
    assert "The coefficient of restitution is 0." in page
    assert "reduces rotations by 1.5 %" in " ".join(page.split())
    refuses((path, *sizes, "--set", "measurement.region=[1,2]"), "region must be four numbers")


def test_what_is_no_rocking_gives_no_number(run, tmp_path):
    """A metronome: exit code 2, why, and if asked for a picture of what was measured."""
    path, picture = tmp_path / "metronome.csv", tmp_path / "metronome.png"
    path.write_text("\n".join(["time [s]", *(f"{0.5 * k:.4f}" for k in range(1, 15))]), "utf-8")
    code, out, err = run(path, *SIZE, "--output", picture)
    assert (code, out) == (2, "")
    assert "No coefficient of restitution" in err
    assert str(picture) in err
    assert picture.stat().st_size > 10_000
    found = identify(read_measurement(path), BLOCK)
    assert set(found.answer().values) == {"source", "verdict", "refused", "doubts"}


@pytest.mark.speed
@pytest.mark.verifies("behaviour", "a minute of sound at 44.1 kHz", within="2 s of CPU", room="doors")
def test_a_minute_takes_seconds(answered, phone, tmp_path):
    """From file to answer, with a rocking body in the middle."""
    from rocking.identification.readers.recording import read_wav

    samples = read_wav(phone.read_bytes(), "phone").samples[:, 0]
    quiet = np.random.default_rng(1).normal(0.0, samples[: RATE // 4].std(), (2, 27 * RATE))
    path = tmp_path / "minute.wav"
    path.write_bytes(wav(np.concatenate([quiet[0], samples, quiet[1]])[: 60 * RATE].clip(-1.0, 1.0)))
    begun = time.process_time()
    answered(path, *SIZE)
    assert time.process_time() - begun < allowed(2.0)


@pytest.mark.speed
@pytest.mark.verifies("behaviour", "a folder of 200 trials of times", within="60 s of CPU", room="doors")
def test_200_trials_take_a_minute(answered, rocked, tmp_path):
    """From folder to table, in as many processes as there are processors; CPU is theirs too."""
    for k in range(200):
        times_file(tmp_path / f"{k:03d}.csv", rocked[0], seed=k)
    spent = sum(os.times()[:4])
    assert len(answered(tmp_path, *SIZE, "--output", tmp_path / "all.csv")["trials"]) == 200
    assert sum(os.times()[:4]) - spent < allowed(60.0)
