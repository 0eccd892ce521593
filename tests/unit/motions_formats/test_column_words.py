"""Words above and behind columns of numbers: what they state is used, or its contradiction refused."""

import numpy as np
import pytest

import rocking as rk
from rocking.errors import InvalidValueError, RecordError
from rocking.motions.formats import Component, Record, Source, formats, read_motion, read_record

pytestmark = pytest.mark.verifies(room="motions and records")

COLUMNS = formats()["columns"]
VALUES = [0.0, 0.1, -0.2, 0.3, -0.1, 0.05, 0.0]
LONE = "\n".join(map(str, VALUES)) + "\n"
ZERO = "0.0\n"
PAIRS = "\n".join(f"{0.01 * k:.2f},{value}" for k, value in enumerate(VALUES)) + "\n"


def _source(text, name="words.txt"):
    return Source(name, text.encode())


def _read(text, units=None, step=None):
    source = _source(text)
    (part,) = COLUMNS.read(source, units, step).components
    assert [name for name, one in formats().items() if one.recognises(source)] == ["columns"]
    return part, source


@pytest.mark.parametrize(
    "words",
    [
        "Time Step: 0.02", "# delta: 0.02", "#DELTA: 0.02\n#LENGTH: 7", "dt = 20 ms", "step 0.02 s",
        "time step is 0.02 sec",
        "Sampling rate 50 Hz", "SampleRate(Hz): 50", "# sps = 50", "# fs: 0.05 kHz", "50 samples per second",
        "Abtastrate: 50", "frequenza di campionamento = 50", "Title\nNPTS = 7, Tstep = 0.02",
        "sampling interval (s): 0.02",
    ],
)  # fmt: skip
def test_the_step_in_whatever_words(words):
    """Steps and rates give 0.02 s, with a mark of comments and without; another step is refused."""
    part, _ = _read(f"{words}\n{LONE}", "g")
    assert part.time_step == pytest.approx(0.02, rel=1e-12)
    assert part.acceleration.tolist() == VALUES
    with pytest.raises(RecordError, match=r"states a time step of 0\.02 s, not 0\.01"):
        _read(f"{words}\n{LONE}", "g", 0.01)


def test_words_that_contradict_one_another_are_refused():
    """Two steps, another count, a unit that is not known beside one that the user states."""
    for words, message in (
        ("dt = 0.02\nsampling rate: 100 Hz", "the time step 0.01 s contradicts 0.02 s elsewhere"),
        ("dt = 0.02\nNPTS = 8", "states 8 samples, but the file contains 7"),
        ("dt = 0.02\nunits: furlong/s2", "the unit of the file is 'furlong/s2', not g"),
        ("dt = 0.02\nunità: furlong/s2", "the unit of the file is 'furlong/s2', not g"),
        ("dt = 0.02\nunits: cm/s2", "states the unit cm/s2, not g"),
        ("dt = 0.02\nVelocity in cm/s", "a velocity"),
        ("dt = 0.02\nResponse spectrum, 5 % damping", "a response spectrum, not a record"),
    ):
        with pytest.raises(RecordError, match=message):
            COLUMNS.read(_source(f"{words}\n{LONE}"), "g")
    with pytest.raises(RecordError, match=r"12 may be the number of samples, not a sample; omit .* with skip=N"):
        COLUMNS.read(_source(f"A title\n12\n{LONE}{5 * ZERO}"), "g", 0.01)


def test_names_under_titles():
    """The last line of words names the columns; titles above it are kept in the header."""
    part, _ = _read("A quake.\nSource: made here\nBand: 0.1-25 Hz\nTime[s],Accel[g]\n" + PAIRS)
    assert (part.name, part.unit, part.time_step, part.acceleration.tolist()) == ("Accel", "g", 0.01, VALUES)
    part, _ = _read("Synthetic quake\nComponent UP\nacceleration in g\nstep 0.01 s\n" + LONE)
    assert (part.name, part.unit, part.time_step, part.direction) == ("UP", "g", 0.01, "up")


