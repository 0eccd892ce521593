"""Networks' own text formats, each typed by hand in its layout: what is read, what is refused and what is doubted."""

import numpy as np
import pytest
from record_files import read_back, refused

from rocking.errors import RecordError
from rocking.motions.formats import Component, Record, Source, formats, read_record

CSMNC = """065ABC120103153901
0120103153957 2012-01-03 15:39:57 BTM
SOMEWHERE EARTHQUAKE, NOWHERE,CHN
EPICENTER  39.939N 77.339E DEPTH 9 KM
MAGNITUDE  4.0(Ms)
STATION: 65ABC 39.700N 77.599E
SITE CONDITION: SOIL
INSTRUMENT TYPE: ETNA/ES-T
OBSERVING POINT: GROUND
COMP. EW
UNCORRECTED ACCELERATION          UNIT: CM/SEC/SEC
NO. OF POINTS:  10  EQUALLY SPACED INTERVALS OF:  0.005  SEC
PEAK VALUE:    -16.986   AT   0.02 SEC    DURATION:  0.05 SEC
PRE-EVENT TIME:  20  SEC  RECORDER TIME:  2012-01-3 15:39:44.000 BTM
CSMNC

-2.500000E-3 -2.658437E-2  1.224115E-2  1.645114E-2 -1.698632E+1 -1.395438E-2  3.048446E-2  7.893741E-5
-4.248879E-2  1.832225E-2
"""
NSMN = """STRONG GROUND MOTION RECORDS OF TURKIYE
PLACE                   : SOMEWHERE
EARTHQUAKE DATE         : 2017/07/20 22:31:09 (GMT)
STATION ID              : 0921
RECORD TIME             : 20/07/2017 22:30:58.000000 (GMT)
NUMBER OF DATA          : 3
SAMPLING INTERVAL (sec) : 0.01
RAW PGA VALUES (gal)    : (N-S) 13.200332 (E-W) 2.163827 (U-D) 9.840572
Copyright NOBODY
       N-S          E-W          U-D
    0.000909     -0.000191    -0.000092
  -13.200332     -2.163827     9.840572
    0.000919     -0.000199    -0.000099
"""
UNAM = """******************
ARCHIVO ESTANDAR DE ACELERACION:
VERSION DEL FORMATO                    : 2.0
NOMBRE DE LA ESTACION                  : UN LUGAR
NUMERO DE CANALES                      : 3
ORIENTACION C1-C6 (rumbo;orientacion)  : /V/N00E/N90E
ORIENTACION C7-C12 (rumbo;orientacion) :
INTERVALO DE MUESTREO, C1-C6 (s)       : /0.005/0.005/0.005
FECHA DEL SISMO [GMT]                  : 2017/09/19
NUM. TOTAL DE MUESTRAS, C1-C6          : /4/4/4
ACEL. MAX.(Gal), C1-C6                 : /25.6114/58.7394/-42.3377
ACEL. MAX., C1-C6, EN LA MUESTRA       : /2/3/4
UNIDADES DE LOS DATOS                  : Gal (cm/s/s)
FORMATO DATOS (FORTRAN,10 campos/dato) : 3F10.4
DATOS DE ACELERACION:
---------+---------+---------+
   CANAL-1   CANAL-2   CANAL-3
         V      N00E      N90E
---------+---------+---------+
   -0.0083   -0.0214    0.0000
   25.6114   -0.0103    0.0319
   -0.0240   58.7394    0.0337
   -0.0425   -0.0177  -42.3377
"""
ITACA = """Event Date & Time             : 2009-04-06 01:32:39
Station Code / Name           : 3666 / Somewhere, Italy
Network                       : XX (Nobody)
Orientation                   : NS
Processing Info               : none
Filter Cut-off Frequency (Hz) : 0.100 - 30.000
Time Increment (s)            : 0.005
Number of Data                : 6
PGA (m/s/s)                   : 1.5980753E-02
Accelaration time series in m/s/s
-2.8280696E-05-2.8285169E-05 1.5980753E-02-2.8280043E-05-2.8266747E-05
-2.8245438E-05
"""
CSN = """# Tiempo de inicio (UTC): 2014-04-01T23:46:00.000000Z
# Tasa de muestreo: 200.0 muestras/segundo
# Numero de muestras: 3
# Estacion: C01O Componente: HNE
# Latitud: -33.0 Longitud: -70.0
0.001
-0.25
0.125
"""
EQSIG = "motion one\n7 0.0100\n0.000000\n0.5\n-1.25\n0.0\n0.1\n0.2\n0.3\n"
SLIST = """TIMESERIES BW_RJOB__HNE_D, 8 samples, 200 sps, 2009-08-24T00:20:03.000000, SLIST, FLOAT, M/S**2
+1.0e-01  -2.0e-01  +3.0e-01  -4.0e-01  +5.0e-01  -6.0e-01
+7.0e-01  -8.0e-01
"""
TSPAIR = """TIMESERIES BW_RJOB__HNE_D, 3 samples, 200 sps, 2009-08-24T00:20:03.000000, TSPAIR, FLOAT, M/S**2
2009-08-24T00:20:03.000000  +1.0e-01
2009-08-24T00:20:03.005000  -2.0e-01
2009-08-24T00:20:03.010000  +3.0e-01
"""
TYPED = {
    "csmnc": (CSMNC, ["EW"], "cm/s2", 0.005, 10, [16.986]),
    "nsmn": (NSMN, ["N-S", "E-W", "U-D"], "gal", 0.01, 3, [13.200332, 2.163827, 9.840572]),
    "unam": (UNAM, ["V", "N00E", "N90E"], "gal", 0.005, 4, [25.6114, 58.7394, 42.3377]),
    "itaca": (ITACA, ["NS"], "m/s2", 0.005, 6, [1.5980753e-2]),
    "csn": (CSN, ["HNE"], "m/s2", 0.005, 3, [None]),
    "slist": (SLIST, ["HNE"], "m/s2", 0.005, 8, [None]),
}


