"""Response to a pulse
===================

A cabinet under one sine pulse: the choice of the restitution model decides whether it overturns.
"""

from pathlib import Path

import numpy as np

import rocking as rk
from rocking.plots import response_picture, write
from rocking.plots.style import new_figure

cabinet = rk.Block(width=0.6, height=2.0, depth=0.5, density=300.0)
pulse = rk.pulses.sine(amplitude=7.6, period=0.5)
responses = {
    model: rk.simulate(cabinet, pulse, restitution=model) for model in ("housner", "horizontal-momentum", "ked")
}

figure, (axis,) = new_figure(6.5, 3.2)
for (model, response), style in zip(responses.items(), ("-", "-.", "--"), strict=True):
    r = response.parameters.right.coefficient
    time = np.linspace(0.0, min(4.0, response.time[-1]), 2000)
    axis.plot(time, response.at(time) / cabinet.slenderness_angle, style, label=f"{model}, r = {r:.3f}")
    print(f"{model:20s} r = {r:.3f}: {response.summary}")
    assert response.energy.closure < 1e-10
axis.axhline(1.0, color="grey", linewidth=0.8)
axis.set(xlabel="time [s]", ylabel="rotation / slenderness angle [-]", ylim=(-0.8, 2.2), xlim=(0.0, 4.0))
axis.set_title(f"Cabinet of 0.6 m x 2 m, {pulse.name}", loc="left", fontsize=9)
axis.legend(fontsize=8)

assert responses["housner"].outcome is rk.Outcome.ROCKED
assert responses["ked"].outcome is rk.Outcome.OVERTURNED
folder = Path("gallery-output")
folder.mkdir(exist_ok=True)
write(figure, folder / "models_decide.png")
write(response_picture(responses["housner"]), folder / "response_to_a_pulse.png")
