"""What made a result: version, platform, libraries, data."""

import hashlib
import platform
from importlib.resources import files

import numpy as np


def made_with() -> dict[str, str]:
    """Return versions and the fingerprints of the data."""
    import scipy

    from rocking.evidence.measurements import provenance

    facts = provenance()
    data = files("rocking.evidence").joinpath("data")
    prints = [
        f"{name} {hashlib.sha256(data.joinpath(name).read_bytes()).hexdigest()[:12]}"
        for name in (f"mao2024_table{i}.csv" for i in (1, 2, 3))
    ]
    return {
        "Made with": f"rocking {_version()}, Python {platform.python_version()}, numpy {np.__version__}, "
        f"scipy {scipy.__version__}",
        "Measurements": f"{facts['source']}, doi:{facts['doi']}, {facts['licence']}",
        "SHA-256": ", ".join(prints),
    }


def _version() -> str:
    from importlib.metadata import version

    return version("rocking")
