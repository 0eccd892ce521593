"""What was asked in a unit is answered in it: on the terminal and on the axes of pictures."""

import pytest

from rocking.bodies.solid import box
from rocking.plots.labels import shown_in

pytest.importorskip("matplotlib")
SIZE = ("--width", "0.5", "--height", "2", "--density", "500")
PULSE = "sine:amplitude=3,period=0.8"


@pytest.fixture
def drawn(monkeypatch):
    """Every figure that a command writes."""
    figures = []
    monkeypatch.setattr("rocking.plots.write", lambda figure, path: figures.append(figure) or path)
    return figures


def numbers(axis):
    """Places of ticks within the view, and what is written at them."""
    low, high = sorted(axis.get_view_interval())
    axis.figure.canvas.draw()
    pairs = zip(axis.get_majorticklocs(), axis.get_majorticklabels(), strict=True)
    return {place: float(text.get_text()) for place, text in pairs if low <= place <= high and text.get_text()}


def test_map_in_g_and_degrees(printed, drawn, tmp_path):
    """A map over PGA in g and alpha in degrees has those units on its axes and in its sentences."""
    axes = ("--x", "pga=0.1g:1.5g:8", "--y", "slenderness_angle=5deg:20deg:6")
    out = printed("map", *SIZE, PULSE, *axes, "--output", str(tmp_path / "map.png"))
    assert "pga 0.1 to 1.5 g" in out
    assert "slenderness_angle 5 to 20 deg" in out
    assert "m/s2" not in out.replace("3 m/s2", "")
    assert "slenderness_angle 5 deg" in out
    (figure,) = drawn
    labels = figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    assert labels[0] == "peak ground acceleration [g]"
    assert labels[1].endswith("[deg]")
    for place, value in numbers(figure.axes[0].xaxis).items():
        assert place == pytest.approx(9.80665 * value, rel=1e-5)
        assert round(value * 20) == pytest.approx(value * 20, abs=1e-6)  # 0.05 g is as fine as it gets: round in g


@pytest.mark.slow
@pytest.mark.parametrize("analysis", ["stripes", "incremental"])
def test_fragility_in_g(printed, analysis, drawn, tmp_path):
    """Levels in g give medians in g, and axes in g."""
    motions = ("--synthetic", "pulse-like", "--count", "12", "--seed", "1", "--levels", "0.1g:1.5g:6")
    where = str(tmp_path / "curves.png")
    out = printed("fragility", *SIZE, *motions, "--analysis", analysis, "--output", where)
    assert "median [g]" in out
    (figure,) = drawn
    labels = [axes.get_xlabel() for axes in figure.axes] + [axes.get_ylabel() for axes in figure.axes]
    assert "peak ground acceleration [g]" in labels
    assert not any("m/s" in label for label in labels)


def test_without_a_unit_nothing_changes(printed, drawn, tmp_path):
    """Negative control: numbers without a unit are in m/s2, and so is the picture."""
    axes = ("--x", "pga=1:15:8", "--y", "slenderness_angle=0.1:0.3:6")
    out = printed("map", *SIZE, PULSE, *axes, "--output", str(tmp_path / "map.png"))
    assert "pga 1 to 15 m/s2" in out
    assert drawn[0].axes[0].get_xlabel() == "peak ground acceleration [m/s$^2$]"


def test_ticks_on_a_logarithmic_axis():
    """Ticks are round in the unit that is shown on a logarithmic axis too: powers of ten of g."""
    from matplotlib.figure import Figure

    axes = Figure().add_subplot()
    axes.plot([0.2, 300.0], [0.0, 1.0])
    axes.set_xscale("log")
    axes.set_xlabel("level [m/s$^2$]")
    shown_in(axes, "x", "g", 9.80665)
    assert axes.get_xlabel() == "level [g]"
    assert set(numbers(axes.xaxis).values()) >= {0.1, 1.0, 10.0}


def test_one_option_for_units(printed, tmp_path):
    """`--units mm,g` says the unit of the lengths and that of the record: as metres and m/s2 would be."""
    record = tmp_path / "record.txt"
    record.write_text("".join(f"{0.01 * k:.2f} {0.4 * ((k // 30) % 2) - 0.2:.3f}\n" for k in range(200)))
    same = printed("simulate", *SIZE, str(record), "--units", "g", "--json")
    sizes = ("--width", "500", "--height", "2000", "--density", "500")
    assert printed("simulate", *sizes, str(record), "--units", "mm,g", "--json") == same
    assert printed("simulate", *sizes, str(record), "--units", "G, MM", "--json") == same


