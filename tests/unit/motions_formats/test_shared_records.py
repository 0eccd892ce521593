"""Real records, where they are at hand: peak, unit, step and number of samples are those of their description."""

from pathlib import Path
from typing import NamedTuple

import pytest

from rocking.conventions import ACCELERATION_UNITS
from rocking.errors import InvalidValueError
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
