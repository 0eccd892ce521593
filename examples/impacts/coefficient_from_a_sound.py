"""Coefficient of restitution from a sound
=======================================

A block is tilted, released and recorded with a phone. The sound gives the coefficient of restitution with an interval.
In this example the block rocks on a contact bed with a known coefficient. For users who can test a body.
"""

from pathlib import Path

import numpy as np
from scipy.io import wavfile
from scipy.signal import fftconvolve

import rocking as rk
from rocking.identification import identify, read_measurement
from rocking.restitution.bed import ContactBed, KelvinVoigt, bed_free_rocking

# %%
# A block of 10 cm by 40 cm with a slightly hollow base has two contact points. Released from half of its slenderness
# angle, it has these contact times.

block = rk.Block(width=0.1, height=0.4, density=2400.0)
law = KelvinVoigt(block.mass * (2.0 * np.pi * 1500.0) ** 2, damping_ratio=1.0)
rocked = bed_free_rocking(block, ContactBed.uniform(block, 2, law), rotation=0.5 * block.slenderness_angle, peaks=12)
own = float(np.exp(np.log(rocked.coefficients[1:]).mean()))
print("touches [s]", rocked.touches[:5].round(3), "... r of the bed", round(own, 4))

# %%
# Its sound: each contact excites modes of the block, with an amplitude that increases with the landing speed. There
# are reverberation, noise, and mains hum at 50 Hz.

RATE = 44_100
random = np.random.default_rng(3)
time = np.arange(int((rocked.touches[-1] + 2.0) * RATE)) / RATE
sound = np.zeros(time.size)
for touch, loud in zip(rocked.touches + 1.0, np.cumprod(rocked.coefficients), strict=True):
    since = np.maximum(time - touch, 0.0)
    for frequency, decay in ((710.0, 90.0), (1630.0, 160.0), (3900.0, 400.0)):
        sound += loud * np.exp(-decay * since) * np.sin(2.0 * np.pi * frequency * since)
echoes = random.normal(size=RATE // 4) * np.exp(-25.0 * np.arange(RATE // 4) / RATE) * 0.02
echoes[0] = 1.0
sound = fftconvolve(sound, echoes)[: time.size]
sound += 0.01 * random.normal(size=time.size) + 0.02 * np.sin(2.0 * np.pi * 50.0 * time)
wavfile.write("block.wav", RATE, (32000.0 * sound / np.abs(sound).max()).astype(np.int16))

# %%
# The recording is read and evaluated. The uncertainty of the body size is 1 %, and of the level of the floor 0.3
# degrees. The tilt of the floor causes nearly the complete interval of the left and right values.

found = identify(read_measurement("block.wav"), block)
print(found)
assert found.mean.low < own < found.mean.high < found.mean.low + 0.005
assert len(found.impacts) == rocked.touches.size - 2
found.plot("coefficient_from_a_sound.png")

# %%
# Housner's model is closest, because its impulse is at the edge. The law for simulations contains the scatter and the
# uncertainty of the measurement.

print("closest model", found.models[0].model, round(found.models[0].coefficient, 4))
assert found.models[0].model == "housner"
pulse = rk.pulses.sine(amplitude=4.0, period=0.2)
print(rk.simulate(block, pulse, restitution=found.law(seed=1)).outcome.value)
Path("block.wav").unlink()
