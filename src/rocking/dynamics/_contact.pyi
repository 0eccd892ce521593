from rocking.conventions import FloatArray, IntArray

class Library:
    def __init__(self, data: FloatArray, places: IntArray, steps: FloatArray) -> None: ...
    def run(
        self,
        numbers: FloatArray,
        choices: IntArray,
        results: FloatArray,
        counts: IntArray,
        gravity: float,
        rest_speed: float,
        tolerance: float,
        most_events: int,
        threads: int,
    ) -> None: ...

def slide(bodies: FloatArray, push: FloatArray, lift: FloatArray, states: FloatArray, gravity: float) -> None: ...
