"""One cabinet, one pulse, three models
====================================

The same cabinet under the same pulse does not overturn with one model and overturns with two others. Only the
coefficient of restitution differs. For new users.
"""

import rocking as rk
from rocking.plots import animate_comparison

# %%
# A cabinet of 0.6 m x 2 m, and one full sine: 7.6 m/s2 for 0.5 s.

cabinet = rk.Block(width=0.6, height=2.0, depth=0.5, density=300.0)
pulse = rk.pulses.sine(amplitude=7.6, period=0.5)
models = {"Housner 1963": "housner", "Horizontal momentum": "horizontal-momentum", "KED, Mao et al. 2024": "ked"}
responses = {}
for name, model in models.items():
    response = rk.simulate(cabinet, pulse, restitution=model)
    responses[f"{name}: r = {response.parameters.right.coefficient:.3f}"] = response
    print(f"{model:20s} {response.outcome.value}")

assert [response.outcome.name for response in responses.values()] == ["ROCKED", "OVERTURNED", "OVERTURNED"]

# %%
# Until the first impact all three responses are equal. Housner's model then has a larger energy loss, and the cabinet
# does not overturn.

title = "The same cabinet, the same pulse, three models of the impact"
animate_comparison(responses, "rocking.gif", title=title, speed=0.8, until=4.0)