def test_a_first_time_of_zero_is_no_count():
    """A spreadsheet writes 0 for the first time: columns, whatever the unit; a count of pairs stays eqsig's."""
    rows = "\n".join(f"{0.01 * k:g},{value}" for k, value in enumerate(VALUES))
    part, _ = _read(f"time [s],acc [g]\n{rows}\n")
    assert (part.unit, part.time_step, part.acceleration.tolist()) == ("g", 0.01, VALUES)
    six = "name\n6 0.02\n0.1 0.2\n0.3 0.1\n-0.1 -0.2\n"
    assert formats()["eqsig"].recognises(_source(six))
    assert not formats()["eqsig"].recognises(_source(six.replace("6 0.02", "5 0.02")))


def test_times_in_milliseconds_are_no_seconds():
    """time_ms, time [ms] and time ms are refused alike, also where the user states the unit of acceleration."""
    rows = "\n".join(f"{10 * k},{value}" for k, value in enumerate(VALUES))
    for name in ("time_ms", "time [ms]", "time ms"):
        with pytest.raises(RecordError, match="must be in seconds"):
            COLUMNS.read(_source(f"{name},acc_g\n{rows}\n"), "g")
    part, _ = _read("time_s,acc_g\n" + PAIRS)
    assert part.unit == "g"
    with pytest.raises(RecordError, match="states the unit g, not gal"):
        COLUMNS.read(_source("time_s,acc_g\n" + PAIRS), "gal")


def test_times_of_six_digits():
    """LabVIEW writes 40.985, 40.9862, 40.9875: even to their digits; a missing line or a wrong digit is not."""
    times = [f"{0.00125 * k:.6g}" for k in range(40_000)]
    assert times[32789] == "40.9862"
    rows = [f"{time}\t0.{k % 7}" for k, time in enumerate(times)]
    part, _ = _read("\n".join(rows), "g")
    assert part.time_step == 0.00125
    for place in (5, 9000, 32789):
        with pytest.raises(RecordError, match="not evenly spaced"):
            COLUMNS.read(_source("\n".join(rows[:place] + rows[place + 1 :])), "g")
    with pytest.raises(RecordError, match="not evenly spaced"):
        COLUMNS.read(_source("\n".join(rows).replace("40.9862", "40.9872")), "g")


def test_several_times_of_equal_content_are_one():
    """Each channel has its own time: equal ones are one, and named as left out; others are refused."""
    rows = [f"{0.01 * k:.2f};{v};{0.01 * k:.2f};{2 * v}" for k, v in enumerate(VALUES)]
    text = "Time [s];a [g];Time [s];b [g]\n"
    record = COLUMNS.read(_source(text + "\n".join(rows)))
    assert [(part.name, part.acceleration[1]) for part in record.components] == [("a", 0.1), ("b", 0.2)]
    assert record.metadata["left out"] == "Time [s]"
    with pytest.raises(RecordError, match="times with different steps"):
        COLUMNS.read(_source(text + "\n".join([*rows[:-1], rows[-1].replace(";0.06;", ";0.07;")])))


def test_skip_passes_over_lines(tmp_path):
    """skip=N passes over whatever stands above, and the provenance has it."""
    path = tmp_path / "odd.txt"
    path.write_text("***\n7\n0.01\n" + LONE, "utf-8")
    with pytest.raises(RecordError):
        read_record(path, units="g", time_step=0.01)
    motion = read_motion(path, None, "g", 0.01, skip=3)
    assert motion.acceleration / 9.80665 == pytest.approx(VALUES)
    assert "lines skipped at the top 3" in motion.provenance[1]


@pytest.mark.parametrize("end", ["*** End Data ***", "END", "EOF", "End of file"])
def test_a_closing_word_is_doubted(end):
    """Columns, wide rows, eqsig's and networks' files are read, and the word is named; other words are refused."""
    wide = "\n".join(" ".join(["0.1"] * 8) for _ in range(6)) + "\n0.2 0.3\n"
    for text, kind, count in (
        (LONE, COLUMNS, 7),
        (wide, COLUMNS, 50),
        ("name\n7 0.01\n" + LONE, formats()["eqsig"], 7),
    ):
        source = _source(f"{text}{end}\n")
        (part,) = kind.read(source, "g", 0.01).components
        assert part.acceleration.size == count
        assert "after the last number is ignored" in source.doubts[0]
        with pytest.raises(RecordError):
            kind.read(_source(f"{text}0.1 more\n"), "g", 0.01)


