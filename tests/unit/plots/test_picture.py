"""A picture shows itself in a notebook."""

import pickle

import pytest
from matplotlib.figure import Figure

import rocking as rk


@pytest.fixture(scope="module")
def picture():
    block = rk.Block(width=0.5, height=2.0)
    return rk.simulate(block, rk.pulses.sine(3.0, 0.8), restitution="ked").plot()


def size_of(png):
    """Width and height that the header of a PNG states (ISO/IEC 15948, 11.2.2)."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    return int.from_bytes(png[16:20]), int.from_bytes(png[20:24])


def test_a_notebook_is_given_an_image(picture):
    """IPython's own formatter makes a PNG of a picture; of a bare figure without pyplot it makes none."""
    formatters = pytest.importorskip("IPython.core.formatters")
    shown, how = formatters.DisplayFormatter().format(picture)
    assert list(shown) == ["text/plain", "image/png"]
    width, height = size_of(shown["image/png"])
    assert width / height == pytest.approx(how["image/png"]["width"] / how["image/png"]["height"], rel=0.01)
    assert how["image/png"]["width"] == pytest.approx(96.0 * picture.get_size_inches()[0], abs=0.5)
    assert list(formatters.DisplayFormatter().format(Figure())[0]) == ["text/plain"]


def test_a_picture_goes_through_pickle(picture):
    """Other processes may draw it: the copy is an image of the same size."""
    copy = pickle.loads(pickle.dumps(picture))
    assert size_of(copy._repr_png_()[0]) == size_of(picture._repr_png_()[0])
