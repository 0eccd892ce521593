"""Taiwan's free-field records: a header of # lines and four columns."""

import numpy as np
import pytest
from record_files import read_back, refused

from rocking.errors import RecordError
from rocking.motions.formats import Component, Record, Source, formats

CWA = formats()["cwa"]

TYPED = """\
#Earthquake Information
#Origin Time(GMT+08): 1999/12/31-23:50:42
#Magnitude(Ml): 6.0

#Station Information
#StationCode: ABC
#RecordLength(sec): 0.8
#SampleRate(Hz): 5
#AmplitudeUnit:  gal. DCoffset(corr)
#AmplitudeMAX. U:    0.658~   -0.837
#AmplitudeMAX. N:    1.256~   -2.273
#AmplitudeMAX. E: 1000.017~-1000.778
#DataSequence: Time U(+); N(+); E(+)
#Data: 4F10.3
     0.000     0.000     0.000  1000.017
     0.200     0.658    -2.273 -1000.778
     0.400    -0.837     1.256     0.000
     0.600     0.100     0.200     0.300
"""


def read(text: str = TYPED) -> Record:
    return CWA.read(Source("1-ABC.dat", text.replace("\n", "\r\n").encode()))


def test_three_components_are_read() -> None:
    """Samples, order, unit, step and stated peaks of a typed file."""
    record = read()
    assert [part.name for part in record.components] == ["U", "N", "E"]
    assert [part.stated_peak for part in record.components] == [0.837, 2.273, 1000.778]
    assert record.components[1].acceleration.tolist() == [0.0, -2.273, 1.256, 0.2]
    assert {(part.unit, part.time_step) for part in record.components} == {("gal", 0.2)}
    assert record.metadata["StationCode"] == "ABC"


DAMAGES = [
    ("   -0.837\n", "   -0.839\n", "minimum U"),
    ("1.256~", "1.258~", "maximum N"),
    ("-1000.778\n#", " 1000.778\n#", "E"),
    ("(sec): 0.8", "(sec): 1.0", "states 5 samples, but the file contains 4"),
    ("(sec): 0.8", "(sec): 99999999", "states 499999995 samples"),
    ("(sec): 0.8", "(sec): 0.75", "whole number"),
    ("(Hz): 5", "(Hz): 0", "time step"),
    ("gal. DC", "g. DC", "unit gal"),
    ("N(+)", "N(-)", "DataSequence"),
    ("4F10.3", "4F10.4", "4F10.3"),
    ("     0.400", "     0.450", "line 17"),
    ("     0.200     0.658", "     0.200     0.65x", "line 16"),
    ("#AmplitudeMAX. N:    1.256~   -2.273\n", "", "are missing"),
    ("#AmplitudeMAX. N", "#AmplitudeMAX. U", "one component expected"),
    ("#StationCode: ABC", "#SampleRate(Hz): 5", "twice"),
    ("0.300\n", "0.300\n     0.800     0.000     0.000     0.000\n", "states 4 samples, but the file contains 5"),
]


def test_damage_is_refused() -> None:
    """Both extremes of each component, count, rate, unit, signs, times and columns are checked."""
    refused(CWA, TYPED, DAMAGES)


def test_what_is_written_is_read_back() -> None:
    """Components in another order and unit come back as U, N, E to 0.0005 gal; others, and six digits, are refused."""
    rows = {name: np.sin(np.arange(50.0) + k) for k, name in enumerate("ENU")}
    given = Record("", tuple(Component(name, row, "m/s2", 0.02) for name, row in rows.items()))
    assert [part.name for part in read_back(CWA, given, 100.0, atol=5.01e-4).components] == ["U", "N", "E"]
    row = np.array([0.0, 1.0])
    with pytest.raises(RecordError, match="U, N and E"):
        CWA.write(Record("", tuple(Component(name, row, "gal", 0.1) for name in "XYZ")))
    with pytest.raises(RecordError, match="check the unit"):
        CWA.write(Record("", tuple(Component(name, row * 1e5, "gal", 0.1) for name in "UNE")))
