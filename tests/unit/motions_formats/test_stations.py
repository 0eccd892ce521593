"""StationXML files beside counts: by network, station, location, channel and date, in files and in folders."""

import hashlib

import pytest
from station_files import burst, channel, station_xml, write_counts

from rocking.errors import InvalidValueError, RecordError
from rocking.motions import GroundMotion, processed
from rocking.motions.formats import read_motion, read_records
from rocking.motions.formats.reader import motions_in

obspy = pytest.importorskip("obspy")
pytestmark = pytest.mark.verifies(room="motions and records")


def with_response_out(path, stations):
    return processed(read_motion(path, stations=stations), [f"response:stations={stations},low=0.2,high=30"])


@pytest.mark.slow
@pytest.mark.verifies("closed form", "a low pass of first order", within="2e-3", control="within")
@pytest.mark.parametrize(
    "channels",
    [
        (channel(), channel(location="2C", gain=17.0)),
        (channel(location="--"), channel(location="10", gain=17.0)),
        (channel(ends="1969-01-01", gain=17.0), channel(begins="1969-01-02")),
        (channel(unit="NM/S**2", gain=4000e-9),),
        (channel(unit="cm/s^2", gain=40.0),),
        (channel(unit="M/S/S"),),
        (channel(counts="counts"),),
        (channel(), channel()),
    ],
    ids=["location", "blank location", "date", "nm", "cm", "m/s/s", "counts", "twice"],
)
def test_the_channel_of_the_record_is_taken(tmp_path, channels):
    """By location and date, in whatever unit: the burst comes back to 0.2 %; the sensitivity alone is 10 % off."""
    path = write_counts(tmp_path / "a.mseed")
    (tmp_path / "a.xml").write_text(station_xml(*channels), "utf-8")
    found = with_response_out(path, tmp_path / "a.xml")
    assert found.acceleration == pytest.approx(burst(), abs=2e-3 * 3.0)
    assert read_motion(path, stations=tmp_path / "a.xml").acceleration != pytest.approx(burst(), abs=0.1 * 3.0)


@pytest.mark.parametrize(
    ("channels", "message"),
    [
        ((channel(location="10"), channel(location="20")), r"XX\.ABC\.\.HNE .*, only location 10"),
        ((channel(ends="1969-01-01"),), "do not describe this channel, only location blank, 1960"),
        ((channel(), channel(gain=17.0)), "2 different descriptions in a.xml"),
        ((channel(), channel(dip=-90)), "2 different descriptions in a.xml"),  # level, and vertical
        ((channel(unit="M/S"),), "sensitivity from M/S.*2 to counts required, found M/S to COUNTS"),
        ((channel(counts="V"),), "found M/S.*2 to V"),
        ((channel(code="HNN"),), "do not describe this channel"),
    ],
)
def test_no_other_channel_is_taken(tmp_path, channels, message):
    """Another location, date, unit or channel is refused by what the file describes, with the response and without."""
    path = write_counts(tmp_path / "a.mseed")
    (tmp_path / "a.xml").write_text(station_xml(*channels), "utf-8")
    with pytest.raises(RecordError, match=message):
        read_motion(path, stations=tmp_path / "a.xml")


@pytest.mark.slow
def test_counts_without_a_name_are_doubted(tmp_path):
    """M/S**2 to NONE, as some networks had it, is read as counts, with a doubt."""
    path = write_counts(tmp_path / "a.mseed")
    (tmp_path / "a.xml").write_text(station_xml(channel(counts="NONE")), "utf-8")
    with pytest.warns(UserWarning, match="sensitivity is NONE in the StationXML; counts are assumed"):
        found = with_response_out(path, tmp_path / "a.xml")
    assert found.acceleration == pytest.approx(burst(), abs=2e-3 * 3.0)


