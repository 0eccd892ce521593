"""Pictures: what is drawn is what was given, labelled with units, the same bytes every time."""

import xml.etree.ElementTree as ET

import numpy as np
import pytest

from rocking import Block, MassPoints, Section
from rocking.errors import RockingError
from rocking.evidence import coefficient_table, datasets
from rocking.plots import body_picture, coefficient_picture, energy_stages_picture, paper_figure, write
from rocking.plots.paper_figures import paper_figures
from rocking.restitution import Ked, energy_balance


@pytest.mark.parametrize("name", paper_figures())
def test_every_axis_is_labelled_with_its_unit(name):
    """Each visible axis of each figure of the report has a label that ends in a unit."""
    figure = paper_figures()[name]()
    for axes in figure.axes:
        for label, axis in ((axes.get_xlabel(), axes.xaxis), (axes.get_ylabel(), axes.yaxis)):
            if axes.axison and axis.get_visible() and label:
                assert label.rstrip().endswith("]")
    shown = [axes for axes in figure.axes if axes.axison]
    assert all(axes.get_xlabel() or axes.get_ylabel() for axes in shown)


def test_figure_3_draws_the_data():
    """Points of Figure 3 are those of Table 2, and the error bars are |r_r - r_e|, as in the paper."""
    data = datasets()["table2"]
    container = paper_figure("figure_3").axes[0].containers[0]
    x, y = container[0].get_data()
    assert (np.asarray(x) == data.slenderness).all()
    assert (np.asarray(y) == data.coefficient).all()
    segments = np.array(container[2][0].get_segments())
    reach = np.abs(Ked().of_slenderness(data.slenderness) - data.coefficient)
    assert 0.5 * np.ptp(segments[:, :, 1], axis=1) == pytest.approx(reach)
    assert 0.5 * np.ptp(segments[:, :, 1], axis=1) != pytest.approx(0.9 * reach)


def test_figure_7_and_8_hold_every_block():
    """All 27 blocks appear once per model, none beyond the axes."""
    for figure, count in ((paper_figure("figure_7"), 9), (paper_figure("figure_8"), 9)):
        for axes in figure.axes:
            low, high = axes.get_ylim()
            for line in axes.lines:
                y = np.asarray(line.get_ydata(), dtype=float)
                if y.size == count:
                    assert ((y >= low) & (y <= high)).all()


def test_figure_2_prints_the_shares():
    """Titles of Figure 2 give the shares of the balance; landing on the other foot of a block gives the same."""
    block = Block(width=1.0, height=2.0)
    for onto in ("left", "right"):
        titles = [axes.get_title() for axes in energy_stages_picture(block, onto=onto).axes[:4]]
        for title, share in zip(titles, energy_balance(block, onto=onto).shares.values(), strict=True):
            assert f"{100.0 * share:.1f} %" in title
    assert "80.0 %" in titles[1]  # cos^2 alpha at h/b = 2


@pytest.mark.parametrize(
    "body",
    [
        Block(width=0.001, height=0.004),
        Block(width=25.0, height=100.0),
        Section.from_points([(1e6, 0.0), (1e6 + 1.0, 0.0), (1e6 + 0.8, 3.0)]),
        Section.from_trapezoid(1.0, 0.5, 2.0, holes=[[(0.4, 0.5), (0.6, 0.5), (0.5, 1.0)]]),
        MassPoints([(0.0, 2.0), (0.3, 1.0)], [1.0, 2.0], feet=(-1.0, 1.0)),
    ],
    ids=["1 mm", "100 m", "far away", "hole", "mass points"],
)
def test_bodies_of_any_kind_are_drawn(body, tmp_path):
    """Small, large, far, hollow and lumped bodies are drawn inside their axes, to files."""
    figure = body_picture(body)
    low, high = figure.axes[0].get_xlim()
    assert low < body.feet[0] < body.feet[1] < high
    assert write(figure, tmp_path / "body.png").stat().st_size > 5000
    table = coefficient_picture(body, {"left": coefficient_table(body, onto="left")})
    assert write(table, tmp_path / "table.pdf").read_bytes().startswith(b"%PDF")


def drawn_at(axes, rows, marker):
    """Places of the markers of one kind whose height is a coefficient of these rows."""
    values = [row.coefficient for row in rows]
    lines = [line for line in axes.lines if line.get_marker() == marker and len(line.get_xdata()) == 1]
    return [x for line in lines for x, y in zip(line.get_xdata(), line.get_ydata(), strict=True) if y in values]


def test_each_foot_at_its_own_slenderness():
    """Coefficients onto a foot stand over h/b of that foot, 3 and 1.5 for this triangle, and say which foot it is."""
    body = Section.from_points([(0.0, 0.0), (1.0, 0.0), (0.0, 3.0)])
    tables = {foot: coefficient_table(body, onto=foot) for foot in ("left", "right")}
    figure = coefficient_picture(body, tables)
    left, right = (drawn_at(figure.axes[2], tables[f], m) for f, m in (("left", "<"), ("right", ">")))
    assert left == pytest.approx([3.0] * len(tables["left"]))
    assert right == pytest.approx([1.5] * len(tables["right"]))
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert all(word in " ".join(titles[1:]) for word in ("left foot", "right foot"))
    alone = coefficient_picture(body, {"right": tables["right"]})
    assert drawn_at(alone.axes[2], tables["right"], "D") == pytest.approx([1.5] * len(tables["right"]))
    assert "onto the right foot" in alone.axes[1].get_title(loc="left")


def test_files_come_out_the_same(tmp_path):
    """Two savings give identical bytes; the SVG is XML and refers to nothing outside."""
    for kind in ("png", "svg", "pdf"):
        pair = [write(paper_figure("figure_3"), tmp_path / f"{k}.{kind}").read_bytes() for k in (0, 1)]
        assert pair[0] == pair[1]
    root = ET.parse(tmp_path / "0.svg").getroot()
    links = [value for each in root.iter() for key, value in each.attrib.items() if key.endswith("href")]
    assert all(link.startswith("#") for link in links)


def test_formats_that_are_none(tmp_path):
    """Another suffix, or a folder that does not exist, is refused in our own words."""
    with pytest.raises(RockingError, match=r"\.png, \.svg or \.pdf"):
        write(paper_figure("figure_3"), tmp_path / "figure.bmp")
    with pytest.raises(RockingError, match="cannot write"):
        write(paper_figure("figure_3"), tmp_path / "missing" / "figure.png")


def test_hero():
    """The README's picture builds."""
    assert len(paper_figure("hero").axes) == 5
