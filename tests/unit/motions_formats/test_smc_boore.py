"""SMC of Boore's programs: 5 columns of 14 characters."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rocking.conventions import g
from rocking.errors import RecordError
from rocking.motions.formats import Record, Source
from rocking.motions.formats.smc import SmcBoore, SmcUsgs


def typed(first: str = "0 UNKNOWN") -> str:
    """A file typed by hand: 6 samples, the largest 1.25 at 0.02 s, the least -2.5 at 0.05 s."""
    whole = ["    -32768"] * 48
    whole[15], whole[16], whole[46] = "         1", "         6", "         8"
    real = ["  0.1700000E+39"] * 50
    real[1] = "  0.1000000E+03"
    real[28:32] = ["  0.2000000E-01", "  0.1250000E+01", "  0.5000000E-01", " -0.2500000E+01"]
    lines = [first] + ["*"] * 5 + ["*                                pk mtn =-2.500E+0"] + ["*"] * 4
    lines += ["".join(whole[k : k + 8]) for k in range(0, 48, 8)] + ["".join(real[k : k + 5]) for k in range(0, 50, 5)]
    lines += ["|", " 0.0000000E+00 1.0000000E+00 1.2500000E+00-1.0000000E-01 0.0000000E+00", "-2.5000000E+00"]
    return "\n".join(lines) + "\n"


def test_a_typed_file_is_read() -> None:
    """Samples, step and peak; the kind UNKNOWN is kept in the metadata."""
    source = Source("typed", typed().encode())
    assert SmcBoore().recognises(source)
    assert not SmcUsgs().recognises(source)
    record = SmcBoore().read(source)
    (part,) = record.components
    assert part.acceleration.tolist() == [0.0, 1.0, 1.25, -0.1, 0.0, -2.5]
    assert (part.time_step, part.stated_peak, part.unit) == (0.01, 2.5, "cm/s2")
    assert record.metadata["kind"] == "unknown"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("pk mtn =-2.500E+0", "pk mtn =-2.600E+0", "pk"),
        ("0 UNKNOWN", "4 DISPLACEMENT", "displacement"),
        (" -0.2500000E+01", " -0.2500010E+01", "minimum"),
        ("-2.5000000E+00\n", "-2.5000000E+00\n 1.0000000E+00\n", "more"),
        ("-2.5000000E+00\n", "", "1 columns of 14 characters expected"),
    ],
)
def test_damage_is_refused(old: str, new: str, message: str) -> None:
    """The text peak, the extremes to seven digits, the kind and the end of the file are checked."""
    changed = typed().replace(old, new, 1)
    assert changed != typed()
    with pytest.raises(RecordError, match=message):
        SmcBoore().read(Source("typed", changed.encode()))


def test_the_real_file(shared_records: Path) -> None:
    """1987 Whittier, Carson-Catskill: 1646 samples at 0.02 s, 0.0421708 g as in the database it was made from."""
    (part,) = SmcBoore().read(Source.of_path(shared_records / "smc" / "A-CAT090.AT2.smc")).components
    assert (part.acceleration.size, part.time_step) == (1646, 0.02)
    assert 0.01 * part.peak / g == pytest.approx(0.0421708, abs=6e-8)


def test_what_is_written_is_read_back(made_up: Callable[..., Record]) -> None:
    """Eight digits survive."""
    record = made_up("17", unit="cm/s2", scale=123.0)
    (part,) = SmcBoore().read(Source("written", SmcBoore().write(record))).components
    np.testing.assert_allclose(part.acceleration, record.components[0].acceleration, rtol=5.1e-8, atol=1e-9)
    assert part.name == "17"
