"""What was asked in a unit is answered in it: on the terminal and on the axes of pictures."""

import pytest

from rocking.cli import main
from rocking.plots.study_words import shown_in

pytest.importorskip("matplotlib")
SIZE = ("--width", "0.5", "--height", "2", "--density", "500")
PULSE = "sine:amplitude=3,period=0.8"


@pytest.fixture
def drawn(monkeypatch):
    """Every figure that a command writes."""
    figures = []
    monkeypatch.setattr("rocking.plots.style.write", lambda figure, path: figures.append(figure) or path)
    return figures


def run(capsys, *words):
    with pytest.raises(SystemExit) as end:
        main(words)
    done = capsys.readouterr()
    assert end.value.code == 0, done.err
    return done.out


def numbers(axis):
    """Places of ticks within the view, and what is written at them."""
    low, high = sorted(axis.get_view_interval())
    axis.figure.canvas.draw()
    pairs = zip(axis.get_majorticklocs(), axis.get_majorticklabels(), strict=True)
    return {place: float(text.get_text()) for place, text in pairs if low <= place <= high and text.get_text()}


def test_map_in_g_and_degrees(drawn, capsys, tmp_path):
    """A map over PGA in g and alpha in degrees has those units on its axes and in its sentences."""
    axes = ("--x", "pga=0.1g:1.5g:8", "--y", "slenderness_angle=5deg:20deg:6")
    out = run(capsys, "map", *SIZE, PULSE, *axes, "--picture", str(tmp_path / "map.png"))
    assert "pga, 0.1 to 1.5 g" in out
    assert "slenderness_angle, 5 to 20 deg" in out
    assert "m/s2" not in out.replace("3 m/s2", "")
    assert "slenderness_angle = 5 deg" in out
    (figure,) = drawn
    labels = figure.axes[0].get_xlabel(), figure.axes[0].get_ylabel()
    assert labels[0] == "peak ground acceleration [g]"
    assert labels[1].endswith("[deg]")
    for place, value in numbers(figure.axes[0].xaxis).items():
        assert place == pytest.approx(9.80665 * value, rel=1e-5)
        assert round(value * 20) == pytest.approx(value * 20, abs=1e-6)  # 0.05 g is as fine as it gets: round in g


@pytest.mark.parametrize("analysis", ["stripes", "incremental"])
def test_fragility_in_g(analysis, drawn, capsys, tmp_path):
    """Levels in g give medians in g, and axes in g."""
    motions = ("--synthetic", "pulse-like", "--count", "12", "--seed", "1", "--levels", "0.1g:1.5g:6")
    where = str(tmp_path / "curves.png")
    out = run(capsys, "fragility", *SIZE, *motions, "--analysis", analysis, "--picture", where)
    assert "median [g]" in out
    (figure,) = drawn
    labels = [axes.get_xlabel() for axes in figure.axes] + [axes.get_ylabel() for axes in figure.axes]
    assert "peak ground acceleration [g]" in labels
    assert not any("m/s" in label for label in labels)


def test_without_a_unit_nothing_changes(drawn, capsys, tmp_path):
    """Negative control: numbers without a unit are in m/s2, and so is the picture."""
    axes = ("--x", "pga=1:15:8", "--y", "slenderness_angle=0.1:0.3:6")
    out = run(capsys, "map", *SIZE, PULSE, *axes, "--picture", str(tmp_path / "map.png"))
    assert "pga, 1 to 15 m/s2" in out
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


def test_one_option_for_units(capsys, tmp_path):
    """`--units mm,g` says the unit of the lengths and that of the record: as metres and m/s2 would be."""
    record = tmp_path / "record.txt"
    record.write_text("".join(f"{0.01 * k:.2f} {0.4 * ((k // 30) % 2) - 0.2:.3f}\n" for k in range(200)))
    same = run(capsys, "simulate", *SIZE, str(record), "--units", "g", "--json")
    sizes = ("--width", "500", "--height", "2000", "--density", "500")
    assert run(capsys, "simulate", *sizes, str(record), "--units", "mm,g", "--json") == same
    assert run(capsys, "simulate", *sizes, str(record), "--units", "G, MM", "--json") == same


@pytest.mark.parametrize(
    ("units", "said"),
    [
        ("mm,cm", "one unit of a kind, got mm and cm"),
        ("milimeter", "--units must be one of m, cm, mm"),
        ("", "--units"),
    ],
)
def test_units_that_are_none(units, said, capsys):
    """Two units of one kind, and what is no unit, are refused."""
    with pytest.raises(SystemExit) as end:
        main(("cor", "--width", "5", "--height", "20", "--units", units))
    assert end.value.code == 2
    assert said in capsys.readouterr().err
