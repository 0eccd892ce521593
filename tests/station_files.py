"""StationXML files and the counts that their instruments make: ``from station_files import channel, station_xml``."""

import numpy as np
import pytest

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
    obspy = pytest.importorskip("obspy")
    trace = obspy.Trace(np.rint(counts).astype(np.int32))
    about = {"network": "XX", "station": station, "location": location, "channel": code, "delta": 0.01}
    trace.stats.update(about)
    trace.write(str(path), format="MSEED")
    return path