@pytest.fixture
def record(tmp_path):
    """Half a second of a third of g, in a file that states no unit."""
    path = tmp_path / "third.txt"
    path.write_text("".join(f"{0.01 * k:.2f} {0.33 if k < 50 else 0.0}\n" for k in range(200)))
    return str(path)


IN_MM = ("--width", "500", "--height", "2000", "--density", "2000", "--units", "mm,g")
RADIUS = "slenderness angle 14.04 deg, R 1030.8 mm, p 2.6712 rad/s"  # R = sqrt(250^2 + 1000^2), p^2 = 3 g/(4 R)


@pytest.mark.parametrize(
    ("command", "more"),
    [
        ("simulate", ()),
        ("map", ("--x", "scale=1:2:3", "--y", "slenderness_angle=5deg:20deg:3")),
        ("overturning-pga", ("--samples", "12", "--bisections", "1")),
        ("fragility", ("--levels", "0.2g,0.4g")),
    ],
)
def test_block_in_mm_is_told_in_mm(printed, command, more, record):
    """A block and a record that are given in mm and g are described in mm and g, by every command alike."""
    out = printed(command, *IN_MM, "--motion", record, *more)
    assert (RADIUS if command == "fragility" else "Block 500 x 2000 mm") in out
    assert " m," not in out
    if command == "simulate":
        assert "third, 1.99 s, PGA 0.33 g" in out


def test_centre_of_a_block_in_mm(printed):
    """Half of 500 and of 2000 mm."""
    out = printed("restitution", *IN_MM[:-1], "mm")
    assert "centre of mass 250, 1000 mm" in out
    assert RADIUS in out


def test_slip_in_mm(printed, record):
    """What slides is told in the unit of lengths; the numbers are those in m, times a thousand."""
    options = ("--motion", record, "--friction", "0.2", "--details")
    metres = printed("simulate", "--width", "1", "--height", "1", "--units", "g", *options)
    millimetres = printed("simulate", "--width", "1000", "--height", "1000", "--units", "mm,g", *options)
    assert ("distance [m]" in metres, "distance [mm]" in millimetres) == (True, True)
    slid = [float(out.partition("Sliding distance")[2].split()[0]) for out in (metres, millimetres)]
    assert slid[1] == pytest.approx(1000.0 * slid[0], rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("command", ["restitution", "simulate"])
def test_mesh_in_mm_is_told_in_mm(printed, command, record, tmp_path):
    """A mesh of 500 x 600 x 2000 mm: its size, centre, base and edges in mm."""
    shape = box(500.0, 600.0, 2000.0)
    lines = [f"v {x} {y} {z}" for x, y, z in shape.vertices] + [f"f {a} {b} {c}" for a, b, c in shape.faces + 1]
    path = tmp_path / "box.obj"
    path.write_text("\n".join(lines))
    ground = (record, "--units", "mm,g") if command == "simulate" else ("--units", "mm")
    out = printed(command, str(path), *ground)
    assert "500 x 600 x 2000 mm" in out
    if command == "restitution":
        assert "centre of mass 0, 0, 1000 mm" in out
        assert "(-250, -300)" in out
    if command == "restitution":
        assert "R [mm]" in out
        assert "1030.8" in out  # sqrt(250^2 + 1000^2)


def test_accelerations_stand_in_the_unit_of_the_record_beside_g(printed, record):
    """A record in gal: its peak, its spectrum, and what lifts and overturns a block are in gal; one in g, in m/s2."""
    out = printed("record", "show", record, "--units", "gal")
    assert ("PSA [gal]" in out, "m/s2" in out) == (True, False)
    assert "0.33 gal (0.00033651 g)" in out
    assert "PSA [m/s2]" in printed("record", "show", record, "--units", "g")
    out = printed("overturning-pga", *IN_MM[:-1], "mm,gal", "--motion", record, "--samples", "12", "--bisections", "1")
    assert "from 245.166 gal (0.25 g)" in out  # g tan(alpha) = 980.665 / 4
    assert "m/s2" not in out
