"""`rocking record batch` and `rocking record convert`, and what other commands make of a folder of records."""

import csv
import json
import re
import warnings

import numpy as np
import pytest

from rocking.errors import PlausibilityWarning
from rocking.motions import GroundMotion, processed
from rocking.motions.formats import read_motion, write_motion

BLOCK = ["--width", "0.4", "--height", "1.6"]


@pytest.fixture
def folder(tmp_path):
    """Return a folder of three pairs of records and a damaged one."""
    rng = np.random.default_rng(2)
    place = tmp_path / "records"
    place.mkdir()
    for k in range(3):
        for azimuth in ("000", "090"):
            values = np.convolve(rng.standard_normal(400), np.hanning(9), "same") * np.hanning(400)
            motion = GroundMotion(values, 0.02, None, f"Shake{k}", {"component": azimuth, "station": "Cellar"})
            write_motion(motion, place / f"RSN{k}_A{azimuth}.AT2", "peer")
    (place / "damaged.at2").write_text("A\nB\nC\nNPTS= 9, DT= .01 SEC\n1 2 3\n", encoding="utf-8")
    return place


@pytest.mark.slow
def test_a_folder_becomes_a_flatfile(run, folder, tmp_path):
    """One row a record in CSV, Excel and netCDF; the damaged file is named on the page, and in the workbook."""
    files = [tmp_path / f"flat{ending}" for ending in (".csv", ".xlsx", ".nc", ".png")]
    options = [word for file in files for word in ("--output", str(file))]
    code, out, err = run("record", "batch", folder, "--periods", "0.2,1", "--workers", 1, *options)
    assert (code, err) == (0, "")
    assert "left out" in out
    assert "damaged.at2" in out
    rows = list(csv.DictReader(files[0].read_text("utf-8").splitlines()))
    assert [row["event"] for row in rows] == ["Shake0", "Shake1", "Shake2"]
    for row in rows:
        half, full = float(row["sa_rotd50(1) [m/s2]"]), float(row["sa_rotd100(1) [m/s2]"])
        assert 0.0 < half < full
        assert full >= max(float(row["sa_x(1) [m/s2]"]), float(row["sa_y(1) [m/s2]"])) * (1.0 - 1e-12)
    openpyxl = pytest.importorskip("openpyxl")
    assert openpyxl.load_workbook(files[1]).sheetnames == ["records", "left out"]
    xarray = pytest.importorskip("xarray")
    with xarray.open_dataset(files[2], engine="h5netcdf") as dataset:
        assert dataset["sa_rotd50"].shape == (3, 2)
    assert files[3].stat().st_size > 1000


@pytest.mark.filterwarnings("always:check the input")
def test_a_doubt_names_its_file_once(run, folder):
    """Whether the motion doubts it or the reader, who names it too."""
    rows = [f"{0.25 * k}, {60.0 * np.sin(k):.6f}" for k in range(60)]
    (folder / "odd.csv").write_text("\n".join(["time [s], x [m/s2]", *rows]), "utf-8")
    _, _, err = run("record", "batch", folder / "odd.csv", "--workers", 1, "--periods", "1,2")
    lines = [line for line in err.splitlines() if "odd.csv" in line]
    assert len(lines) >= 2
    assert all(line.count("odd.csv") == 1 for line in lines)


@pytest.mark.filterwarnings("always:check the input")
def test_many_doubts_are_counted(run, tmp_path):
    """Of many doubts five are said and the rest counted; the table has every one beside its record."""
    rows = [f"{0.25 * k}, {30.0 * np.sin(k):.6f}" for k in range(60)]
    for k in range(7):
        (tmp_path / f"odd{k}.csv").write_text("\n".join(["time [s], x [m/s2]", *rows]), "utf-8")
    _, _, err = run("record", "batch", tmp_path, "--workers", 1, "--periods", "1,2", "--output", tmp_path / "flat.csv")
    said = [line for line in err.splitlines() if "odd" in line or "more doubts" in line]
    assert len(said) == 6
    assert "more doubts" in said[-1]
    found = list(csv.DictReader((tmp_path / "flat.csv").read_text("utf-8").splitlines()))
    assert all(row["doubts"] for row in found)


