"""The picture of falls by direction: what its lines and cells show, and what it refuses."""

import numpy as np
import pytest

import rocking as rk
from rocking.dynamics.space import SpatialBody, fast_engine
from rocking.errors import InvalidValueError
from rocking.plots.falling import falling_picture

pytestmark = pytest.mark.skipif(not fast_engine.available(), reason="the batch engine was not built")

BOX = SpatialBody.box(0.5, 0.4, 2.0)
PULSE = rk.pulses.sine(amplitude=4.0, period=0.8)
ANGLES = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
MOTIONS = [(PULSE.scaled(np.cos(a)), PULSE.scaled(np.sin(a))) for a in ANGLES]


def test_lines_show_the_share_of_scales():
    """The two lines of the first panel are the shares of overturning in percent, closed round; a control is not."""
    batch = rk.simulate_many(BOX, MOTIONS, ["housner-3d", 0.95], scale=np.linspace(0.5, 3.0, 9))
    figure = falling_picture(batch, ANGLES, [(0.25, 0.2), (-0.25, 0.2), (-0.25, -0.2), (0.25, -0.2)])
    share = 100.0 * batch["overturned"].mean("scale").values[0, :, :, 0]
    assert 0.0 < share.mean() < 100.0
    for k, line in enumerate(figure.axes[0].lines):
        drawn = np.asarray(line.get_ydata())
        np.testing.assert_allclose(drawn, np.append(share[:, k], share[0, k]))
        assert np.abs(drawn[:-1] - np.roll(share[:, k], 1)).max() > 0.0  # negative control
    assert figure.axes[0].get_legend().get_texts()[1].get_text() == "r = 0.95"


def test_a_batch_of_another_shape_is_refused():
    """One restitution, or fewer azimuths than motions: an error that shows the shape."""
    with pytest.raises(InvalidValueError, match="two restitutions"):
        falling_picture(rk.simulate_many(BOX, MOTIONS), ANGLES)
    two = rk.simulate_many(BOX, MOTIONS, ["housner-3d", 0.9])
    with pytest.raises(InvalidValueError, match="each of 5"):
        falling_picture(two, ANGLES[:5])
