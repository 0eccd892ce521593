"""The last digits of an engine: which bits it computes, noticed before they are mixed."""

import numpy as np
import pytest

from rocking.campaigns import Campaign, CampaignMismatchError
from rocking.campaigns import identity as fingerprint
from rocking.dynamics.batch import Batch
from rocking.dynamics.mechanics import MECHANICS
from rocking.dynamics.plane import fast_engine

PLANE = next(mechanics for mechanics in MECHANICS if mechanics.name == "plane")
pytestmark = pytest.mark.skipif(not fast_engine.available(), reason="the fast engine was not built")


@pytest.mark.slow
def test_fingerprints_tell_the_bits_apart(make, monkeypatch):
    """Instruction sets with the same results of 3000 histories have the same fingerprint, others another one."""
    work, found = make(3000), {}
    for name in fast_engine.instruction_sets():
        monkeypatch.setenv("ROCKING_ISA", name)
        results = work.run(0, work.count, threads=1)
        found[name] = (b"".join(results[column].tobytes() for column in results), fingerprint.engine_of(work))
    for bits, told in found.values():
        assert [told == other for _, other in found.values()] == [bits == others for others, _ in found.values()]


@pytest.mark.skipif(
    len(fast_engine.instruction_sets() if fast_engine.available() else []) < 2, reason="one instruction set only"
)
def test_another_instruction_set_is_refused(tmp_path, work, monkeypatch):
    """A campaign begun with one set is neither opened nor run with another one, and is finished with the first."""
    monkeypatch.delenv("ROCKING_ISA", raising=False)
    campaign = Campaign.create(tmp_path / "c", work, 50)
    sentence = r"digits: the campaign started with engine fast, \w{16}, this machine has engine fast, \w{16} "
    monkeypatch.setenv("ROCKING_ISA", "plain")
    with pytest.raises(CampaignMismatchError, match=sentence):
        Campaign.open(tmp_path / "c", work)
    with pytest.raises(CampaignMismatchError, match=sentence):
        campaign.run(workers=1)
    monkeypatch.delenv("ROCKING_ISA")
    assert Campaign.open(tmp_path / "c", work).run(workers=1).computed == 6


def test_sample_has_all_outcomes():
    """No uplift, rocking, overturning and refusal are among the histories, under every law, order and equation."""
    outcomes = []
    for mechanics in MECHANICS:
        rows = fingerprint._rows(16, mechanics)
        for motions, law, settings in mechanics.samples(*fingerprint._motions()):
            results = Batch(motions, law, settings, 1, "fast").run(16, rows.part)[0]
            outcomes.append(set(results["outcome"].tolist()))
            assert results["impacts"].max() > 2
    sliding = [{0, 2, 3, 4, 5}, {0, 1, 2, 3, 5}]
    assert outcomes == [*[{0, 1, 2, 3}] * 4, *sliding, {0, 1, 2, 3, 5}]


@pytest.mark.slow
@pytest.mark.parametrize("chosen", ["fast", "reference"])
def test_one_bit_is_seen(chosen, monkeypatch):
    """Negative control: the last bit of one number of one history gives another fingerprint."""
    before = fingerprint._fingerprint.__wrapped__(chosen, "", PLANE)
    assert before == fingerprint._fingerprint.__wrapped__(chosen, "", PLANE)
    run = Batch.run

    def nudged(self, *arguments):
        results, work = run(self, *arguments)
        results["peak_rotation"][1] = np.nextafter(results["peak_rotation"][1], 9.0)
        return results, work

    monkeypatch.setattr(Batch, "run", nudged)
    assert fingerprint._fingerprint.__wrapped__(chosen, "", PLANE) != before
