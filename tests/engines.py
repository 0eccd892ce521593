"""The two plane engines, for tests that hold of both: ``from engines import built, every_engine``."""

import pytest

from rocking.dynamics.plane.fast_engine import available

built = pytest.mark.skipif(not available(), reason="the fast engine was not built")
ENGINES = [pytest.param("fast", marks=built), "reference"]
every_engine = pytest.mark.parametrize("name", ENGINES)