def test_a_target_chooses_and_scales(run, folder):
    """Two of three records come with their factors and misfits, and the sentence of the set."""
    words = ["--set", "motion.target=eurocode8:ag=0.3g,ground=B", "--set", "motion.count=2", "--periods", "1"]
    code, out, _ = run("record", "batch", folder, *words, "--json")
    found = json.loads(out)
    assert code == 0
    assert (len(found["records"]), len(found["selection"]["scale"])) == (2, 2)
    assert found["selection"]["misfit"] == sorted(found["selection"]["misfit"])
    code, out, _ = run("record", "batch", folder, *words)
    assert "misfits" in out


@pytest.mark.slow
def test_other_commands_take_sets(run, printed, folder, tmp_path):
    """Predict takes pairs as one motion, fragility each component, doubled by mirrors; a job file says the same."""
    few = ["--set", "predict.count=4", "--set", "predict.contributions=false"]
    out = printed("predict", *BLOCK, folder, *few, "--json")
    assert len(json.loads(out)["motions"]) == 3
    pattern = str(folder / "RSN*.AT2")
    words = ["--motion", pattern, "--set", "motion.mirrored=true", "--levels", "2,4"]
    code, out, _ = run("fragility", *BLOCK, *words)
    assert (code, "12 records" in out) == (0, True)
    job = tmp_path / "job.toml"
    job.write_text(
        '[campaign]\nname = "a"\nkind = "stripes"\n[body]\nunits = "m"\nwidth = 0.4\nheight = 1.6\n'
        f'[fragility]\nlevels = [2.0, 4.0]\n[[motions]]\nrecords = "{folder.name}/RSN*.AT2"\nmirrored = true\n',
        encoding="utf-8",
    )
    assert "12 records" in run("fragility", job)[1]


def test_simulate_has_a_row_for_each_record(run, folder):
    """A folder gives a row a record, each the response of that record alone; two pulses two."""
    code, out, _ = run("simulate", *BLOCK, folder, "--json")
    rows = json.loads(out)
    assert code == 0
    assert len(rows["motions"]) == 6
    assert rows["overturned"] == sum(row["outcome"] == "overturned" for row in rows["motions"])
    one = json.loads(run("simulate", *BLOCK, f"{folder}/RSN1_A000.AT2", "--json")[1])
    peaks = [row["peak_rotation"] for row in rows["motions"]]
    assert any(peak == pytest.approx(abs(one["peak_rotation"])) for peak in peaks)
    code, out, _ = run("simulate", *BLOCK, "sine:amplitude=1,period=0.8", "sine:amplitude=9,period=0.8")
    assert "Overturning under 1 of 2 motions." in out
    assert "no uplift" in out


def test_columns_of_a_list_are_read_or_refused(run, refuses, folder):
    """A factor scales, in words that people use; what a list cannot say of a row is refused, not passed over."""
    name = "RSN0_A000.AT2"
    peaks = []
    for head, factor in (("motion,scale", 1), ("file,factor", 3), ("Aufzeichnung,Skalierung", 3)):
        (folder / "list.csv").write_text(f"{head}\n{name},{factor}\n")
        _, out, _ = run("record", "batch", folder / "list.csv", "--periods", "1", "--json")
        (record,) = json.loads(out)["records"]
        peaks.append(max(record[key] for key in ("pga_x", "pga_y") if record[key] is not None))
    assert peaks[1:] == pytest.approx([3.0 * peaks[0]] * 2)
    (folder / "list.csv").write_text(f"file,units\n{name},g\n")
    assert run("record", "batch", folder / "list.csv", "--periods", "1")[0] == 0
    (folder / "list.csv").write_text(f"file,units\n{name},cm/s2\n")
    refuses(["record", "batch", folder / "list.csv"], "the file states the unit g, not cm/s2")


