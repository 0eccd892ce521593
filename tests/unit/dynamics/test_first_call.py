"""The first response of a process: it loads what it needs and nothing else, so that it is nearly as quick as later."""

import subprocess
import sys

import pytest

from rocking.dynamics.plane import fast_engine

NOT_NEEDED = {
    "csv", "json", "scipy", "shapely", "pydantic", "pandas", "xarray", "matplotlib", "rocking.evidence",
    "rocking.dynamics.plane.reference", "rocking.dynamics.plane.batch", "rocking.dynamics.plane.energy_balance",
    "rocking.tables",
    "rocking.restitution.plastic_winkler", "rocking.restitution.ked_stages",
}  # fmt: skip
SCRIPT = """
import sys
before = set(sys.modules)
import rocking as rk
response = rk.simulate(rk.Block(width=0.5, height=2.0), rk.pulses.sine(amplitude=3.0, period=0.6), "housner")
{more}
print(*set(sys.modules) - before)
"""


def loaded(more: str = "") -> set[str]:
    """Modules that a response adds to a fresh interpreter."""
    code = SCRIPT.format(more=more)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(done.stdout.split())


@pytest.mark.skipif(not fast_engine.available(), reason="the fast engine was not built")
def test_the_first_response_loads_what_it_needs() -> None:
    """A response of the fast engine loads no files, tables, other models or engines; asked for, these are loaded."""
    found = loaded()
    assert {"rocking.dynamics._engine", "rocking.restitution.housner"} <= found
    assert not found & NOT_NEEDED
    assert "rocking.dynamics.plane.energy_balance" in loaded("response.contact")