@pytest.mark.parametrize("name", TYPED)
def test_typed_files_say_what_was_laid_out(name: str) -> None:
    """Recognised by one reader; names, unit, step, number and stated peaks are those of the layout."""
    text, names, unit, step, count, peaks = TYPED[name]
    source = Source("typed.txt", text.encode("latin-1"))
    assert [one.name for one in formats().values() if one.recognises(source) and one.name != "columns"] == [name]
    record = formats()[name].read(source)
    assert [part.name for part in record.components] == names
    assert {(part.unit, part.time_step, part.acceleration.size) for part in record.components} == {(unit, step, count)}
    assert [part.stated_peak for part in record.components] == peaks
    assert not source.doubts
    assert record.metadata


def test_values_stand_where_they_were_typed() -> None:
    """Fixed columns and blanks, side by side or one after another, end up in the right component and order."""
    values = {name: formats()[name].read(Source(name, text.encode())) for name, (text, *_) in TYPED.items()}
    assert values["csmnc"].components[0].acceleration[[0, 4, 9]].tolist() == [-0.0025, -16.98632, 0.01832225]
    assert values["nsmn"].components[1].acceleration.tolist() == [-0.000191, -2.163827, -0.000199]
    assert values["unam"].components[2].acceleration.tolist() == [0.0, 0.0319, 0.0337, -42.3377]
    assert values["itaca"].components[0].acceleration[2:].tolist() == [
        1.5980753e-02, -2.8280043e-05, -2.8266747e-05, -2.8245438e-05,
    ]  # fmt: skip
    assert values["csn"].components[0].acceleration.tolist() == [0.001, -0.25, 0.125]
    pairs = formats()["slist"].read(Source("pairs", TSPAIR.encode())).components[0]
    assert (pairs.acceleration.tolist(), pairs.time_step) == ([0.1, -0.2, 0.3], 0.005)


