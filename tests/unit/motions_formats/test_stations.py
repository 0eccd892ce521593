"""StationXML files beside counts: by network, station, location, channel and date, in files and in folders."""

import numpy as np
import pytest

from rocking.errors import RecordError
from rocking.motions import processed
from rocking.motions.formats import read_motion, read_records

obspy = pytest.importorskip("obspy")
pytestmark = pytest.mark.verifies(room="motions and records")

CORNER = 8.0  # of the first-order low pass that the instrument is [Hz]


def channel(code="HNE", location="", gain=4000.0, begins="1960-01-01", ends="", unit="M/S**2", counts="COUNTS", dip=0):
    """One channel of a StationXML file: a low pass of first order; gain [counts/unit]."""
    factor = 2.0 * np.pi * CORNER * (1.0 + CORNER**-2) ** 0.5
    names = f"<InputUnits><Name>{unit}</Name></InputUnits><OutputUnits><Name>{counts}</Name></OutputUnits>"
    azimuth = 0.0 if code == "HNN" else 90.0
    until = f' endDate="{ends}T00:00:00"' if ends else ""
    return f"""<Channel code="{code}" locationCode="{location}" startDate="{begins}T00:00:00"{until}>
   <Latitude>1.0</Latitude><Longitude>2.0</Longitude><Elevation>3.0</Elevation><Depth>0.0</Depth>
   <Azimuth>{azimuth}</Azimuth><Dip>{dip}</Dip><SampleRate>100.0</SampleRate>
   <Response><InstrumentSensitivity><Value>{gain}</Value><Frequency>1.0</Frequency>{names}</InstrumentSensitivity>
    <Stage number="1"><PolesZeros>{names}<PzTransferFunctionType>LAPLACE (RADIANS/SECOND)</PzTransferFunctionType>
      <NormalizationFactor>{factor}</NormalizationFactor><NormalizationFrequency>1.0</NormalizationFrequency>
      <Pole number="0"><Real>{-2.0 * np.pi * CORNER}</Real><Imaginary>0.0</Imaginary></Pole>
     </PolesZeros><StageGain><Value>{gain}</Value><Frequency>1.0</Frequency></StageGain></Stage></Response>
  </Channel>"""


def station_xml(*channels, station="ABC"):
    place = (
        "<Latitude>1.0</Latitude><Longitude>2.0</Longitude><Elevation>3.0</Elevation><Site><Name>Cellar</Name></Site>"
    )
    return (
        '<?xml version="1.0"?><FDSNStationXML xmlns="http://www.fdsn.org/xml/station/1" schemaVersion="1.1">'
        "<Source>typed</Source><Created>1999-12-31T00:00:00</Created>"
        f'<Network code="XX"><Station code="{station}">{place}{"".join(channels)}</Station></Network></FDSNStationXML>'
    )


def burst():
    time = np.arange(2000) * 0.01
    return 3.0 * np.exp(-(((time - 10.0) / 0.8) ** 2)) * np.sin(2.0 * np.pi * 5.0 * (time - 10.0))


def write_counts(path, location="", code="HNE", station="ABC", gain=4000.0):
    """The counts that the instrument makes of a burst of 5 Hz; gain [counts/(m/s2)] at 1 Hz."""
    low_pass = gain * (1.0 + CORNER**-2) ** 0.5 / (1.0 + 1j * np.fft.rfftfreq(4096, 0.01) / CORNER)
    counts = np.fft.irfft(np.fft.rfft(burst(), 4096) * low_pass, 4096)[:2000]
    trace = obspy.Trace(np.rint(counts).astype(np.int32))
    about = {"network": "XX", "station": station, "location": location, "channel": code, "delta": 0.01}
    trace.stats.update(about)
    trace.write(str(path), format="MSEED")
    return path


def with_response_out(path, stations):
    return processed(read_motion(path, stations=stations), [f"response:stations={stations},low=0.2,high=30"])


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
        ((channel(location="10"), channel(location="20")), r"XX\.ABC\.\.HNE .*; they describe location 10"),
        ((channel(ends="1969-01-01"),), "do not describe this channel; they describe location blank, 1960"),
        ((channel(), channel(gain=17.0)), "2 different descriptions in a.xml"),
        ((channel(), channel(dip=-90)), "2 different descriptions in a.xml"),  # level, and vertical
        ((channel(unit="M/S"),), "sensitivity from M/S.*2 to counts needed, found M/S to COUNTS"),
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


def test_counts_without_a_name_are_doubted(tmp_path):
    """M/S**2 to NONE, as some networks had it, is read as counts, with a doubt."""
    path = write_counts(tmp_path / "a.mseed")
    (tmp_path / "a.xml").write_text(station_xml(channel(counts="NONE")), "utf-8")
    with pytest.warns(UserWarning, match="sensitivity to NONE, taken as counts"):
        found = with_response_out(path, tmp_path / "a.xml")
    assert found.acceleration == pytest.approx(burst(), abs=2e-3 * 3.0)


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
    assert "by XX.DEF.xml, SHA-256 " in printed("motion", tmp_path / "XX.DEF..HNE.mseed", "--set", step)


def test_a_sensor_that_stands_upside_down(tmp_path):
    """A dip of +90 degrees points down: the record is turned up."""
    for code in ("HNE", "HNZ"):
        write_counts(tmp_path / f"XX.ABC..{code}.mseed", "", code)
    (tmp_path / "s.xml").write_text(station_xml(channel("HNE"), channel("HNZ", dip=90)), "utf-8")
    (record,) = read_records(tmp_path)
    assert record.z.acceleration == pytest.approx(-record.x.acceleration)


def test_cases_with_stations(case_records):
    """The same counts give the same motion by each description, and both stations of the folder are read."""
    step = "response:stations={},low=0.2,high=30"
    found = []
    for name in ("good", "two_locations"):
        path = case_records / f"stationxml_{name}.xml"
        found.append(processed(read_motion(case_records / "counts.mseed", stations=path), step.format(path)))
    assert found[0].acceleration.tolist() == found[1].acceleration.tolist()
    with pytest.warns(UserWarning, match="taken as counts"):
        read_motion(case_records / "counts.mseed", stations=case_records / "stationxml_output_none.xml")
    records = read_records(case_records / "fdsn_folder")
    assert len(records) == 2
    assert not records.left_out
    assert all(part is not None for record in records for part in record.parts)