def test_rows_more_than_stated_are_doubted(made_up):
    """Two rows behind those that a UNAM file states are left out with both counts; many, or one fewer, are refused."""
    kind = formats()["unam"]
    text = kind.write(made_up("V", "N90E", "N00E", unit="gal", scale=100.0)).decode("latin-1")
    row = text.rstrip("\n").splitlines()[-1]
    source = _source(text + f"{row}\n{row}\n")
    assert kind.read(source).components[0].acceleration.size == 61
    assert "states 61 samples, but the file contains 63; the last 2 are ignored" in source.doubts[0]
    for wrong in (text + f"{row}\n" * 6, text.replace(f"{row}\n", "")):
        with pytest.raises(RecordError):
            kind.read(_source(wrong))


def test_turkish_names():
    """Names in Turkey's alphabet are read in it, and a vertical one is known; Iceland's stay as they are."""
    rows = "\n".join(f"{0.01 * k:.2f};{v};{v};{v}" for k, v in enumerate(VALUES))
    text = f"Zaman (s);Kuzey-Güney (g);Doğu-Bat\u0131 (g);Düşey (g)\n{rows}\n"
    record = COLUMNS.read(Source("a.txt", text.encode("cp1254")))
    assert [part.name for part in record.components] == ["Kuzey-Güney", "Doğu-Bat\u0131", "Düşey"]
    assert [part.direction for part in record.components] == [0.0, 90.0, "up"]
    record = COLUMNS.read(Source("a.txt", f"time [s],Þorlákshöfn [g]\n{PAIRS}".encode("latin-1")))
    assert record.components[0].name == "Þorlákshöfn"


def test_a_file_of_spectra_is_refused_as_that(tmp_path):
    """Volume 3 of CSMIP holds spectra, and the refusal has the word."""
    path = tmp_path / "CHAN001.V3"
    top = "RESPONSE AND FOURIER AMPLITUDE SPECTRA OF CORRECTED ACCELEROGRAM\nSHAKE EARTHQUAKE\n"
    path.write_text(top + "    1    2    3\n" * 5 + "  .100  .200\n" * 20, "latin-1")
    with pytest.raises(RecordError, match=r"spectr(a|um)"):
        read_record(path, units="g", time_step=0.01)


def test_a_dead_record_is_doubted(tmp_path):
    """Less than the noise of an accelerometer is no record; a weak one is."""
    for peak, quiet in ((5e-14, True), (4e-4, False)):
        path = tmp_path / f"{quiet}.txt"
        part = Component("a", peak * np.sin(0.2 * np.arange(200)), "g", 0.01)
        path.write_bytes(COLUMNS.write(Record("columns", (part,))))
        if quiet:
            with pytest.warns(UserWarning, match="below the noise of an accelerometer"):
                motion = read_motion(path)
            assert "check the channel" in motion.provenance[-1]
        else:
            assert "dead" not in " ".join(read_motion(path).provenance)


@pytest.mark.parametrize(
    ("name", "options", "expected"),
    [
        ("excel_zero.csv", {}, ("g", 0.01, 600)),
        ("titles_then_names.dat", {}, ("g", 0.01, 600)),
        ("five_header_lines.txt", {"units": "g", "time_step": 0.01}, ("g", 0.01, 600)),
        ("five_header_lines.txt", {}, ("g", 0.01, 600)),
        ("time_step_header.txt", {"units": "g"}, ("g", 0.01, 600)),
        ("generic_npts_tstep.txt", {}, ("cm/s2", 0.01, 600)),
        ("eight_columns_end_mark.dat", {"units": "g", "time_step": 0.01}, ("g", 0.01, 599)),
        ("contradiction_delta.txt", {}, ("g", 0.02, 600)),
        ("contradiction_delta.txt", {"time_step": 0.01}, "not 0.01 s"),
        ("sh.ASC", {"units": "g"}, ("g", 0.02, 600)),
        ("sh.ASC", {"units": "g", "time_step": 0.01}, "not 0.01 s"),
        ("time_ms.csv", {"units": "g"}, "must be in seconds"),
        ("smc_text_peak_rounded.smc", {}, ("cm/s2", 0.01, 600)),
        ("unam_two_rows_more.txt", {}, ("gal", 0.01, 600)),
    ],
)
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_cases_of_words(case_records, name, options, expected):
    """Each file is as its description says."""
    path = case_records / name
    if isinstance(expected, str):
        with pytest.raises(RecordError, match=expected):
            read_record(path, **options)
        return
    for part in read_record(path, **options).components:
        assert (part.unit, part.time_step, part.acceleration.size) == expected


