"""Iran's Volume 1 files: uncorrected accelerations in g/10."""

import numpy as np
import pytest
from record_files import read_back, refused

from rocking.errors import RecordError
from rocking.motions.formats import Component, Record, Source, formats

BHRC = formats()["bhrc"]

# 11 samples at 200 a second; the count stands at place 26 of the whole numbers, the duration at 3 of the real ones
TYPED = """\
* VOL1DS FILE:  1234/01
Inst Type = SSA-2
Origin Time : 1999/12/31   12:23:16

L

COMP L1
Town                      Station   38.474 N 47.059 E   Altitude 1360m   Azimuth L 352   T 82
Epicenter 38.520 N 46.860 E   FD 12 Km mb      Ms      Mw6.1   M        ML   (BHRC   )
INSTR PERIOD =  .019 SEC   DAMPING =  .640
NO. OF POINTS =     11      DURATION =    .055
UNITS ARE SECONDS AND G/10

    0    0    0    0    0    0    0    0    0    0    0    0    0    0
    0    0    0    0    0    0    0    0    0    0    0   11    0    0
    0    0    0    0    0    0    0    0    0    0    0    0    0    0
    0    0    0    0    0    0    0    0    0    0    0    0    0    0
    0    0    0    0    0    0    0    0    0    0    0    0    0    0
    0    0    0    0    0    0    0    0    0    0    0    0    0    0
    0    0    0    0
  .188324E-01  .640000E+00  .550000E-01  .000000E+00  .100000E+00  .00
  .200000E+03  .000000E+00  .000000E+00  .000000E+00  .000000E+00  .00
  .000000E+00  .000000E+00  .000000E+00  .000000E+00  .000000E+00  .00
  .000000E+00  .000000E+00  .000000E+00  .000000E+00  .000000E+00  .00
  .000000E+00  .000000E+00  .000000E+00  .000000E+00  .000000E+00  .00
  .000000E+00  .000000E+00  .000000E+00  .000000E+00  .000000E+00  .00
  .000000E+00  .000000E+00
""" + "".join(["  .100000E-02"] * 9 + [" -.194316E+01\n", "  .854257E-03\n/&\n"])


def read(text: str = TYPED) -> Record:
    return BHRC.read(Source("1234-1.V1", text.replace("\n", "\r\n").encode()))


def test_a_typed_component_is_read() -> None:
    """Samples in g/10, step by the sampling rate, azimuth, and that nothing was corrected."""
    record = read()
    (part,) = record.components
    np.testing.assert_array_equal(part.acceleration, [0.001] * 9 + [-1.94316, 0.000854257])
    assert (part.name, part.unit, part.time_step, part.stated_peak) == ("L", "g/10", 0.005, None)
    assert part.metadata["azimuth"] == "352"
    assert record.metadata["processing"] == "uncorrected (Volume 1)"
    assert record.metadata["station"] == "Town"
    assert BHRC.recognises(Source("a", TYPED.encode()))


def test_three_components_are_read() -> None:
    """They follow each other and are told by their letters; the same letter twice is refused."""
    three = TYPED + TYPED.replace("COMP L1", "COMP V2") + TYPED.replace("COMP L1", "COMP T3")
    assert [part.name for part in read(three).components] == ["L", "V", "T"]
    with pytest.raises(RecordError, match="twice"):
        read(TYPED + TYPED)
    for blank in ("\n", "\n\n"):
        read(TYPED + blank)
        with pytest.raises(RecordError):
            read(TYPED + "rubbish" + blank)


DAMAGES = [
    ("VOL1DS", "VOL2DS", "Volume 2 is not supported"),
    ("G/10", "CM/SEC", "understood"),
    ("POINTS =     11", "POINTS =     12", "states 11 samples, but the file contains 12"),
    ("0   11    0", "0   12    0", "states 12 samples, but the file contains 11"),
    ("DURATION =    .055", "DURATION =    .065", "doubt:duration"),
    ("  .550000E-01", "  .560000E-01", "doubt:duration"),
    ("  .200000E+03", "  .100000E+03", "doubt:duration"),
    ("  .200000E+03", "  .000000E+00", "time step"),
    (" -.194316E+01", " -.194316E+x1", "line 28"),
    ("/&", "", "/& expected"),
    ("  .854257E-03\n", "  .854257E-03  .854257E-03\n", "1 columns of 13"),
]


def test_damage_is_refused() -> None:
    """Volume, unit, both counts, both durations, the rate, columns and the end mark are checked."""
    refused(BHRC, TYPED, DAMAGES)


def test_what_is_written_is_read_back() -> None:
    """Six digits survive the change of unit; other names, and counts beyond five characters, are refused."""
    rows = {name: np.sin(np.arange(50.0) + k) for k, name in enumerate("LVT")}
    given = Record("", tuple(Component(name, row, "g", 0.005) for name, row in rows.items()))
    read_back(BHRC, given, 10.0, rtol=5.1e-6, atol=1e-12)
    with pytest.raises(RecordError, match="L, V and T"):
        BHRC.write(Record("", (Component("N", np.zeros(3), "g", 0.1),)))
    with pytest.raises(RecordError, match="99999"):
        BHRC.write(Record("", (Component("L", np.zeros(100_000), "g", 0.01),)))