@pytest.mark.filterwarnings("always:check the input")
def test_a_source_without_horizontal_records_is_left_out(run, refuses, folder, tmp_path):
    """Beside others it is told; alone it is refused."""
    upright = tmp_path / "upright"
    upright.mkdir()
    write_motion(GroundMotion([0.0, 1.0, -1.0, 0.0] * 20, 0.02), upright / "S-UP.AT2", "peer")
    words = ["code-checks", *BLOCK]
    code, _, err = run(*words, folder / "RSN0_A000.AT2", upright)
    assert (code, "without horizontal component" in err) == (0, True)
    refuses([*words, upright], "horizontal component")


@pytest.mark.slow
def test_convert_turns_two_components(run, refuses, tmp_path):
    """Both are written after their turn, by hand; another angle is another record; some formats hold one alone."""
    a, b = np.sin(0.3 * np.arange(400)), np.cos(0.2 * np.arange(400)) ** 3
    for name, values in (("a", a), ("b", b)):
        rows = "\n".join(f"{0.01 * k:.2f},{float(value)!r}" for k, value in enumerate(values))
        (tmp_path / f"{name}.csv").write_text(f"time [s],{name} [m/s2]\n{rows}\n")
    words = [f"x={tmp_path / 'a.csv'}", f"y={tmp_path / 'b.csv'}"]
    for angle in (30, 40):
        out = ["--output", f"columns={tmp_path / f'{angle}.csv'}", "--output", tmp_path / "turned.png"]
        assert run("record", "convert", *words, "--set", f"motion.process=rotate:angle={angle}", *out)[0] == 0
    c, s = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    read = [np.loadtxt(tmp_path / f"{angle}.csv", delimiter=",")[:, 1:].T for angle in (30, 40)]
    np.testing.assert_allclose(read[0], [c * a + s * b, c * b - s * a], atol=1e-12)
    assert not np.allclose(read[1], read[0], atol=0.1)
    _, told, _ = run("record", "convert", *words, "--json")
    assert set(json.loads(told)["components"]) == {"x", "y"}
    refuses(["record", "convert", *words, "--output", tmp_path / "one.at2"], "peer allows 1")


@pytest.mark.parametrize("word", ["{}", "x={}", "{}#acceleration"])
def test_convert_keeps_its_source(run, tmp_path, word):
    """However it is named, also by another path, the record is there afterwards as it was before."""
    own = tmp_path / "own.csv"
    own.write_text("time [s],acceleration [m/s2]\n" + "\n".join(f"{0.01 * k:.2f},{k % 3}" for k in range(50)), "utf-8")
    before = own.read_bytes()
    for out in (own, tmp_path / ".." / tmp_path.name / "own.csv", f"columns={own}"):
        code, _, err = run("record", "convert", word.format(own), "--output", out)
        assert code == 2
        assert "would overwrite an input file" in err
    assert own.read_bytes() == before


@pytest.mark.slow
def test_convert_to_another_unit(run, refuses, tmp_path):
    """A record in gal is written in g or m/s2 with the unit in its header; without the option it keeps its unit."""
    source = tmp_path / "site.csv"
    source.write_text("time [s],acceleration [gal]\n0.00,0.0\n0.01,98.0665\n0.02,-49.03325\n0.03,0.0\n", "utf-8")
    peaks = {}
    for words, unit in (((), "gal"), (("--output-units", "G"), "g"), (("--output-units", "m/s2"), "m/s2")):
        target = tmp_path / f"in_{unit.partition('/')[0]}.csv"
        assert run("record", "convert", source, *words, "--output", target)[0] == 0
        header, *rows = csv.reader(target.read_text("utf-8").splitlines())
        assert header[-1].endswith(f" [{unit}]")
        peaks[unit] = max(float(row[-1]) for row in rows)
        assert read_motion(target).peak == pytest.approx(0.980665, rel=1e-9)
    assert peaks == pytest.approx({"gal": 98.0665, "g": 0.1, "m/s2": 0.980665}, rel=1e-9)
    refuses(["record", "convert", source, "--output-units", "furlong"], "--output-units")
    fixed = ["record", "convert", source, "--output-units", "gal", "--output", tmp_path / "site.at2"]
    refuses(fixed, "--output-units needs an output file of a format without a fixed unit: ")
    assert not fixed[-1].exists()