@pytest.mark.parametrize(
    "words",
    [
        "Sampling Interval (ms): 20", "dt [ms] 20", "dt(ms)=20", "SAMPLING_INTERVAL_MS: 20",
        "Sample period (µs): 20000",
        "Sampling rate (kHz): 0.05", "Sample Rate (Hz) 50", "Time Step (sec)  0.02", "dt 0.02", "dt;0,02",
        "sample spacing: 0.02", "Delta_X 0.02", "Sampling Freq(Hz)  50Hz", "Pas (s): 0,02",
    ],
)  # fmt: skip
def test_a_unit_before_the_step_counts(words):
    """Milliseconds and kilohertz may stand in brackets before the number; what is not milliseconds is seconds."""
    part, _ = _read(f"{words}\nacceleration in g\n{LONE}")
    assert part.time_step == pytest.approx(0.02, rel=1e-12)
    with pytest.raises(RecordError, match=r"states a time step of 0\.02 s, not 20"):
        _read(f"{words}\nacceleration in g\n{LONE}", step=20.0)


@pytest.mark.parametrize(
    ("words", "side"),
    [
        ("Vertical component", "up"), ("Orientation = Vertical (Up)", "up"), ("Azimuth: vertical", "up"),
        ("UD-component", "up"), ("El Centro 1940, UD", "unclear"), ("Station A, HNZ", "unclear"),
        ("Comp: 3 (vertical)", "unclear"), ("Record: XYZ-UP", "unclear"), ("Channel 2 Vert", "unclear"),
        ("Richtung: senkrecht", "unclear"), ("Comp: 90 (east)", 90.0), ("TEST SET-UP", None),
        ("Vertical motion of test 3", "unclear"),
        ("NS component", 0.0), ("peak vertical acceleration elsewhere", None), ("Hudson", None),
        ("vertical datum", None),
    ],
)  # fmt: skip
def test_a_vertical_in_words_is_no_horizontal_motion(tmp_path, words, side):
    """A line that names the vertical is read, or makes the direction unclear; other words leave it open."""
    part, _ = _read(f"{words}\nDT = 0.02\nacc (g)\n{LONE}")
    assert part.direction == side
    path = tmp_path / "record.txt"
    path.write_text(f"{words}\nDT = 0.02\nacc (g)\n{LONE}", "utf-8")
    motion = read_motion(path)
    block = rk.Block(width=0.6, height=2.0)
    if isinstance(side, str):
        with pytest.raises(InvalidValueError, match="vertical"):
            rk.simulate(block, motion)
    else:
        assert rk.simulate(block, motion) is not None


def test_a_unit_in_words_and_a_factor_that_is_not_used():
    """A capital G and gals state a unit, which contradicts another; a scale factor is doubted, as it is not used."""
    for words, unit in (("Acceleration data in units of G", "g"), ("Data in gals", "gal")):
        assert _read(f"{words}\nDT = 0.02\n{LONE}")[0].unit == unit
        with pytest.raises(RecordError, match=f"states the unit {unit}, not m/s2"):
            _read(f"{words}\nDT = 0.02\n{LONE}", "m/s2")
    _, source = _read(f"Scale factor: 9.81\nDT = 0.02\nacc (g)\n{LONE}")
    assert source.doubts == ["words.txt, line 1: 'Scale factor: 9.81' is not understood and ignored"]


def test_a_timestamp_in_milliseconds_is_a_time():
    """It was left out, so that any step that the user said was taken."""
    with pytest.raises(RecordError, match="the times must be in seconds"):
        COLUMNS.read(_source(f"timestamp_ms,acc (g)\n{PAIRS}"), None, 0.01)
