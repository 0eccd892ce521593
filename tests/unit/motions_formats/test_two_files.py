"""The vertical component in a file of its own, as PEER, ESM and K-NET have it."""

import hashlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rocking.errors import InvalidValueError, RecordError
from rocking.motions import GroundMotion, with_vertical
from rocking.motions.formats import Component, Record, read_motion, write_motion, write_record

TIME = np.arange(100) * 0.02
# whole periods in whole seconds: K-NET records have no mean
ALONG, UP = 3.0 * np.sin(3.0 * np.pi * TIME), np.cos(4.0 * np.pi * TIME)


def written(
    folder: Path, format: str, name: str, values: np.ndarray, step: float = 0.02, unit: str = "m/s2", **told: str
) -> Path:
    """A file of one component."""
    path = folder / f"{format} {name}"
    known = {"event": "Somewhere", "station": "Cellar", **told}
    # ESM calls the component a channel; the others take the name
    part = Component(name, values, unit, step)
    write_record(Record(format, (part,), metadata={**known, "channel": name}), path, format)
    return path


@pytest.mark.parametrize(
    ("format", "name", "up"), [("peer", "90", "UP"), ("esm", "HNE", "HNZ"), ("knet", "E-W", "U-D")]
)
def test_two_files_are_one_motion(format: str, name: str, up: str, tmp_path: Path) -> None:
    """Samples of either file to the digits of its format, both digests, both names; and never the wrong way round."""
    along, upright = written(tmp_path, format, name, ALONG), written(tmp_path, format, up, UP)
    motion = read_motion(along, vertical_path=upright)
    assert motion.vertical is not None
    # the coarsest, PEER, has 7 digits of g
    np.testing.assert_allclose(motion.acceleration, ALONG, rtol=0.0, atol=2e-6)
    np.testing.assert_allclose(motion.vertical, UP, rtol=0.0, atol=2e-6)
    assert (motion.metadata["component"], motion.metadata["vertical component"]) == (name, up)
    for line, path in zip(motion.provenance, (along, upright), strict=True):
        assert hashlib.sha256(path.read_bytes()).hexdigest() in line
    assert motion.provenance[1].startswith(f"vertical part: read from {upright.name}, SHA-256 ")
    assert motion.metadata["vertical header"] != motion.metadata["header"]
    # the same by hand; and without the second file there is no vertical part
    again = with_vertical(read_motion(along), read_motion(upright))
    np.testing.assert_array_equal(again.vertical, motion.vertical)
    assert again.provenance == motion.provenance
    assert read_motion(along).vertical is None


def test_lengths_and_steps(tmp_path: Path) -> None:
    """The longer file is cut, which the provenance says; another step is refused."""
    along = written(tmp_path, "peer", "90", ALONG)
    short = read_motion(along, vertical_path=written(tmp_path, "peer", "UP", UP[:50]))
    assert len(short) == 50
    assert short.provenance[-1] == "components of 100 and 50 samples, both cut to 50"
    with pytest.raises(InvalidValueError, match=r"0\.02 s, got 0\.01 s; resample one motion first"):
        read_motion(along, vertical_path=written(tmp_path, "peer", "UP", UP, step=0.01))


def test_units_are_those_of_each_file(made_up: Callable[..., Record], tmp_path: Path) -> None:
    """A PEER file in g and a V2 file in cm/s2 come out in m/s2; columns take the one unit that is given."""
    along = written(tmp_path, "peer", "90", ALONG)
    three = tmp_path / "three.v2"
    write_record(made_up("90", "UP"), three, "csmip-v2")
    motion = read_motion(along, vertical="up", vertical_path=three)
    assert motion.vertical is not None
    expected = made_up("90", "UP").components[1].acceleration
    np.testing.assert_allclose(motion.vertical, expected, rtol=0.0, atol=1e-5)
    with pytest.raises(InvalidValueError, match="add vertical= with one of these"):
        read_motion(along, vertical_path=three)
    tables = [tmp_path / "a.txt", tmp_path / "b.txt"]
    for table, values in zip(tables, (ALONG, UP), strict=True):
        table.write_text("\n".join(f"{0.02 * k:.2f} {value!r}" for k, value in enumerate(values.tolist())))
    with pytest.raises(RecordError, match="add units="):
        read_motion(tables[0], vertical_path=tables[1])
    assert read_motion(tables[0], units="g", vertical_path=tables[1]).peak_vertical == pytest.approx(9.80665, rel=1e-6)


