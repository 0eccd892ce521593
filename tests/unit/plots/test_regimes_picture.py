"""Pictures of regimes: cells against boundaries, bands where the regimes are, curves that are the response."""

import numpy as np
import pytest

import rocking as rk
from rocking.bodies import Block
from rocking.dynamics.contact import Regime, friction_demand
from rocking.errors import InvalidValueError
from rocking.motions.pulses import sine
from rocking.plots.regimes import regime_map_picture, regimes_picture
from rocking.plots.style import write

SLENDER = Block(width=1.0, height=4.0).with_feet(0.1, 1)


def test_map_shows_four_regimes_and_the_closed_form():
    """Cells of an image hold regimes by complementarity; the curve is friction_demand, 1 % off is told apart."""
    (axes,) = regime_map_picture(SLENDER, cells=20).axes
    (image,) = axes.images
    codes = np.asarray(image.get_array())
    assert set(codes.ravel()) == {r.code for r in (Regime.REST, Regime.SLIDE, Regime.ROCK, Regime.SLIDE_ROCK)}
    x, y = axes.lines[-1].get_data()
    assert y[100] == pytest.approx(friction_demand(SLENDER, x[100]), rel=1e-12)
    assert y[100] != pytest.approx(0.99 * friction_demand(SLENDER, x[100]), rel=1e-3)
    # cells just above the curve rock, those just below slide and rock
    column = 15
    push = (column + 0.5) * 1.5 / 20
    row = int(friction_demand(SLENDER, push) / 1.5 * 20)
    assert codes[row + 1, column] == Regime.ROCK.code
    assert codes[row - 1, column] == Regime.SLIDE_ROCK.code


@pytest.mark.parametrize(
    ("options", "words"), [({"cells": 1}, "cells must be"), ({"largest": 0.2}, "largest must be above")]
)
def test_map_refuses_what_it_cannot_draw(options, words):
    """Too few cells, or no room for rocking."""
    with pytest.raises(InvalidValueError, match=words):
        regime_map_picture(SLENDER, **options)


def test_response_is_drawn_over_its_regimes(tmp_path):
    """The curves are the samples, the bands cover the time axis once, and the file is the same twice."""
    response = rk.simulate(Block(width=1.2, height=2.0), sine(amplitude=9.0, period=0.9), None, friction=0.62)
    figure = regimes_picture(response)
    time, rotation = max((line.get_data() for line in figure.axes[0].lines), key=lambda pair: len(pair[0]))
    assert np.array_equal(time, response.time)
    assert np.allclose(rotation, np.degrees(response.rotation))
    spans = [path.vertices[:, 0] for c in figure.axes[1].collections for path in c.get_paths()]
    assert sum(np.ptp(x) for x in spans) == pytest.approx(response.history.end, rel=1e-9)
    files = [write(regimes_picture(response), tmp_path / f"{k}.svg").read_bytes() for k in range(2)]
    assert files[0] == files[1]
