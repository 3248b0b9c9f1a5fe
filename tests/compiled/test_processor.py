"""Vectors of 512 bits are used where the processor has them, unless somebody chose otherwise."""

import os
import subprocess
import sys

import pytest
from llvmlite import binding

WIDE = binding.get_host_cpu_features().get("avx512f", False)

BEFORE = "import numba\n@numba.njit\ndef f(x): return x\n"
IMPORT = "import mesa_mobility.compiled\n"
SHOW = (
    "from numba import config\n"
    "from mesa_mobility.compiled.processor import is_chosen\n"
    "print((config.CPU_FEATURES or '').endswith('-prefer-256-bit'), is_chosen())"
)


@pytest.mark.parametrize(
    ("code", "environment", "wide", "chosen"),
    [
        (IMPORT, {}, WIDE, False),
        (BEFORE + IMPORT, {}, False, False),
        (IMPORT, {"NUMBA_CPU_NAME": "generic"}, False, True),
        (IMPORT, {"NUMBA_CPU_FEATURES": "+sse2"}, False, True),
    ],
    ids=["usual", "after other code of Numba", "other processor", "other features"],
)
def test_vectors_are_as_wide_as_the_processor_has_them(code, environment, wide, chosen):
    clean = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA_CPU")}
    done = subprocess.run(
        [sys.executable, "-c", code + SHOW],
        env={**clean, **environment},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.split() == [str(wide), str(chosen)]
