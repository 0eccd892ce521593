"""Sets of records: which files are one motion, what is left out, and lists."""

import numpy as np
import pytest

from rocking.errors import InvalidValueError, RecordError
from rocking.motions import GroundMotion
from rocking.motions.formats import read_records, write_motion
from rocking.motions.formats.record_set import orientation

pytestmark = pytest.mark.verifies(room="motions and records")


@pytest.fixture
def write(tmp_path):
    """Return what writes a small PEER file: its name, component, peak, number of samples and step."""

    def call(name, component="", peak=1.0, samples=50, step=0.01, event="Shake", folder=tmp_path):
        folder.mkdir(exist_ok=True)
        values = peak * np.sin(np.arange(samples) * 0.2)
        told = {"component": component} if component else {}
        write_motion(GroundMotion(values, step, None, event, {"station": "Cellar", **told}), folder / name, "peer")

    return call


def _seen(records):
    return [[None if part is None else part.metadata["file"] for part in record.parts] for record in records]


@pytest.mark.parametrize(
    ("name", "ends"),
    [
        ("RSN8_EV_ELC{}.AT2", ("270", "180", "-UP")),
        ("ABC.{}", ("EW", "NS", "UD")),
        ("IV.MRN..{}.D.1.ASC", ("HNE", "HNN", "HNZ")),
        ("kobe_{}.at2", ("x", "y", "z")),
    ],
)
def test_components_by_their_names(write, tmp_path, name, ends):
    """Names that differ in the component alone are one motion, x to the right of y, z upwards."""
    said = {"NS": "N-S", "EW": "E-W", "UD": "U-D"}
    expected = [name.format(end) for end in ends]
    for file in expected:
        end = file.rpartition(".")[2]
        write(file, said.get(end) or next((code for code in ("HNE", "HNN", "HNZ") if code in file), ""))
    assert _seen(read_records(tmp_path)) == [expected]


def test_what_does_not_fit_stands_alone(write, tmp_path):
    """Numbered files, other steps, other events and azimuths without a right angle are no pairs, and it is said."""
    for name in ("run100.at2", "run200.at2", "a_000.at2", "b_000.at2", "c_000.at2"):
        write(name)
    write("a_090.at2", step=0.02)
    write("b_090.at2", event="Another")
    write("c_090.at2")
    found = read_records(tmp_path)
    assert sorted(map(str, _seen(found))) == sorted(
        map(str, [["run100.at2", None, None], ["run200.at2", None, None], ["a_000.at2", None, None],
                  ["a_090.at2", None, None], ["b_000.at2", None, None], ["b_090.at2", None, None],
                  ["c_090.at2", "c_000.at2", None]])
    )  # fmt: skip
    reasons = dict(found.left_out)
    assert "not perpendicular" in reasons["run100.at2, run200.at2"]
    assert "steps" in reasons["a_000.at2, a_090.at2"]
    assert "events" in reasons["b_000.at2, b_090.at2"]


def test_lengths_and_signs(write, tmp_path):
    """Components are cut to the shortest; one that points down is turned up."""
    write("A_000.at2", samples=50)
    write("A_090.at2", samples=40)
    write("A_DWN.at2", samples=60, peak=2.0)
    (record,) = read_records(tmp_path)
    assert {len(part) for part in record.parts} == {40}
    assert record.z.acceleration[1] == pytest.approx(-2.0 * np.sin(0.2), rel=1e-6)
    assert "positive downwards" in record.z.provenance[-1]
    level = read_records(tmp_path).plane()
    assert [motion.vertical is not None for motion in level] == [True, True]
    mirrored = read_records(tmp_path).mirrored()
    assert len(mirrored) == 2
    assert mirrored[1].x.acceleration.tolist() == (-record.x.acceleration).tolist()
    assert mirrored[1].z.acceleration.tolist() == record.z.acceleration.tolist()


