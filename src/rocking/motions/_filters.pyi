from typing import Any

def exponentials(x: Any, out: Any) -> None: ...
def logarithms(x: Any, out: Any) -> None: ...
def cosines_sines(x: Any, cosine: Any, sine: Any) -> None: ...
def recurrence(m00: float, m01: float, m10: float, m11: float, first: Any, second: Any, z: Any, v: Any) -> None: ...
def resonances(
    noise: Any,
    omega: Any,
    place: Any,
    shared: bool,
    cosine: Any,
    sine: Any,
    lasting: Any,
    total: Any,
    variance: Any,
) -> None: ...
