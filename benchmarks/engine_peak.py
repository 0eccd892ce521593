"""Peak floating-point operations per second of a core."""

import ctypes
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from benchmarks.timing import cpu_seconds

# Independent chains of multiply-adds in registers: as many as hide their latency, and few enough to stay there.
SOURCE = """
#if defined(__AVX512F__)
#define BYTES 64
#elif defined(__AVX__)
#define BYTES 32
#else
#define BYTES 16
#endif
typedef double pack __attribute__((vector_size(BYTES)));
enum { CHAINS = 12 };
double spin(long rounds, double factor, double term) {
    pack a[CHAINS], f, t;
    for (int k = 0; k < BYTES / 8; ++k) f[k] = factor, t[k] = term;
    for (int i = 0; i < CHAINS; ++i) a[i] = f + (double)i;
    for (long n = 0; n < rounds; ++n)
#pragma GCC unroll 12
        for (int i = 0; i < CHAINS; ++i) a[i] = a[i] * f + t;
    double sum = 0.0;
    for (int i = 0; i < CHAINS; ++i) for (int k = 0; k < BYTES / 8; ++k) sum += a[i][k];
    return sum;
}
int operations(void) { return 2 * CHAINS * BYTES / 8; }
"""
FLAGS = ("-O3", "-march=native", "-mprefer-vector-width=512", "-ffp-contract=fast", "-shared", "-fPIC")


def spinner(rounds: int = 5_000_000) -> tuple[Callable[[], object], float] | None:
    """Return multiply-adds at full speed, and the operations per call; None without a compiler."""
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if compiler is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        source, built = Path(folder) / "peak.c", Path(folder) / "peak.so"
        source.write_text(SOURCE, encoding="utf-8")
        flags = [flag for flag in FLAGS if sys.platform == "linux" or "vector-width" not in flag]
        done = subprocess.run([compiler, *flags, "-o", built, source], capture_output=True, check=False)
        if done.returncode:
            return None
        library = ctypes.CDLL(str(built))
    library.spin.argtypes, library.spin.restype = (ctypes.c_long, ctypes.c_double, ctypes.c_double), ctypes.c_double
    count = float(library.operations()) * rounds
    return lambda: library.spin(rounds, 0.999999, 1e-6), count


def peak(repeats: int = 7) -> float | None:
    """Float64 operations a second of one core, at best; None if it cannot be measured."""
    loop = spinner()
    if loop is None:
        return None
    work, count = loop
    return max(count / cpu_seconds(work) for _ in range(repeats))


def beside(work: Callable[[], object], repeats: int) -> tuple[float | None, float]:
    """Median peak [operations/s] and median CPU seconds of some work, in turn."""
    loop = spinner()
    work()
    spent, speed = [], []
    for _ in range(repeats):
        spent.append(cpu_seconds(work))
        if loop is not None:
            speed.append(loop[1] / cpu_seconds(loop[0]))
    return statistics.median(speed) if speed else None, statistics.median(spent)