@pytest.mark.slow
def test_convert(run, folder, tmp_path):
    """A record goes through its steps into another format, drawn before and after, with what was done to it."""
    source, made = folder / "RSN0_A000.AT2", [tmp_path / name for name in ("new.at2", "new.png", "new.json")]
    options = [word for file in made for word in ("--output", str(file))]
    words = "mean; bandpass:low=0.2,high=20; taper"
    code, out, err = run("record", "convert", source, "--set", f"motion.process={words}", *options)
    assert (code, err) == (0, "")
    expected = processed(read_motion(source), words)
    found = read_motion(made[0])
    assert found.acceleration == pytest.approx(expected.acceleration, abs=1e-6 * expected.peak)
    assert json.loads(made[2].read_text("utf-8"))["provenance"] == list(expected.provenance)
    assert "band-pass 0.2 to 20 Hz" in out
    assert run("record", "convert", source, "--set", "motion.process=polish")[0] == 2


def test_a_file_says_what_options_say(run, refuses, folder, tmp_path):
    """A TOML with [motion] or [[motions]] gives the answer of the words; what does not fit is refused."""
    chain, source = ["mean", "bandpass:low=0.2,high=20", "taper"], folder / "RSN0_A000.AT2"
    one, many = folder / "one.toml", tmp_path / "many.toml"
    one.write_text(f'[motion]\nrecord = "{source.name}"\nprocess = {json.dumps(chain)}\n')
    many.write_text(f'[[motions]]\nrecords = ["{folder.name}"]\ntarget = "eurocode8:ag=0.2g"\ncount = 2\n')
    typed = json.loads(run("record", "convert", source, "--set", f"motion.process={'; '.join(chain)}", "--json")[1])
    assert json.loads(run("record", "convert", one, "--json")[1]) == typed
    assert typed["before"]["peak_ground_acceleration"] != typed["after"]["peak_ground_acceleration"]
    assert typed["metadata"]["station"]
    one.unlink()
    words = ["--set", "motion.target=eurocode8:ag=0.2g", "--set", "motion.count=2"]
    expected = json.loads(run("record", "batch", folder, *words, "--json")[1])
    assert json.loads(run("record", "batch", many, "--json")[1])["selection"] == expected["selection"]
    assert expected["selection"]["sentence"].startswith("2 records scaled by ")
    one.write_text(f'[motion]\nrecord = "{source.name}"\nprocess = ["taper", "mean", "taper:fraction=2"]\n')
    refuses(["record", "convert", one], "step 3, taper: fraction must be")
    refuses(["record", "convert", one, "--units", "g"], "contains the whole input")
    refuses(["record", "convert", one, "--set", "motion.pulse=sine:amplitude=3,period=0.8"], "exactly one of")
    many.write_text('[[motions]]\npulse = ["sine:amplitude=3,period=0.8"]\n')
    refuses(["record", "batch", many], "records is missing")


@pytest.mark.slow
@pytest.mark.parametrize("command", ["assess", "code-checks"])
def test_a_record_of_zeros_does_not_stop_a_folder(run, folder, command):
    """It is left out with its reason as damaged ones are; a folder of nothing else is refused."""
    quick = ["--set", "predict.count=8", "--set", "predict.contributions=false"] if command == "assess" else []
    still = GroundMotion(np.zeros(400), 0.02, None, "Still", {"component": "000", "station": "Cellar"})
    write_motion(still, folder / "RSN9_A000.AT2", "peer")
    with warnings.catch_warnings():
        warnings.simplefilter("always", PlausibilityWarning)
        code, out, err = run(command, *BLOCK, "--restitution", "0.9", *quick, folder, "--json")
    assert code == 0, err
    assert re.search("ignored: Still.*: zero acceleration at all times", err)
    assert "damaged.at2" in err
    assert not any("Still" in name for name in json.loads(out)["motions"])
    for path in folder.iterdir():
        if path.name != "RSN9_A000.AT2":
            path.unlink()
    code, out, err = run(command, *BLOCK, "--restitution", "0.9", *quick, folder)
    assert (code, out) == (2, "")
    assert "Every record has zero acceleration" in err


