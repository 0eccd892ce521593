"""K-NET and KiK-net: counts, a scale factor, and a mean that must go."""

import re
from collections.abc import Callable

import numpy as np
import pytest
from record_files import read_back, refused

from rocking.errors import RecordError
from rocking.motions.formats import Component, Record, Source, formats

pytestmark = pytest.mark.verifies(room="motions and records")

KNET = formats()["knet"]

# 2000 gal are 1000 counts: 2 gal a count. Mean of the counts 1010, so the accelerations are -20, 20, 60, -60 ... gal
COUNTS = [1000, 1020, 1040, 980, 1010, 1010, 1010, 1010, 1010, 1010]
TYPED = """\
Origin Time       1999/12/31 19:51:00
Lat.              41.0
Long.             142.5
Depth. (km)       30
Mag.              6.2
Station Code      ABC001
Station Lat.      41.5267
Station Long.     140.9244
Station Height(m) 39
Record Time       1999/12/31 19:51:43
Sampling Freq(Hz) 5Hz
Duration Time(s)  2
Dir.              N-S
Scale Factor      2000(gal)/1000
Max. Acc. (gal)   60.000
Last Correction   1999/12/31 19:51:43
Memo.
    1000     1020     1040      980     1010     1010     1010     1010
    1010     1010
"""


def read(text: str = TYPED, **options: object) -> Record:
    return KNET.read(Source("ABC001.NS", text.encode()), **options)  # type: ignore[arg-type]


@pytest.mark.verifies("closed form", "accelerations by hand", within="1e-10 gal", control="within")
def test_the_mean_of_the_whole_record_is_removed() -> None:
    """Accelerations by hand; with the mean the peak would be 2080 gal, 35 times too large."""
    record = read()
    (part,) = record.components
    np.testing.assert_allclose(part.acceleration, [-20, 20, 60, -60, 0, 0, 0, 0, 0, 0], rtol=0.0, atol=1e-10)
    assert (part.name, part.unit, part.time_step, part.stated_peak) == ("N-S", "gal", 0.2, 60.0)
    assert record.metadata["processing"] == "mean of the whole record removed"
    assert record.metadata["mean removed"] == "2020 gal"
    assert record.metadata["Station Code"] == "ABC001"
    assert 2.0 * max(COUNTS) > 34.0 * part.peak


DAMAGES = [
    ("60.000", "60.010", "largest acceleration"),
    ("60.000", "2080.000", "largest acceleration"),
    ("2000(gal)/1000", "2000(gal)/1001", "largest acceleration"),
    ("2000(gal)/1000", "0(gal)/1000", "scale factor"),
    ("2000(gal)/1000", "2000/1000", "understood"),
    ("5Hz", "50Hz", "states 100 samples, but the file contains 10"),
    ("5Hz", "0Hz", "time step"),
    ("5Hz", "5", "Sampling Freq"),
    ("(s)  2", "(s)  999999999", "whole number of samples"),
    ("(s)  2", "(s)  2.1", "whole number of samples"),
    ("1040", "104O", "line 18"),
    ("1040", "10 40", "line 18: 8 counts expected, found 9"),
    ("1010\n    1010     1010\n", "1010\n    1010     1010\n     7\n", "line 19: 8 counts expected, found 2"),
    ("Mag.              6.2\n", "", "line 5: 'Mag.' expected"),
]


def test_damage_is_refused() -> None:
    """Peak, scale, rate, duration, counts and the order of the header are checked; damage names its line."""
    refused(KNET, TYPED, DAMAGES)


def test_units_that_contradict_are_refused() -> None:
    """It is gal, which is cm/s2, and nothing else."""
    assert read(units="cm/s2").components[0].unit == "gal"
    with pytest.raises(RecordError, match=r"states (the|a) .*, not "):
        read(units="g")


def test_recognition() -> None:
    """Three of four words at the top suffice, so a file that lost a line is not taken for a plain table."""
    reader = KNET
    assert reader.recognises(Source("a", TYPED.encode()))
    assert reader.recognises(Source("a", TYPED.replace("Scale Factor", "Scale").encode()))
    assert not reader.recognises(Source("a", "\n".join(map(str, COUNTS)).encode()))


def test_what_is_written_is_read_back(made_up: Callable[..., Record]) -> None:
    """A record without mean comes back to the count of a 24-bit recorder."""
    time = np.arange(200) * 0.01
    given = Component("E-W", 321.0 * np.sin(2.0 * np.pi * time), "gal", 0.01)
    read_back(KNET, Record("", (given,)), 1.0, atol=321.0 * 2.0**-22)
    # a mean would be lost, and parts of seconds cannot be stated
    with pytest.raises(RecordError, match="mean"):
        KNET.write(Record("", (Component("a", np.array([1.0, 1.0, 1.0, 0.0]), "gal", 0.5),)))
    with pytest.raises(RecordError, match="whole seconds"):
        KNET.write(made_up("a"))
    with pytest.raises(RecordError, match="check the unit"):
        KNET.write(Record("", (Component("a", np.array([1e9, -1e9]), "gal", 0.5),)))


@pytest.mark.parametrize(("number", "side"), [("6", "up"), ("5", 90.0), ("7", "unclear"), ("0", "unclear")])
def test_a_number_that_is_no_direction_is_unclear(number: str, side: object) -> None:
    """Numbers are the directions 1 to 6 of KiK-net, and no azimuths."""
    text = re.sub(r"(?m)^(Dir\.\s+)\S+", rf"\g<1>{number}", TYPED)
    assert read(text).components[0].direction == side