@pytest.mark.verifies("damage", "damaged files among good ones")
def test_damaged_files_are_listed(write, tmp_path):
    """A folder gives what can be read, and the reason of what cannot; one of damaged files alone is refused."""
    write("good.at2", "N")
    text = (tmp_path / "good.at2").read_text("latin-1")
    (tmp_path / "cut.at2").write_text(text[: len(text) // 2], "latin-1")
    (tmp_path / "notes.md").write_text("nothing", "utf-8")
    (tmp_path / ".hidden.at2").write_text("nothing", "utf-8")
    found = read_records(tmp_path)
    assert _seen(found) == [["good.at2", None, None]]
    assert [name.rpartition("/")[2] for name, _ in found.left_out] == ["cut.at2", "notes.md"]
    (tmp_path / "good.at2").unlink()
    with pytest.raises(RecordError, match="0 of 2 files"):
        read_records(tmp_path)
    with pytest.raises(RecordError, match="no such file"):
        read_records(tmp_path / "nowhere")
    with pytest.raises(RecordError, match="no file matches"):
        read_records(tmp_path / "*.smc")


def test_a_list(write, tmp_path):
    """Rows name files, or one along each axis, with a factor and a name; rows that make no sense are refused."""
    for name in ("one.at2", "two.at2", "three.at2"):
        write(name)
    path = tmp_path / "list.csv"
    path.write_text("x;y;z;scale;name\none.at2;two.at2;three.at2;1,5;Mine\none.at2;;;;\ngone.at2;;;;\n", "utf-8")
    found = read_records(path)
    assert _seen(found) == [["one.at2", "two.at2", "three.at2"], ["one.at2", None, None]]
    assert (found[0].x.name, found[1].x.name) == ("Mine", "Shake Cellar")
    assert found[0].x.peak == pytest.approx(1.5 * found[1].x.peak)
    assert "no such file" in str(found.left_out[0][1])
    path.write_text("motion,scale\none.at2,much\n", "utf-8")
    with pytest.raises(InvalidValueError, match="a number as scale"):
        read_records(path)


def test_results_of_a_search_at_peer(write, tmp_path):
    """PEER's list of what was found: the files of a row are one motion; its factor is kept and not applied."""
    for name in ("RSN1_A000.AT2", "RSN1_A090.AT2", "RSN1_A-UP.AT2", "RSN2_B000.AT2", "RSN2_B090.AT2"):
        write(name)
    path = tmp_path / "_SearchResults.csv"
    path.write_text(
        "PEER Ground Motion Database\n\n -- Summary of Metadata of Selected Records --\n"
        "Result ID, Record Sequence Number, Scale Factor, Magnitude, Horizontal-1 Acc. Filename,"
        " Horizontal-2 Acc. Filename, Vertical Acc. Filename\n"
        "1, 1, 2.5, 6.5, RSN1_A000.AT2, RSN1_A090.AT2, RSN1_A-UP.AT2\n"
        "2, 2, 1.5, 7.0, RSN2_B000.AT2, RSN2_B090.AT2, -----\n"
        "\n -- Scaled Spectra used in Search & Scaling --\nPeriod (sec),RSN-1\n0.01,0.5\n",
        "utf-8",
    )
    found = read_records(path)
    expected = [["RSN1_A000.AT2", "RSN1_A090.AT2", "RSN1_A-UP.AT2"], ["RSN2_B000.AT2", "RSN2_B090.AT2", None]]
    assert _seen(found) == expected
    assert found[0].x.metadata["PEER scale factor"] == "2.5"
    assert found[0].x.peak == pytest.approx(1.0, rel=0.01)  # the largest sample of the sine is 0.4 % below its peak
    assert found.left_out == ()


def test_names_of_components():
    """Azimuths by number, compass and side; codes of SEED; up and down; what says nothing is None."""
    said = {"360": 0.0, "90": 90.0, "S45W": 225.0, "EW": 90.0, "HNN": 0.0, "BHZ": "up", "Dwn": "down", "L (A)": None}
    assert {name: orientation(name) for name in said} == said


def test_a_list_with_a_unit_for_each_file(tmp_path):
    """Files of mixed units and steps are one set: their rows say how each is read; a row without a unit asks for it."""
    for name, factor in (("a.txt", 1.0), ("b.txt", 980.665), ("c.txt", 1.0)):
        rows = [f"{factor * np.sin(0.2 * k):.8f}" for k in range(60)]
        (tmp_path / name).write_text("\n".join(rows), "utf-8")
    path = tmp_path / "list.csv"
    path.write_text("motion,units,time_step,name\na.txt,g,0.01,A\nb.txt,cm/s2,0.02,B\nc.txt,,0.01,C\n", "utf-8")
    found = read_records(path)
    assert [(one.x.name, one.x.time_step) for one in found] == [("A", 0.01), ("B", 0.02)]
    assert found[0].x.acceleration == pytest.approx(found[1].x.acceleration, abs=1e-6)
    assert "does not state its unit" in str(found.left_out[0][1])
    assert len(read_records(path, units="m/s2")) == 3
    path.write_text("motion;units;time_step\na.txt;g;0,01\n", "utf-8")
    assert read_records(path)[0].x.time_step == 0.01
    path.write_text("motion,units,time_step\na.txt,g,quick\n", "utf-8")
    with pytest.raises(InvalidValueError, match="time_step of a row must be a number"):
        read_records(path)


def _plain(path, factor, step_of_wave=0.2):
    """Write accelerations without unit and time step: 0.3 times a factor at most."""
    path.parent.mkdir(exist_ok=True)
    path.write_text("\n".join(f"{0.3 * factor * np.cos(step_of_wave * k):.8f}" for k in range(60)), "utf-8")


def test_options_of_single_files(tmp_path):
    """Unit, step, format and lines to skip of a file replace those of all, and stand in its provenance alone."""
    _plain(tmp_path / "a.txt", 1.0)
    _plain(tmp_path / "b.txt", 980.665)
    _plain(tmp_path / "c.txt", 9.80665)
    (tmp_path / "c.txt").write_text("17 rows\n18 rows\n" + (tmp_path / "c.txt").read_text("utf-8"), "utf-8")
    with_words = {"units": "m/s2", "time_step": 0.02, "skip": 2, "format": "columns"}
    options = {"a.txt": {"units": "g"}, "b.txt": {"units": "cm/s2"}, "c.txt": with_words}
    found = read_records(tmp_path, time_step=0.01, files=options)
    assert [part.x.peak for part in found] == pytest.approx([0.3 * 9.80665] * 3, rel=1e-7)
    assert [part.x.time_step for part in found] == [0.01, 0.01, 0.02]
    stated = "stated by the user: format columns, unit m/s2, time step 0.02 s, lines skipped at the top 2"
    assert [stated in part.x.provenance for part in found] == [False, False, True]
    assert "stated by the user: unit g, time step 0.01 s" in found[0].x.provenance
    without = read_records(tmp_path, time_step=0.01, files={"c.txt": with_words})
    assert [(name.rpartition("/")[2], "does not state its unit" in str(why)) for name, why in without.left_out] == [
        ("a.txt", True), ("b.txt", True),
    ]  # fmt: skip


def test_a_wrong_unit_of_a_file_is_seen(tmp_path):
    """Negative control: another unit gives another peak, and one that the file contradicts leaves the file out."""
    _plain(tmp_path / "a.txt", 1.0)
    (tmp_path / "b.csv").write_text("time [s],x [cm/s2]\n0,0\n0.01,50\n0.02,-20\n0.03,5\n", "utf-8")
    right, wrong = (read_records(tmp_path, time_step=0.01, files={"a.txt": {"units": unit}}) for unit in ("g", "gal"))
    assert right[0].x.peak / wrong[0].x.peak == pytest.approx(980.665, rel=1e-9)
    assert [len(right), len(wrong)] == [2, 2]
    odd = read_records(tmp_path, units="g", time_step=0.01, files={"b.csv": {"units": "g"}})
    assert (len(odd), "states the unit cm/s2, not g" in str(odd.left_out[0][1])) == (1, True)


def test_names_of_single_files(tmp_path):
    """A name is that of one file, with folders where two files share it; keys and values are those that exist."""
    for name in ("north/a.txt", "south/a.txt", "south/b.txt"):
        _plain(tmp_path / name, 1.0)
    how = {"units": "m/s2", "time_step": 0.01}
    found = read_records(tmp_path, **how, files={"south/a.txt": {"units": "g"}})
    assert [round(part.x.peak, 9) for part in found] == [0.3, round(0.3 * 9.80665, 9), 0.3]
    for files, words in {
        "d.txt": ({"units": "g"}, r"files: this set does not contain the file 'd\.txt'"),
        "east/b.txt": ({"units": "g"}, r"does not contain the file 'east/b\.txt'; did you mean 'b\.txt'"),
        "a.txt": ({"units": "g"}, "must match one file of this set, got .*north/a.txt, .*south/a.txt"),
        "b.txt": ({"unit": "g"}, "b.txt: key must be one of units, time_step, format, skip, got 'unit'"),
        "south/b.txt": ({"units": "gg"}, "b.txt: units must be one of"),
        "south/a.txt": ({"time_step": 0.0}, "a.txt: time_step must be > 0"),
        "north/a.txt": ({"skip": -1}, "a.txt: skip must be a whole number"),
    }.items():  # fmt: skip
        with pytest.raises(InvalidValueError, match=words[1]):
            read_records(tmp_path, **how, files={files: words[0]})
    with pytest.raises(InvalidValueError, match=r"two entries for .*b\.txt"):
        read_records(tmp_path, **how, files={"b.txt": {"units": "g"}, "south/b.txt": {"units": "g"}})


def test_single_files_of_a_list(tmp_path):
    """A file of a list takes what its row leaves open; a key in both places is refused."""
    for name in ("a.txt", "b.txt"):
        _plain(tmp_path / name, 1.0)
    path = tmp_path / "list.csv"
    path.write_text("x,y,units\na.txt,b.txt,\n", "utf-8")
    (record,) = read_records(path, time_step=0.01, files={"a.txt": {"units": "g"}, "b.txt": {"units": "m/s2"}})
    assert record.x.peak / record.y.peak == pytest.approx(9.80665, rel=1e-9)
    path.write_text("motion,units\na.txt,g\n", "utf-8")
    with pytest.raises(
        InvalidValueError,
        match=r"list\.csv: units of a\.txt is given twice: in its row of the list and in the table files; remove one",
    ):
        read_records(path, time_step=0.01, files={"a.txt": {"units": "g"}})
    with pytest.raises(InvalidValueError, match=r"this set does not contain the file 'b\.txt'"):
        read_records(path, time_step=0.01, files={"b.txt": {"units": "g"}})
