"""A response draws, moves and reports itself: `plot`, `animate`, `report`."""

import sys

import pytest

import rocking as rk
from rocking.errors import RockingError

pytestmark = pytest.mark.slow

pytest.importorskip("matplotlib")

STATUE = rk.Section([rk.Region([(-0.45, 0.0), (0.55, 0.0), (0.4, 2.5), (-0.15, 2.2)], density=2400.0)])
PULSE = rk.pulses.sine(amplitude=5.0, period=0.8)
BOX = rk.dynamics.SpatialBody.box(0.5, 0.4, 2.0)
ASKED = {
    "rocking": lambda: rk.simulate(STATUE, PULSE, "housner", scale=1.1),
    "contact": lambda: rk.simulate(STATUE, PULSE, friction=0.4),
    "space": lambda: rk.simulate(BOX, {"x": PULSE, "y": PULSE.scaled(0.3)}, "housner"),
}


@pytest.mark.parametrize("mechanics", ASKED)
def test_every_response_draws_itself(mechanics, tmp_path):
    """The picture is that of `rocking.plots` for these mechanics, and written if a path is given."""
    figure = ASKED[mechanics]().plot(tmp_path / "picture.svg")
    labels = " ".join(axes.get_ylabel() for axes in figure.axes)
    assert {"rocking": "angular", "contact": "centre", "space": "tilt"}[mechanics] in labels
    assert (tmp_path / "picture.svg").read_text(encoding="utf-8").startswith("<?xml")


def test_report(tmp_path):
    """HTML and PDF say what it is, what it did, under which friction, and nothing of files that there are none of."""
    pytest.importorskip("jinja2")
    pytest.importorskip("typst")
    response = ASKED["rocking"]()
    html = response.report(tmp_path / "r.html", name="Statue <1>", date="2026-11-24").read_text(encoding="utf-8")
    summary = response.summary[:1].upper() + response.summary[1:]
    for words in ("Statue &lt;1&gt;", "2026-11-24", summary, "scaled by 1.1", "0.5, assumed", "left foot"):
        assert words in html
    assert "response.toml" not in html
    assert "0.4, given" in response.report(tmp_path / "s.html", friction=0.4).read_text(encoding="utf-8")
    assert response.report(tmp_path / "r.pdf").read_bytes().startswith(b"%PDF")


def test_report_of_free_rocking(tmp_path):
    """The ground stays at rest: no picture of a motion."""
    pytest.importorskip("jinja2")
    html = rk.free_rocking(STATUE, 0.1, 0.9).report(tmp_path / "free.html").read_text(encoding="utf-8")
    assert "the ground is at rest" in html
    assert html.count("<figure>") == 3


WALL = rk.Restrained(
    rk.Block(width=1.0, height=5.0, mass=2000.0, centre=(0.35, 2.0), moment_of_inertia=3000.0),
    [
        rk.Tendon(x=0.5, stiffness=2e5, prestress=6e3, name="cable", rupture_elongation=0.05),
        rk.Fuse(x=0.1, length=0.5, stiffness=2e6, yield_force=2e3, hardening=0.02, name="fuse <1>"),
    ],
)


def test_report_of_a_body_with_restraints(tmp_path):
    """The report states the damage, force laws, forces and uplift accelerations of an asymmetric body."""
    pytest.importorskip("jinja2")
    pytest.importorskip("typst")
    response = rk.simulate(WALL, PULSE, "housner")
    assert response.report(tmp_path / "wall.pdf", name="Wall").read_bytes().startswith(b"%PDF")
    html = response.report(tmp_path / "wall.html", name="Wall", date="").read_text(encoding="utf-8")
    rows = dict(zip(*map(response.restraints.columns.get, ("restraint", "largest_force")), strict=True))
    right, left = 9.80665 * 0.65 / 2.0, 9.80665 * 0.35 / 2.0  # the moment of the prestress about a foot adds to these
    for words in (
        "Yielded:", "fuse &lt;1&gt;", "stiffness 2000000, yield_force 2000", f"{rows['cable']:.4g}",
        "yields in tension",
        f"{right + 6e3 * 0.5 / (2000 * 2.0):.4g} m/s2 about the right foot",
        f"{left + 6e3 * 0.5 / (2000 * 2.0):.4g} m/s2 about the left foot",
    ):  # fmt: skip
        assert words in html
    assert html.count("<figure>") == 5
    assert "Broken:" not in html
    assert "Broken:</strong> cable" in (
        rk.simulate(WALL, PULSE, "housner", scale=1.4).report(tmp_path / "b.html").read_text(encoding="utf-8")
    )


def test_report_of_a_response_with_friction_is_refused(tmp_path):
    with pytest.raises(RockingError, match="RestrainedResponse"):
        ASKED["contact"]().report(tmp_path / "x.pdf")


@pytest.mark.parametrize("way", ["plot", "animate", "report"])
@pytest.mark.parametrize("name", ["x.txt", "x"])
def test_other_endings_are_refused(way, name, tmp_path):
    with pytest.raises(RockingError, match=rf"'{name}'"):
        getattr(ASKED["rocking"](), way)(tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_a_history_without_a_result_has_no_report(tmp_path):
    with pytest.raises(RockingError, match="no result to report"):
        rk.simulate(STATUE, PULSE, 0.9, most_events=1).report(tmp_path / "x.html")
    with pytest.raises(RockingError, match="nowhere"):
        ASKED["rocking"]().report(tmp_path / "nowhere" / "x.html")
    with pytest.raises(RockingError, match="fps can be used with films"):
        ASKED["rocking"]().animate(tmp_path / "x.html", fps=10)


def test_what_needs_a_package_says_so_before_it_computes(monkeypatch):
    """Without xarray no history is computed in vain."""
    done: list[int] = []
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(rk.errors.MissingExtraError):
        rk.simulate_many(STATUE, PULSE, "ked", progress=done.append)
    axes = ("scale", [1.0, 2.0]), ("restitution", [0.8, 0.9])
    with pytest.raises(rk.errors.MissingExtraError):
        rk.overturning_map(STATUE, PULSE, *axes, progress=done.append)
    assert done == []


def test_what_has_no_report_is_refused(tmp_path):
    with pytest.raises(RockingError, match=r"result must be one of Response, .*got 3"):
        rk.reports.report(3, tmp_path / "x.html")


def test_an_option_that_there_is_not_is_named(tmp_path):
    """A slip is refused with what the report takes, and nothing is written."""
    words = r"option .frictoin. of a report of Response; allowed: name, date, friction; did you mean .friction."
    with pytest.raises(RockingError, match=words):
        rk.reports.report(ASKED["rocking"](), tmp_path / "x.html", frictoin=0.4)
    assert not list(tmp_path.iterdir())