def test_no_component_is_both_parts(made_up: Callable[..., Record], tmp_path: Path) -> None:
    """The same component of the same content is refused, whatever the file is called; another one of it is not."""
    along = written(tmp_path, "peer", "90", ALONG)
    copy = tmp_path / "copy"
    copy.write_bytes(along.read_bytes())
    for path in (along, copy):
        with pytest.raises(InvalidValueError, match="contains the horizontal component 90, not the vertical one"):
            read_motion(along, vertical_path=path)
    two = tmp_path / "two.v2"
    write_record(made_up("90", "UP"), two, "csmip-v2")
    motion = read_motion(two, component="90", vertical="UP", vertical_path=two)
    np.testing.assert_array_equal(motion.vertical, read_motion(two, component="90", vertical="UP").vertical)


def test_files_that_state_different_starts(tmp_path: Path) -> None:
    """K-NET files that start a second apart are not laid over each other; what is silent or unclear is taken."""
    early, late = {"Record Time": "1999/12/31 19:51:43"}, {"Record Time": "1999/12/31 19:51:44"}
    along = written(tmp_path, "knet", "E-W", ALONG, **early)
    assert read_motion(along, vertical_path=written(tmp_path, "knet", "U-D", UP, **early)).vertical is not None
    with pytest.raises(RecordError, match="knet U-D: the motion starts 1 s after the horizontal component"):
        read_motion(along, vertical_path=written(tmp_path, "knet", "U-D", UP, **late))
    unclear = written(tmp_path, "knet", "U-D", UP, **{"Record Time": "noon"})
    for path in (unclear, written(tmp_path, "peer", "UP", UP)):
        assert read_motion(along, vertical_path=path).vertical is not None
    tables = [written(tmp_path, "columns", name, UP) for name in ("a", "b")]
    tables[1].write_text("\n".join(f"{5.0 + t:.2f} {a:.6f}" for t, a in zip(TIME, UP, strict=True)))
    with pytest.raises(RecordError, match="columns b: the motion starts 5 s after"):
        read_motion(tables[0], units="m/s2", vertical_path=tables[1])


def test_starts_of_seismic_files(tmp_path: Path) -> None:
    """miniSEED: a tenth of a step is rounding, a whole step is not; its zone is not compared with K-NET's."""
    obspy = pytest.importorskip("obspy")
    paths = []
    for name, shift in (("HNE", 0.0), ("HNZ", 0.002), ("HNN", 0.02)):
        header = {"network": "XX", "station": "AAA", "channel": name, "delta": 0.02, "starttime": 1e9 + shift}
        header["starttime"] = obspy.UTCDateTime(header["starttime"])
        paths.append(tmp_path / name)
        obspy.Stream([obspy.Trace(UP, header)]).write(str(paths[-1]), format="MSEED")
    assert read_motion(paths[0], units="m/s2", vertical_path=paths[1]).peak_vertical == pytest.approx(1.0)
    with pytest.raises(RecordError, match=r"starts 0\.02 s after"):
        read_motion(paths[0], units="m/s2", vertical_path=paths[2])


def test_the_second_file_is_named_in_errors(tmp_path: Path) -> None:
    """A vertical file that is missing or damaged is refused under its own name."""
    along = written(tmp_path, "peer", "90", ALONG)
    with pytest.raises(RecordError, match=r"up\.at2: no such file"):
        read_motion(along, vertical_path=tmp_path / "up.at2")
    broken = written(tmp_path, "peer", "UP", UP)
    broken.write_text(broken.read_text().replace("NPTS=", "NPTS=1"))
    with pytest.raises(RecordError, match="peer UP"):
        read_motion(along, vertical_path=broken)


def test_both_parts_can_be_written_to_one_file(tmp_path: Path) -> None:
    """Two files whose components have one name come back from one file as two components."""
    along = GroundMotion(ALONG, 0.02, metadata={"component": "acceleration"})
    both = with_vertical(along, GroundMotion(UP, 0.02, metadata={"component": "acceleration"}))
    path = tmp_path / "both.txt"
    write_motion(both, path, "columns")
    again = read_motion(path, component="acceleration", vertical="acceleration vertical")
    np.testing.assert_allclose(again.acceleration, ALONG, rtol=0.0, atol=1e-6)
    np.testing.assert_allclose(again.vertical, UP, rtol=0.0, atol=1e-6)