@pytest.mark.slow
def test_a_folder_as_data_centres_deliver_it(tmp_path, printed):
    """Each station has its own XML beside its files: one folder is read as it is, and its response taken out."""
    for station, gain in (("ABC", 4000.0), ("DEF", 900.0)):
        for code in ("HNE", "HNN", "HNZ"):
            write_counts(tmp_path / f"XX.{station}..{code}.mseed", "", code, station, gain)
        rows = [channel("HNE", gain=gain), channel("HNN", gain=gain), channel("HNZ", gain=gain, dip=-90)]
        (tmp_path / f"XX.{station}.xml").write_text(station_xml(*rows, station=station), "utf-8")
    found = read_records(tmp_path)
    assert not found.left_out
    assert [record.x.metadata["station"] for record in found] == ["ABC", "DEF"]
    for record in found:
        assert all(part is not None for part in record.parts)
        taken_out = processed(record, [f"response:stations={tmp_path},low=0.2,high=30"])
        for part in taken_out.parts:
            assert part.acceleration == pytest.approx(burst(), abs=3e-3 * 3.0)  # 900 counts/(m/s2) round to 0.1 %
    step = f"motion.process=response:stations={tmp_path},low=0.2,high=30"
    assert "by XX.DEF.xml, SHA-256 " in printed("record", "show", tmp_path / "XX.DEF..HNE.mseed", "--set", step)


def test_a_sensor_that_stands_upside_down(tmp_path):
    """A dip of +90 degrees points down: the record is turned up."""
    for code in ("HNE", "HNZ"):
        write_counts(tmp_path / f"XX.ABC..{code}.mseed", "", code)
    (tmp_path / "s.xml").write_text(station_xml(channel("HNE"), channel("HNZ", dip=90)), "utf-8")
    (record,) = read_records(tmp_path)
    assert record.z.acceleration == pytest.approx(-record.x.acceleration)


@pytest.mark.slow
def test_cases_with_stations(case_records):
    """The same counts give the same motion by each description, and both stations of the folder are read."""
    step = "response:stations={},low=0.2,high=30"
    found = []
    for name in ("good", "two_locations"):
        path = case_records / f"stationxml_{name}.xml"
        found.append(processed(read_motion(case_records / "counts.mseed", stations=path), step.format(path)))
    assert found[0].acceleration.tolist() == found[1].acceleration.tolist()
    with pytest.warns(UserWarning, match="counts are assumed"):
        read_motion(case_records / "counts.mseed", stations=case_records / "stationxml_output_none.xml")
    records = read_records(case_records / "fdsn_folder")
    assert len(records) == 2
    assert not records.left_out
    assert all(part is not None for record in records for part in record.parts)


@pytest.mark.slow
@pytest.mark.verifies("closed form", "a low pass of first order", within="2e-3", control="within")
def test_a_known_response_is_taken_out(tmp_path):
    """What a first-order low pass made of a burst of 5 Hz is the burst again, to 0.2 %; its counts are 10 % off."""
    stations = tmp_path / "station.xml"
    stations.write_text(station_xml(channel()), encoding="utf-8")
    write_counts(tmp_path / "counts.mseed")
    (motion,) = motions_in(tmp_path / "counts.mseed", stations=stations)
    found = processed(motion, [f"response:stations={stations},low=0.2,high=30"])
    # counts are whole, and 12000 stand for the peak
    assert found.acceleration == pytest.approx(burst(), abs=2e-3 * 3.0)
    assert motion.acceleration != pytest.approx(burst(), abs=0.1 * 3.0)
    digest = hashlib.sha256(stations.read_bytes()).hexdigest()
    assert found.provenance[-1].startswith(f"response of the instrument by station.xml, SHA-256 {digest} removed")
    (in_set,) = read_records(tmp_path / "*.mseed", stations=stations)  # as a set of one, which needs it as well
    assert in_set.x.acceleration.tolist() == motion.acceleration.tolist()
    with pytest.raises(RecordError, match="counts"):
        read_records(tmp_path / "*.mseed")
    for words, message in (("low=0.2,high=45", "high must be"), ("low=0,high=20", "low must be")):
        with pytest.raises(InvalidValueError, match=message):
            processed(motion, [f"response:stations={stations},{words}"])
    with pytest.raises(InvalidValueError, match="counts of a recorder"):
        processed(GroundMotion([0.0, 1.0], 0.01), [f"response:stations={stations}"])
