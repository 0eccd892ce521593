"""Real records, where they are at hand: peak, unit, step and number of samples are those of their description."""

from pathlib import Path
from typing import NamedTuple

import pytest

from rocking.conventions import ACCELERATION_UNITS
from rocking.errors import InvalidValueError, RecordError
from rocking.motions.formats import Source, formats, read_motion, read_record


class Known(NamedTuple):
    """What the description of a file says; half a unit of the last digit of its peaks."""

    pattern: str
    format: str
    unit: str
    step: float
    samples: tuple[int, ...]
    peaks: tuple[float, ...]
    peak_unit: str
    digit: float
    units: str | None = None
    time_step: float | None = None


RECORDS = [
    Known("peer/IELC180.AT2", "peer", "g", 0.01, (4000,), (0.312881,), "g", 5e-7),
    Known("peer/elCentro.at2", "peer", "g", 0.02, (1559,), (0.31882,), "g", 5e-6),
    Known("peer/ARL360.at2", "peer", "g", 0.02, (2000,), (0.308057,), "g", 5e-7),
    Known("peer/CPM000.AT2", "peer", "g", 0.02, (1500,), (1.49731,), "g", 5e-6),
    Known("peer/RSN763_LOMAP_GIL067.AT2", "peer", "g", 0.005, (7999,), (0.358533,), "g", 5e-7),
    Known("peer/RSN8883_*090.AT2", "peer", "g", 0.005, (16396,), (0.0956788,), "g", 5e-8),
    Known("peer/RSN8883_*360.AT2", "peer", "g", 0.005, (16396,), (0.159803,), "g", 5e-7),
    Known("plain_values/tabasFN.txt", "columns", "g", 0.02, (2500,), (0.899949,), "g", 5e-7, "g", 0.02),
    Known("smc/*.smc", "smc-boore", "cm/s2", 0.02, (1646,), (0.0421708,), "g", 5e-8),
    Known("esm/*.ASC", "esm", "cm/s2", 0.005, (19128,), (0.000366095,), "g", 5e-10),
    Known("cosmos/*.v1", "cosmos", "cm/s2", 0.01, (7000,), (161.962,), "cm/s2", 5e-4),
    Known(
        "csmip_v2/*.V2", "csmip-v2", "cm/s2", 0.02, (3251, 3250, 3250), (267.957, 94.805, 256.231), "cm/s2", 5e-4
    ),
    Known("cwa_taiwan/*.dat", "cwa", "gal", 0.02, (6000,) * 3, (0.837, 2.273, 1.017), "cm/s2", 5e-4),
    Known("two_column/CHV1*.txt", "columns", "cm/s2", 0.005, (13549,), (0.755717,), "g", 5e-7, "cm/s2"),
    Known("two_column/Kobe.dat", "columns", "m/s2", 0.02, (1250,), (0.693679,), "g", 5e-7, "m/s2"),
    Known("four_column/*.txt", "columns", "g", 0.02, (8171,) * 3, (0.0995, 0.1712, 0.0373), "g", 5.1e-5, "g"),
    Known("sac/*.sac", "sac", "m/s2", 0.02, (15001,), (0.00348981,), "g", 5e-9, "m/s2"),
]  # fmt: skip


class Wanted(NamedTuple):
    """What a file that was once refused must give, by what its own header states; half a last digit of the peaks."""

    pattern: str
    format: str
    unit: str
    step: float
    samples: tuple[int, ...]
    peaks: tuple[float, ...] = ()
    digit: float = 0.0
    told: tuple[str | None, float | None] = (None, None)
    doubt: str = ""


