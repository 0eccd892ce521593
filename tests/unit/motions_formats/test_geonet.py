"""GeoNet Volume 2: three components, each with acceleration, velocity and displacement."""

import numpy as np
import pytest
from record_files import read_back, refused

from rocking.errors import RecordError
from rocking.motions.formats import Component, Record, Source, formats

GEONET = formats()["geonet-v2a"]

# 12 samples at 0.02 s; times in the text count from 0.04 s after the first one; some numbers touch each other
TEXT = """\
Corrected accelerogram 19991231_110256_ABCD_20 GNS Science
Site ABCD      42 31 24S  172 49 50E     Basalt file:  19991231_110300_ABCD
Town Hall
Instrument Basalt_1
Resolution: 24-bit   Instr Period: 0.0050 s   Damping: 0.700
Accelerogram 19991231_110256_ABCD_20                 Processed 2000 December 09
5 km south-west of Somewhere
1999 December 31         11:02:56 UT
Epicentre  42 41 33S 173 01 19E  Bearing S40E  Dist   25km  Depth   15km Mw 7.82
Number of points    12    Duration   0.22 sec
Instrument corrected data at 0.020 sec intervals
Band-pass filter transition bands are .10-.25 Hz and 24.50-25.50 Hz
Component {name}  {axis} Accelerometer Axis
Acceleration:  peak -22364.6 mm/s/s at   0.14 sec     rms    292.2 mm/s/s
Velocity:      peak -1016.55 mm/s   at   0.02 sec     rms    46.28 mm/s
Displacement:  peak   99.407 mm     at  -0.00 sec     rms   14.626 mm
"""
NUMBERS = "\n".join(
    [
        "    1999      12      31      11       2     560       0       0    1999      11",
        "      42      41      33     173       1      19      15       0      13      11",
        "      42      31      24     172      49      50      10      10     140      25",
        "   65536     250     250      12      12      12       0       0       2   20000",
        "   200.0    0.70    0.00   0.000  0.0000   0.000   0.000   1.000     0.0    0.00",
        "  42.523 172.830   42.69  173.02    7.82    0.00    0.00    0.00      0.      0.",
        "  327.68    0.04    0.04    0.22  0.0050  0.0200      0.      0.      0.  9806.6",
        "  2394.5   48.13   302.0   0.000      0.  2364.6   48.14   292.2  2662.2   0.818",
        " -298.49   59.02   46.28  332.60   0.653   99.41   53.60   14.63  105.82   0.232",
        "   0.100   0.150   0.250      0.      0.  24.500   1.000  25.500      0.      0.",
        "     0.0    -0.0     1.0     2.0     3.0     4.0     5.0-12345.6-12346.6-22364.6",
        "     7.0     8.0",
        "      0.    100.    200.  -1017.    300.      0.      1.      2.      3.      4.",
        "      5.      6.",
        "   0.000   1.000  99.407   1.000   2.000   3.000   4.000   5.000   6.000   7.000",
        "   8.000   9.000",
        "",
    ]
)


def typed() -> str:
    axes = (("N10E", "Longitudinal"), ("N80W", "Transverse"), ("Up  ", "Vertical"))
    return "".join(TEXT.replace("at  -0.00", "at   0.00").format(name=name, axis=axis) + NUMBERS for name, axis in axes)


def read(text: str) -> Record:
    return GEONET.read(Source("a.V2A", text.encode()))


def test_three_components_are_read_by_columns() -> None:
    """Numbers that touch, series with fewer decimals than their peaks, and the shift of the stated times."""
    source = Source("a.V2A", typed().encode())
    assert GEONET.recognises(source)
    record = GEONET.read(source)
    assert [part.name for part in record.components] == ["N10E", "N80W", "Up"]
    part = record.components[2]
    assert part.acceleration.tolist() == [0, 0, 1, 2, 3, 4, 5, -12345.6, -12346.6, -22364.6, 7, 8]
    assert (part.unit, part.time_step, part.stated_peak) == ("mm/s2", 0.02, 22364.6)
    assert part.metadata["axis"] == "Vertical Accelerometer Axis"
    assert record.metadata["station"] == "ABCD"
    assert record.metadata["filter"].startswith("Band-pass")


