"""The same bits on every processor: results under settings that stand for others, each in a process of its own.

The settings are those of `portable.py`. What has the same bits under all of them, and what has not, says
docs/theory/engines.md; this test fails where that says too much.
"""

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

pytestmark = [pytest.mark.slow, pytest.mark.verifies(room="campaigns")]

HERE = Path(__file__).parent


def _module(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    made = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(made)
    return made


SETTINGS = _module(HERE.parent / "portable.py").settings()
VARIABLES = {name for given in SETTINGS.values() for name in given}
# SciPy's solver takes scalar products of its stages
BLAS = {"bed, reference"}
OTHER = {
    # the plain kernels have no fused multiply-add; exp, log, powers and angles of processors that are older than 2013
    "least processor": {
        "space, polygon, reference", "space, round base, reference", "space, batch", "bed, fast", "plane, fast",
        "plane, reference", "plane, coefficients", "plane, contact", *BLAS,
    },
    **dict.fromkeys(("OpenBLAS of AVX-512", "OpenBLAS of AVX", "no AVX-512, Intel", "no AVX-512, AMD"), BLAS),
}  # fmt: skip
"""Results that may have other last digits, by the setting."""
QUICK = [
    "space, polygon, reference", "space, round base, reference", "space, batch", "plane, reference", "plane, fast",
    "plane, contact", "plane, coefficients", "motions, corrected", "space, impacts and moments", "bed, fast",
    "examples", "levels in equal ratios",
]  # fmt: skip
NAMES = QUICK if os.environ.get("ROCKING_CAMPAIGN") != "1" else []


def hashes(variables: dict[str, str]) -> dict[str, str]:
    command = [sys.executable, "-W", "ignore", str(HERE / "results_to_compare.py"), *NAMES]
    # these tests, too, run under a setting
    plain = {name: value for name, value in os.environ.items() if name not in VARIABLES}
    said = subprocess.run(command, env=plain | variables, capture_output=True, text=True, check=True).stdout
    return dict(json.loads(said))


@pytest.fixture(scope="module")
def here() -> dict[str, str]:
    return hashes({})


@pytest.mark.verifies(
    "same bits", "instructions and libraries of other processors", control="test_blas_would_be_noticed"
)
@pytest.mark.parametrize("setting", SETTINGS)
def test_results_have_the_same_bits(here: dict[str, str], setting: str) -> None:
    """Every result whose bits are claimed to be the same has them."""
    if not SETTINGS[setting]:
        pytest.skip("this processor cannot do as that one")
    found = hashes(SETTINGS[setting])
    print("".join(f"{name:32s}{'same' if found[name] == value else 'other'}\n" for name, value in here.items()))
    assert {name for name in here if found[name] != here[name]} <= OTHER.get(setting, set())


@pytest.mark.verifies("negative control", "a scalar product by BLAS")
def test_blas_would_be_noticed() -> None:
    """Negative control: a scalar product by BLAS has other bits under some setting, so that the hashes can differ."""
    program = (
        "import numpy as np; n = np.arange(1, 400) % 17 / 7.0;"
        "print(*[float(n[k:k + 40] @ n[k + 3:k + 43] ** 2).hex() for k in range(300)])"
    )
    said = {
        subprocess.run([sys.executable, "-c", program], env=os.environ | given, capture_output=True, check=True).stdout
        for given in SETTINGS.values()
    }
    assert np.size(list(said)) > 1