WANTED = [
    Wanted("cosmos/*.V2c", "cosmos", "cm/s2", 0.005, (42000,), (6.851512,), 5e-7),
    Wanted("csmip_v1/CICCC.RAW", "csmip-v1", "g", 0.01, (35430, 35402, 35406), (0.567, 0.471, 0.361), 5e-4),
    Wanted("csmip_v1/CE89146.V1", "csmip-v1", "g", 0.005, (13200,) * 3, (0.079, 0.021, 0.045), 5e-4),
    # 59.998 s at 0.002 s; 0.055, 0.015 and 0.043 g
    Wanted("csmip_v1/NEWPORT.RAW", "csmip-v1", "g/10", 0.002, (30000, 29999, 29999), (0.55, 0.15, 0.43), 5e-3,
           doubt="12080 samples at uneven"),
    Wanted("csmip_v2/CHAN14.V2", "csmip-v2", "cm/s2", 0.01, (5696,), (225.09,), 5e-3),
    Wanted("renadic/arica*", "csmip-v1", "g/10", 0.005, (26600,) * 3, (0.52, 0.29, 0.57), 5e-3,
           doubt="the peak at 14.1 s"),
    Wanted("renadic/iqui*", "csmip-v1", "g/10", 0.005, (27600,) * 3, (0.59, 0.50, 0.43), 5e-3,
           doubt="the peak at 10.87 s"),
    Wanted("renadic/papudo*", "csmip-v1", "g/10", 0.005, (17754,) * 3, (2.95, 1.55, 4.21), 5e-3),
    Wanted("peer/*.AT2", "peer", "g", 0.01, (4316,)),
    Wanted("nsmn_turkey/*", "nsmn", "gal", 0.01, (28683,) * 3, (13.200332, 12.163827, 9.840572), 5e-7),
    Wanted("unam/*", "unam", "gal", 0.005, (35600,) * 3, (25.6114, 58.7394, 42.3377), 5e-5),
    Wanted("csmnc_china/ua0001.dat", "csmnc", "cm/s2", 0.005, (12800,), (16.986,), 5e-4),
    Wanted("csmnc_china/ua0002.dat", "csmnc", "cm/s2", 0.005, (12800,), (17.669,), 5e-4),
    Wanted("geonet_v1a/*", "geonet-v1a", "mm/s2", 0.005, (65536,) * 3, (2394.8, 2584.4, 1589.9), 0.05),
    Wanted("itaca_acc/*", "itaca", "m/s2", 0.005, (23000,), (1.5980753e-2,), 5e-10),
    Wanted("bbp/2001-SCE.acc.bbp", "columns", "cm/s2", 0.025, (4096,) * 3),
    Wanted("headerless/BM68elc.acc", "columns", "g", 0.01, (4000,), told=("g", 0.01)),
    Wanted("headerless/H-E12140.dat", "columns", "cm/s2", 0.005, (7802,), told=("cm/s2", 0.005)),
    Wanted("eqsig/*", "eqsig", "m/s2", 0.01, (910,), told=("m/s2", None)),
    # 34.716 s at 0.002 s
    Wanted("usc/*", "usc", "g/10", 0.002, (17359,), doubt="8095 samples at uneven"),
    Wanted("smc_uneven/*", "smc-usgs", "cm/s2", 0.001, (48550,), (228.3932,), 5e-3, doubt="33449 samples at uneven"),
]  # fmt: skip
REFUSED = [
    ("cosmos/*.V0c", r"line 49: the file contains counts of the recorder"),
    ("peer/*.VT2", r"line 3: .* but the header states 'CM/S', a velocity; use the .AT2 file"),
    ("bbp/2001-SCE.vel.bbp", r"accelerations required, but its name contains 'vel', a velocity"),
    ("mseed/segv.mseed", "but has space for 57"),
    ("columns/*.csv", "columns expected, found 0"),
]


@pytest.mark.parametrize("wanted", WANTED, ids=lambda wanted: wanted.pattern)
def test_once_refused_reads_as_its_header_states(shared_records: Path, wanted: Wanted) -> None:
    """Count, step, unit and peak are the header's, by one reader; what it doubts is said and kept."""
    path = _file(shared_records / "refused", wanted.pattern)
    assert {name for name, one in formats().items() if one.recognises(Source.of_path(path))} - {"columns"} <= {
        wanted.format
    }
    record = read_record(path, None, *wanted.told)
    assert record.format == wanted.format
    found = {(part.unit, part.time_step) for part in record.components}
    assert found == {(wanted.unit, wanted.step)}
    assert tuple(part.acceleration.size for part in record.components) == wanted.samples
    for part, peak in zip(record.components, wanted.peaks, strict=bool(wanted.peaks)):
        # and half a digit of the samples
        assert part.peak == pytest.approx(peak, abs=1.15 * wanted.digit, rel=0.0)
    assert wanted.doubt in record.metadata.get("doubts", "")
    assert bool(wanted.doubt) == ("doubts" in record.metadata)


