"""`--motion x=FILE --motion z=FILE` and `rocking record show x=FILE z=FILE`: a vertical component in its own file."""

import numpy as np
import pytest

import rocking as rk
from rocking.motions.formats import Component, Record, write_record

SIZE = ("--width", "0.5", "--height", "2")
TIME = np.arange(100) * 0.02
ALONG, UP = 3.2 * np.sin(2.5 * np.pi * TIME), 2.0 * np.cos(4.0 * np.pi * TIME)


@pytest.fixture
def files(tmp_path):
    """A PEER file of the horizontal component and one of the vertical."""
    paths = []
    for name, values in (("90", ALONG), ("UP", UP)):
        paths.append(tmp_path / f"{name}.at2")
        metadata = {"event": "Somewhere", "station": "Cellar"}
        write_record(Record("peer", (Component(name, values, "m/s2", 0.02),), metadata=metadata), paths[-1], "peer")
    return paths


def test_both_files_reach_the_engine(answered, files):
    """The response is that of Python with both files, to the last digit, and not the one without the second."""
    along, up = files
    motion = rk.read_motion(along, vertical_path=up)
    expected = rk.simulate(rk.Block(width=0.5, height=2.0), motion)
    assert answered("simulate", *SIZE, along, "--motion", f"z={up}")["peak_rotation"] == (expected.peak_rotation)
    assert answered("simulate", *SIZE, along)["peak_rotation"] != expected.peak_rotation


def test_motion_tells_both(run, answered, files, tmp_path):
    """`rocking record show` tells the peak and the name of the vertical part, both files, and writes its samples."""
    along, up = files
    answer = answered("record", "show", along, f"z={up}", "--output", tmp_path / "out.csv")
    assert answer["intensity"]["pga"] == pytest.approx(np.abs(ALONG).max(), rel=1e-6)
    assert answer["peak_vertical_acceleration"] == pytest.approx(2.0, rel=1e-6)
    assert answer["vertical_component"] == "UP"
    assert [name in line for name, line in zip(("90.at2", "UP.at2"), answer["provenance"], strict=True)] == [True] * 2
    assert "vertical_acceleration [m/s2]" in (tmp_path / "out.csv").read_text(encoding="utf-8")
    assert "Peak vertical acceleration" in run("record", "show", along, f"z={up}")[1]
    assert answered("record", "show", along)["peak_vertical_acceleration"] is None


def test_a_file_of_several_components(refuses, answered, files, tmp_path):
    """Components of one file or of two are chosen apart, by their names after the files."""
    table = tmp_path / "table.txt"
    table.write_text("\n".join(f"{t:.2f} {a:.7f} {b:.7f}" for t, a, b in zip(TIME, ALONG, UP, strict=True)))
    units = ("--units", "m/s2")
    both = answered("record", "show", f"{table}#column 2", f"z={table}#column 3", *units)
    assert both["peak_vertical_acceleration"] == pytest.approx(2.0, rel=1e-6)
    refuses(("record", "show", table, f"z={table}#column 3", *units), f"use '{table}#column 2'")
    components = "the file has the components column 2, column 3; "
    refuses(
        ("record", "show", f"{table}#column 2", f"z={table}", *units),
        f"{components}use '{table}#column 2' or",
    )