DAMAGES = {
    "csmnc": (
        ("NO. OF POINTS:  10", "NO. OF POINTS:  11", "states 11 samples, but the file contains 10"),
        ("-16.986   AT", "-16.996   AT", "peak of EW of 16.996, but the data have 16.9863"),
        ("AT   0.02 SEC", "AT   0.04 SEC", "doubt:states the peak at 0.04 s"),
        ("DURATION:  0.05 SEC", "DURATION:  0.09 SEC", "doubt:duration of 0.09 s"),
        ("UNIT: CM/SEC/SEC", "UNIT: CM/SEC", "accelerations required, but the file states CM/SEC, a velocity"),
        ("CM/SEC/SEC", "FURLONG", "unit CM/SEC/SEC expected"),
        ("-1.698632E+1", "-1.69863xE+1", "line 17: number expected"),
        ("INTERVALS OF:  0.005", "INTERVALS OF:  0.0o5", "understood"),
    ),
    "nsmn": (
        ("NUMBER OF DATA          : 3", "NUMBER OF DATA          : 4", "states 4 samples, but the file contains 3"),
        ("DATA          : 3", "DATA          : 3\nNUMBER OF DATA : 3", "one header line that begins with .*, found 2"),
        ("(E-W) 2.163827", "(E-W) 2.163837", "peak of E-W of 2.16384"),
        ("    0.000909 ", "             ", "3 numbers per line expected|2 numbers per line"),
        ("VALUES (gal)", "VALUES (g)", "understood"),
        ("(U-D) 9", "(Z) 9", "but the columns have other names"),
    ),
    "unam": (
        (": /4/4/4", ": /5/5/5", "columns of 10 characters expected"),
        (": /4/4/4", ": /4/4/5", "equal length and time step"),
        ("58.7394/", "58.7395/", "doubt:^$|peak of N00E"),
        ("Gal (cm/s/s)", "cuentas", "understood"),
        (": 3F10.4", ": 2F10.4", "states 3 channels"),
        ("CANALES                      : 3", "CANALES                      : 4", "4 values behind slashes|C7-C12"),
    ),
    "itaca": (
        ("Number of Data                : 6", "Number of Data                : 7", "columns of 14 characters expected"),
        (": 1.5980753E-02", ": 1.5990753E-02", "peak of NS of 0.0159908"),
        ("series in m/s/s", "series in furlong", "understood"),
    ),
    "csn": (
        ("muestras: 3", "muestras: 4", "states 4 samples, but the file contains 3"),
        ("muestras: 3", "muestras: three", "understood"),
        ("-0.25\n", "-0.25x\n", "line 7: number expected"),
    ),
    "slist": (
        ("8 samples", "9 samples", "states 9 samples, but the file contains 8"),
        ("M/S**2", "Counts", "the file states Counts, a count of a recorder"),
        ("HNE_D", "HHE_D", "doubt:the code of channel HHE means velocities"),
        (", SLIST,", ", TRIPLE,", "TIMESERIES code"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", [name for name in DAMAGES if name != "unam"])
def test_damage_is_refused_or_doubted(name: str) -> None:
    """Count, unit, step and peak refuse; time of the peak, duration and codes are doubted."""
    refused(formats()[name], TYPED[name][0], DAMAGES[name], once=False)


def test_damage_of_unam() -> None:
    """As of the others; its numbers repeat for each channel."""
    damages = [one for one in DAMAGES["unam"] if "58.7394" not in one[0]]
    refused(formats()["unam"], UNAM, damages, once=False)
    with pytest.raises(RecordError, match=r"peak of N00E of 58\.7495"):
        formats()["unam"].read(Source("x", UNAM.replace("58.7394/", "58.7495/").encode()))


@pytest.mark.parametrize(
    ("name", "components", "factor", "atol"),
    [
        ("csmnc", "EW", 100.0, 1e-4), ("nsmn", "N-S E-W U-D", 100.0, 5.1e-7), ("unam", "V N00E", 100.0, 5.1e-5),
        ("itaca", "NS", 1.0, 1e-6), ("csn", "HNE", 1.0, 1e-8), ("slist", "HNE HNN HNZ", 1.0, 1e-9),
        ("usc", "N90E", 10.0 / 9.80665, 5.1e-4), ("geonet-v1a", "N10E N80W Up", 1000.0, 0.051),
        ("eqsig", "a", 1.0, 0.0),
    ],
)  # fmt: skip
def test_what_is_written_is_read_back(name: str, components: str, factor: float, atol: float) -> None:
    """To the digits of the format, in its unit, without options."""
    time = np.arange(60) * 0.02
    rows = [np.sin((7.0 + k) * time) * np.exp(-time) for k in range(len(components.split()))]
    parts = tuple(Component(one, row, "m/s2", 0.02) for one, row in zip(components.split(), rows, strict=True))
    if name == "eqsig":
        (part,) = formats()[name].read(Source("x", formats()[name].write(Record("", parts)))).components
        assert (part.acceleration.tolist(), part.unit, part.time_step) == (rows[0].tolist(), "m/s2", 0.02)
        return
    read_back(formats()[name], Record("", parts), factor, atol=atol)


def test_a_count_and_a_step_on_a_line_of_their_own() -> None:
    """With or without a name, and any number of values a line; the unit is asked for, or stands behind the name."""
    eqsig = formats()["eqsig"]
    values = [0.0, 0.5, -1.25, 0.0, 0.1, 0.2, 0.3]
    three = "7 .01\n0.0 0.5 -1.25\n0.0 0.1 0.2\n0.3\n"
    for text in (EQSIG, three, "a\nb\n" + three):
        source = Source("x.txt", text.encode())
        assert [one.name for one in formats().values() if one.recognises(source) and one.name != "columns"] == ["eqsig"]
        part = eqsig.read(source, "g").components[0]
        assert (part.acceleration.tolist(), part.time_step, part.unit) == (values, 0.01, "g")
        with pytest.raises(RecordError, match="add units="):
            eqsig.read(source)
    with pytest.raises(RecordError, match="states 8 samples, but the file contains 7"):
        eqsig.read(Source("x", EQSIG.replace("7 0.01", "8 0.01").encode()), "g")
    with pytest.raises(RecordError, match="the file states cm/s, a velocity"):
        eqsig.read(Source("x", EQSIG.replace("one", "[cm/s]").encode()), "g")
    for text, name in ((EQSIG.replace("one", "velocity"), "x"), (EQSIG, "one_vel.txt")):
        with pytest.raises(RecordError, match=r"accelerations required, but its (header|name) contains 'vel"):
            eqsig.read(Source(name, text.encode()), "g")
    # times and samples are no count and step, whatever the first line
    assert not eqsig.recognises(Source("x", b"7 0.01\n8 0.02\n9 0.03\n"))


USC = """FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:
SOMEWHERE EARTHQUAKE                                                    21
JAN 17, 1994 -1230 GMT                                                  22
IBB101  94.160.0 N                                                      18
STATION USC# 0016   34 05 22N, 118 26 05N                               39
CELLAR                                                                  34
COMP N90E                                                               9
SOMEWHERE EARTHQUAKE   JAN 17, 1994 -1230 GMT                           46
EPICENTER -   34 12 48N, 118 32 13W                                     35
INSTR PERIOD =  .038 SEC  DAMPING =   .558  SENSITIVITY =   1.75CM/G    69
NO. OF POINTS =     {count}      DURATION =  {duration} SEC                      50
UNITS ARE SEC AND G/10                                                  22
RMS ACCLN. OF COMPLETE RECORD =     .400 G/10                           45
"""


def _usc(times: np.ndarray, values: np.ndarray) -> str:
    count = times.size
    wholes = [count if place == 27 else 0 for place in range(100)]
    reals = [times[-1] if place == 2 else 34.213 if place == 6 else 0.0 for place in range(50)]
    blocks = [
        *("".join(f"{one:5d}" for one in wholes[k : k + 16]) for k in range(0, 100, 16)),
        *("".join(f"{one:10.3f}" for one in reals[k : k + 8]) for k in range(0, 50, 8)),
    ]
    pairs = [one for pair in zip(times, values, strict=True) for one in pair]
    blocks += [" " + "".join(f"{one:7.3f}" for one in pairs[k : k + 10]) for k in range(0, len(pairs), 10)]
    return USC.format(count=count, duration=f"{times[-1]:.3f}") + "\n".join(blocks) + "\n"


def test_uneven_times_are_resampled_by_straight_lines() -> None:
    """A parabola at uneven times comes back to the error of straight lines; its peak is kept to the last digit."""
    drift = np.round(np.cumsum(np.linspace(0.004, 0.006, 400)), 3)
    exact = -2.5 + 0.5 * (drift - 1.0) ** 2
    source = Source("x.s0a", _usc(drift, exact).encode())
    record = formats()["usc"].read(source)
    (part,) = record.components
    assert (part.name, part.unit, record.metadata["station"]) == ("N90E", "g/10", "CELLAR")
    assert part.time_step == 0.005
    assert part.peak == np.abs(np.round(exact, 3)).max()
    top = int(np.abs(np.round(exact, 3)).argmax())
    times = drift[top] + 0.005 * (np.arange(part.acceleration.size) - int(np.abs(part.acceleration).argmax()))
    assert drift[0] <= times[0] < drift[0] + 0.005
    assert drift[-1] - 0.005 < times[-1] <= drift[-1]
    # half a digit of the samples, and h^2/8 of the curvature
    np.testing.assert_allclose(part.acceleration, -2.5 + 0.5 * (times - 1.0) ** 2, rtol=0.0, atol=5.1e-4 + 0.007**2 / 8)
    assert part.metadata["resampled"] == "400 samples at uneven times, resampled at 0.005 s by straight lines"
    assert source.doubts == [f"x.s0a: {part.metadata['resampled']}"]
    with pytest.raises(RecordError, match=r"401 samples|characters"):
        formats()["usc"].read(Source("x", _usc(drift, exact).replace("  400   ", "  401   ").encode()))
    # one time off an even row is damage, and no way of sampling
    even = np.arange(400) * 0.005
    even[200] += 0.002
    with pytest.raises(RecordError, match="not evenly spaced"):
        formats()["usc"].read(Source("x", _usc(even, exact).encode()))


def test_smc_at_uneven_times() -> None:
    """Without a rate, times and samples alternate, and are counted together; a line too many is doubted."""
    smc = formats()["smc-usgs"]
    time = np.cumsum(np.linspace(0.01, 0.02, 50))
    record = Record("", (Component("45", 100.0 * np.sin(3.0 * time), "cm/s2", 0.02),))
    lines = smc.write(record).decode().split("\n")
    values = np.array([float(f"{one:.4E}") for one in record.components[0].acceleration])
    lines[13] = f"{100:10d}" + lines[13][10:]
    lines[17] = lines[17][:15] + "  0.1700000E+39" + lines[17][30:]
    lines[22] = lines[22][:45] + "  0.1700000E+39" + lines[22][60:]
    lines[23] = "  0.1700000E+39" + lines[23][15:]
    words = [smc._word(one) for pair in zip(time, values, strict=True) for one in pair]
    lines[28:] = ["".join(words[k : k + 8]) for k in range(0, 100, 8)] + [""]
    source = Source("x.smc", "\n".join(lines).encode())
    assert smc.recognises(source)
    part = smc.read(source).components[0]
    assert part.peak == np.abs(values).max() == part.stated_peak
    assert (part.time_step, part.metadata["resampled"].split()[:2]) == (0.01, ["50", "samples"])
    more = Source("x.smc", "\n".join([*lines[:-1], lines[30], ""]).encode())
    np.testing.assert_array_equal(smc.read(more).components[0].acceleration, part.acceleration)
    assert "after the last sample" in more.doubts[0]


def test_doubts_are_said_and_kept(tmp_path) -> None:
    """A record with a doubt is read with a warning, and keeps the sentence."""
    path = tmp_path / "late.dat"
    path.write_text(CSMNC.replace("AT   0.02 SEC", "AT   9.02 SEC"))
    with pytest.warns(UserWarning, match=r"check the input: late\.dat: the header states the peak at 9.02 s"):
        record = read_record(path)
    assert "the header states the peak at 9.02 s" in record.metadata["doubts"]