@pytest.mark.parametrize(("pattern", "words"), REFUSED)
def test_once_misread_is_refused_by_what_it_is(shared_records: Path, pattern: str, words: str) -> None:
    """Counts, velocities, damage and what is no record are named, whatever unit the user says."""
    path = _file(shared_records / "refused", pattern)
    for units in (None, "cm/s2"):
        with pytest.raises(RecordError, match=words):
            read_record(path, None, units)


def _file(folder: Path, pattern: str) -> Path:
    (path,) = folder.glob(pattern)
    return path


@pytest.mark.parametrize("known", RECORDS, ids=lambda known: known.pattern)
def test_reads_to_its_listed_peak(shared_records: Path, known: Known) -> None:
    """Recognised as one format; every component has the listed peak, unit, step and samples; a motion is in m/s2."""
    if known.format == "sac":
        pytest.importorskip("obspy")
    path = _file(shared_records, known.pattern)
    names = {name for name, one in formats().items() if one.recognises(Source.of_path(path))}
    assert names - {"columns"} == {known.format} - {"columns"}
    assert names
    record = read_record(path, units=known.units, time_step=known.time_step)
    assert record.format == known.format
    assert {part.unit for part in record.components} == {known.unit}
    assert tuple(part.acceleration.size for part in record.components) == known.samples
    unit = ACCELERATION_UNITS[known.peak_unit]
    for part, peak in zip(record.components, known.peaks, strict=True):
        assert part.time_step == pytest.approx(known.step, rel=1e-12, abs=0.0)
        assert part.peak * ACCELERATION_UNITS[known.unit] / unit == pytest.approx(
            peak, abs=1.001 * known.digit, rel=0.0
        )
    first = record.components[0].name
    motion = read_motion(path, units=known.units, time_step=known.time_step, component=first)
    assert motion.peak == pytest.approx(known.peaks[0] * unit, abs=1.001 * known.digit * unit, rel=0.0)
    assert bool(motion.metadata["header"]) == (known.format != "columns")


def test_names_that_the_files_state(shared_records: Path) -> None:
    """Events, stations and components are those of the description."""
    peer = read_motion(_file(shared_records, "peer/CPM000.AT2"))
    assert (peer.name, peer.metadata["component"]) == ("CAPE MENDOCINO CAPE MENDOCINO", "000")
    v2 = read_record(_file(shared_records, "csmip_v2/*.V2"))
    assert [part.name for part in v2.components] == ["90", "UP", "0"]
    assert v2.metadata["station"] == "PARKFIELD FAULT ZONE 14"
    esm = read_record(_file(shared_records, "esm/*.ASC"))
    assert (esm.components[0].name, esm.metadata["station"]) == ("HNN", "ARS1")


def test_vertical_of_unequal_length(shared_records: Path) -> None:
    """Parkfield's horizontal part has one sample more than its vertical one: both are cut."""
    motion = read_motion(_file(shared_records, "csmip_v2/*.V2"), component="90", vertical="up")
    assert len(motion) == 3250
    assert motion.peak_vertical == pytest.approx(0.94805, abs=5e-6)
    assert any("both cut to 3250" in line for line in motion.provenance)


def test_velocity_file_has_no_unit_of_acceleration(shared_records: Path) -> None:
    """Rinaldi's file holds velocity in cm/s, which no unit of acceleration can say."""
    path = _file(shared_records, "two_column/RSN1063*.txt")
    with pytest.raises(InvalidValueError, match=r"units must be one of .*got 'cm/s'"):
        read_record(path, units="cm/s")
    part = read_record(path, units="cm/s2").components[0]
    assert (part.time_step, part.acceleration.size) == (0.01, 1991)
    assert part.peak == pytest.approx(147.92, abs=5e-3)


def test_counts_need_their_sensitivity(shared_records: Path) -> None:
    """China Lake's counts become 0.343 g by the sensitivity in the StationXML file."""
    pytest.importorskip("obspy")
    source = Source.of_path(_file(shared_records, "mseed/*.mseed"))
    reader = type(formats()["miniseed"]).with_response(_file(shared_records, "stationxml/*.xml"))
    part = reader.read(source).components[0]
    assert (part.unit, part.time_step, part.acceleration.size) == ("m/s2", 0.01, 39001)
    assert part.peak / 9.80665 == pytest.approx(0.343, abs=5e-4, rel=0.0)
