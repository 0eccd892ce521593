"""The response of an instrument, taken out of counts that it made by a closed form."""

import hashlib

import numpy as np
import pytest

from rocking.errors import InvalidValueError, RecordError
from rocking.motions import GroundMotion, processed
from rocking.motions.formats import read_records
from rocking.motions.formats.reader import motions_in

pytestmark = pytest.mark.verifies(room="motions and records")

CORNER = 8.0  # of the first-order low pass that the instrument is [Hz]
GAIN = 4000.0  # counts/(m/s2) at 1 Hz
XML = f"""<?xml version="1.0"?>
<FDSNStationXML xmlns="http://www.fdsn.org/xml/station/1" schemaVersion="1.1">
 <Source>typed</Source><Created>1999-12-31T00:00:00</Created>
 <Network code="XX"><Station code="ABC">
  <Latitude>1.0</Latitude><Longitude>2.0</Longitude><Elevation>3.0</Elevation><Site><Name>Cellar</Name></Site>
  <Channel code="HNE" locationCode="" startDate="1960-01-01T00:00:00">
   <Latitude>1.0</Latitude><Longitude>2.0</Longitude><Elevation>3.0</Elevation><Depth>0.0</Depth>
   <SampleRate>100.0</SampleRate>
   <Response><InstrumentSensitivity><Value>{GAIN}</Value><Frequency>1.0</Frequency>
    <InputUnits><Name>M/S**2</Name></InputUnits><OutputUnits><Name>COUNTS</Name></OutputUnits></InstrumentSensitivity>
    <Stage number="1"><PolesZeros>
      <InputUnits><Name>M/S**2</Name></InputUnits><OutputUnits><Name>COUNTS</Name></OutputUnits>
      <PzTransferFunctionType>LAPLACE (RADIANS/SECOND)</PzTransferFunctionType>
      <NormalizationFactor>{2.0 * np.pi * CORNER * (1.0 + CORNER**-2) ** 0.5}</NormalizationFactor>
      <NormalizationFrequency>1.0</NormalizationFrequency>
      <Pole number="0"><Real>{-2.0 * np.pi * CORNER}</Real><Imaginary>0.0</Imaginary></Pole>
     </PolesZeros><StageGain><Value>{GAIN}</Value><Frequency>1.0</Frequency></StageGain></Stage>
   </Response>
  </Channel></Station></Network>
</FDSNStationXML>
"""


@pytest.mark.verifies("closed form", "a low pass of first order", within="2e-3", control="within")
def test_a_known_response_is_taken_out(tmp_path):
    """What a first-order low pass made of a burst of 5 Hz is the burst again, to 0.2 %; its counts are 10 % off."""
    obspy = pytest.importorskip("obspy")
    time = np.arange(2000) * 0.01
    burst = 3.0 * np.exp(-(((time - 10.0) / 0.8) ** 2)) * np.sin(2.0 * np.pi * 5.0 * (time - 10.0))
    frequencies = np.fft.rfftfreq(4096, 0.01)
    low_pass = GAIN * (1.0 + CORNER**-2) ** 0.5 / (1.0 + 1j * frequencies / CORNER)
    counts = np.fft.irfft(np.fft.rfft(burst, 4096) * low_pass, 4096)[:2000]
    trace = obspy.Trace(np.rint(counts).astype(np.int32))
    trace.stats.update({"network": "XX", "station": "ABC", "channel": "HNE", "delta": 0.01})
    trace.write(str(tmp_path / "counts.mseed"), format="MSEED")
    stations = tmp_path / "station.xml"
    stations.write_text(XML, encoding="utf-8")
    (motion,) = motions_in(tmp_path / "counts.mseed", stations=stations)
    found = processed(motion, [f"response:stations={stations},low=0.2,high=30"])
    # counts are whole, and 12000 stand for the peak
    assert found.acceleration == pytest.approx(burst, abs=2e-3 * 3.0)
    assert motion.acceleration != pytest.approx(burst, abs=0.1 * 3.0)
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
