"""Complete response to a pulse
============================

A response contains rotation and velocity at each time, energy, forces, and the accuracy of the model. For engineers who
explain a result.
"""

import numpy as np

import rocking as rk
from rocking.plots import journal_style, new_figure, write
from rocking.plots.style import model_styles

# %%
# A cabinet under one full sine, with three restitution models.

cabinet = rk.Block(width=0.6, height=2.0, depth=0.5, density=300.0)
pulse = rk.pulses.sine(amplitude=7.6, period=0.5)
responses = {
    model: rk.simulate(cabinet, pulse, restitution=model) for model in ("housner", "horizontal-momentum", "ked")
}
for model, response in responses.items():
    r = response.parameters.right.coefficient
    print(f"{model}, r = {r:.3f}: {response.outcome.value}, past no return at {response.overturning_time:.3f} s")
    assert response.energy.closure < 1e-10

assert responses["housner"].outcome is rk.Outcome.ROCKED
assert responses["ked"].outcome is rk.Outcome.OVERTURNED

# %%
# The complete response without overturning in one picture: ground motion, rotation, velocity, energy, and friction
# demand.

print(responses["housner"].summary)
responses["housner"].plot("response_to_a_pulse.png")

# %%
# A response can be evaluated at any time. Therefore the three responses are plotted together.

with journal_style():
    figure, (axes,) = new_figure(6.0, 2.8)
    for model, response in responses.items():
        time = np.linspace(0.0, min(4.0, response.time[-1]), 2000)
        axes.plot(time, response.at(time) / cabinet.slenderness_angle, **model_styles()[model])
    axes.axhline(1.0, color="grey", linewidth=0.8)
    axes.set(xlabel="time [s]", ylabel="rotation / slenderness angle [-]", ylim=(-0.8, 2.2), xlim=(0.0, 4.0))
    axes.legend()
write(figure, "models_decide.png")