DAMAGES = [
    ("-22364.6 mm/s/s", "-22364.8 mm/s/s", "peak of acceleration, N10E"),
    ("at   0.14", "at   0.06", "doubt:the peak at"),
    ("-1016.55", "-1018.55", "doubt:peak of velocity"),
    ("99.407 mm ", "99.507 mm ", "doubt:peak of displacement"),
    ("Number of points    12", "Number of points    13", "states 12 samples, but the file contains 13"),
    ("Number of points    12", "Number of points 99999", "samples"),
    ("points    12    Duration   0.22", "points    12    Duration   0.32", "doubt:duration"),
    ("at 0.020 sec", "at 0.050 sec", "doubt:duration"),
    ("at 0.020 sec", "at 20.00 sec", "time step"),
    ("Component N80W", "Component N10E", "twice"),
    ("-12346.6", "********", "line 27"),
    (" mm/s/s at   0.14", " cm/s/s at   0.14", "understood"),
    ("     7.0     8.0\n", "     7.0     8.0     9.0\n", "2 columns"),
    ("Corrected accelerogram", "Uncorrected accelerogram", "component that begins with"),
]


def test_damage_is_refused() -> None:
    """Peaks, counts, step, unit and columns of accelerations refuse, the rest is doubted."""
    refused(GEONET, typed(), DAMAGES, once=False)


def test_a_file_that_ends_early_or_late_is_refused() -> None:
    """Three components belong to a file, and nothing after them."""
    whole = typed()
    with pytest.raises(RecordError, match="may be missing"):
        read(whole[: 2 * len(whole) // 3 - 1])
    short = "\n".join(whole.split("\n")[:-1])
    with pytest.raises(RecordError, match=r"more|displacement|expected"):
        read(short.rpartition("Corrected")[0] + "\n1.0")


def test_what_is_written_is_read_back() -> None:
    """Accelerations come back to 0.05 mm/s2."""
    rows = {name: np.sin(np.arange(50.0) + k) for k, name in enumerate(("N00E", "N90E", "Up"))}
    given = Record("", tuple(Component(name, row, "m/s2", 0.01) for name, row in rows.items()))
    read_back(GEONET, given, 1000.0, atol=0.0501)
    # peaks have as many decimals as in the files of the network
    assert _decimals(GEONET.write(given).decode()) == _decimals(typed())


def test_velocities_and_displacements_are_written() -> None:
    """Of 1 m/s2 they are v = a t and, by the trapezoids of the samples, d = a t^2 / 2."""
    time = 0.02 * np.arange(10.0)
    given = Record("", tuple(Component(name, np.ones(10), "m/s2", 0.02) for name in ("N00E", "N90E", "Up")))
    rows = [line.split() for line in GEONET.write(given).decode().rstrip().split("\n")[-3:]]
    for row, expected, digit in zip(
        rows, (1e3 + 0 * time, 1e3 * time, 500.0 * time**2), (0.05, 0.005, 5e-4), strict=True
    ):
        np.testing.assert_allclose(np.array(row, dtype=float), expected, rtol=0.0, atol=1.01 * digit)


def _decimals(text: str) -> list[int]:
    return [len(line.split()[2].partition(".")[2]) for line in text.split("\n") if ": " in line and "peak" in line]


def test_what_it_cannot_hold_is_refused() -> None:
    """Fewer components, or numbers too wide for their columns."""
    row = np.array([0.0, 1.0, 0.0])
    with pytest.raises(RecordError, match="three components"):
        GEONET.write(Record("", (Component("Up", row, "m/s2", 0.1),)))
    with pytest.raises(RecordError, match="does not fit"):
        GEONET.write(Record("", tuple(Component(name, row * 1e4, "m/s2", 0.1) for name in "XYZ")))
