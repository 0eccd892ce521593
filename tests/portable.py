"""Settings under which one machine computes as others do, and the tests under each of them.

OpenBLAS picks its kernels by the processor, numpy some of its functions, the compiled engines their instruction set,
and the C library its versions with fused multiply-add; each can be told to do as on another processor.
``python tests/portable.py [arguments of pytest]`` runs the tests once under each.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

_FEATURES = """
import json
from numpy._core import _multiarray_umath as n
print(json.dumps([f for f in n.__cpu_dispatch__ if n.__cpu_features__.get(f)]))
"""
_ENGINES = """
from rocking.dynamics.plane import fast_engine
print(*(fast_engine.instruction_sets() if fast_engine.available() else []))
"""


def settings() -> dict[str, dict[str, str]]:
    """Environment variables by the name of the setting; none of them where this processor cannot do as that one."""
    # numpy warns of features that it has no code for or the processor lacks; what is listed here it has
    features = json.loads(_said(_FEATURES))
    wide = [f for f in features if "AVX512" in f or f == "X86_V4"]
    fused = "FMA3" in features or "X86_V3" in features
    found = {
        "OpenBLAS of AVX-512": {"OPENBLAS_CORETYPE": "SkylakeX" if wide else ""},
        "OpenBLAS of AVX2": {"OPENBLAS_CORETYPE": "Haswell" if fused else "", "ROCKING_ISA": "avx2"},
        "OpenBLAS of AVX": {"OPENBLAS_CORETYPE": "Sandybridge"},
        "OpenBLAS of SSE3, plain engines": {"OPENBLAS_CORETYPE": "Prescott", "ROCKING_ISA": "plain"},
        "Zen: OpenBLAS and numpy without AVX-512": {
            "OPENBLAS_CORETYPE": "Zen" if fused else "", "NPY_DISABLE_CPU_FEATURES": " ".join(wide),
        },
        "numpy of the least processor": {"NPY_DISABLE_CPU_FEATURES": " ".join(features)},
        "C library without fused multiply-add": {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F"},
    }  # fmt: skip
    known = _said(_ENGINES).split()
    return {
        name: kept
        for name, given in found.items()
        if (kept := {key: value for key, value in given.items() if value and (key != "ROCKING_ISA" or value in known)})
    }


def _said(program: str) -> str:
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout


def main(arguments: list[str]) -> int:
    """Run pytest under every setting; the number of settings under which something failed."""
    failed = []
    for name, variables in settings().items():
        if not variables:
            print(f"== {name}: skipped, this processor cannot do as that one", flush=True)
            continue
        print(f"== {name}: {variables}", flush=True)
        command = [sys.executable, "-m", "pytest", *arguments]
        if subprocess.run(command, env=os.environ | variables, cwd=Path(__file__).parents[1], check=False).returncode:
            failed.append(name)
    print("failed: " + ", ".join(failed) if failed else "passed under every setting")
    return len(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