@pytest.fixture
def mixed(tmp_path, monkeypatch):
    """Return a folder of two records without unit and step, 0.3 g and 300 cm/s2 at most, and one elsewhere, 3 m/s2."""
    monkeypatch.chdir(tmp_path)
    for name, peak in (("mixed/a.txt", 0.3), ("mixed/b.txt", 300.0), ("other/c.txt", 3.0)):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text("\n".join(f"{peak * np.cos(0.2 * k) * 0.99**k:.8f}" for k in range(200)), "utf-8")
    return tmp_path / "mixed"


PEAKS = [0.3 * 9.80665, 3.0, 3.0]
OPTIONS = 'motion.files={"a.txt" = {units = "g"}, "mixed/b.txt" = {units = "cm/s2", time_step = 0.02}}'


@pytest.mark.filterwarnings("ignore:check the input")
def test_options_of_single_files(run, mixed):
    """One table serves a TOML file and `--set`: a folder, files of one folder, and files of several folders."""
    question = mixed.parent / "question.toml"
    question.write_text(
        '[[motions]]\nrecords = ["mixed", "other/c.txt"]\nunits = "m/s2"\ntime_step = 0.01\n'
        '[motions.files."a.txt"]\nunits = "g"\n[motions.files."b.txt"]\nunits = "cm/s2"\ntime_step = 0.02\n',
        encoding="utf-8",
    )
    usual = ["--units", "m/s2", "--set", "motion.time_step=0.01", "--set", OPTIONS]
    for words in (
        ["record", "batch", question, "--workers", 1],
        ["record", "batch", "mixed", "other/c.txt", "--workers", 1, *usual],
        ["record", "batch", "mixed/a.txt", "mixed/b.txt", "other/c.txt", "--workers", 1, *usual],
    ):
        code, out, err = run(*words, "--periods", "1", "--json")
        assert code == 0, err
        rows = json.loads(out)["records"]
        assert [row["pga_x"] for row in rows] == pytest.approx(PEAKS, rel=1e-6)
        assert [row["time_step"] for row in rows] == [0.01, 0.02, 0.01]
    for word in ("mixed/b.txt", "other/c.txt"):  # files of one folder, and of two, which are read one by one
        options = ["--units", "m/s2", "--set", "motion.time_step=0.01", "--set", 'motion.files={"a.txt"={units="g"}}']
        code, out, _ = run("simulate", *BLOCK, "mixed/a.txt", word, *options, "--json")
        assert code == 0
        peaks = [row["peak_ground_acceleration"] for row in json.loads(out)["motions"]]
        assert peaks[0] == pytest.approx(PEAKS[0], rel=1e-6)
        assert peaks[1] == pytest.approx(300.0 if word == "mixed/b.txt" else 3.0, rel=1e-6)


@pytest.mark.filterwarnings("ignore:check the input")
def test_options_of_a_file_that_is_not_there(run, refuses, mixed):
    """A name that is no file of the set, an unknown key, and a file that is left without a unit are named."""
    usual = ["--set", "motion.time_step=0.01", "--set"]
    for records in (["mixed"], ["mixed/a.txt", "mixed/b.txt"], ["mixed/a.txt", "other/c.txt"]):
        words = ["record", "batch", *records, *usual, 'motion.files={"d.txt"={units="g"}}']
        refuses(words, "files: this set does not contain the file 'd.txt'")
    refuses(
        ["record", "batch", "mixed", *usual, 'motion.files={"a.txt"={unit="g"}}'], "files.a.txt: unknown key 'unit'"
    )
    one = 'motion.files={"a.txt"={units="g"}}'
    refuses(["record", "batch", "mixed/a.txt", "mixed/b.txt", *usual, one], "b.txt: the file does not state its unit")
    refuses(["simulate", *BLOCK, "mixed/a.txt", "other/c.txt", *usual, one], "c.txt: the file does not state its unit")
    refuses(["fragility", *BLOCK, "--synthetic", "firm-ground", "--set", one], "files is not allowed with synthetic")
