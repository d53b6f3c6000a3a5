"""The compiled kernel; everything else is in pyproject.toml.

It is optional: without a compiler the package installs all the same, and numpy does the work.
"""

from pathlib import Path

from setuptools import Extension, setup

SOURCE = Path("ribbonopt") / "kernel" / "source"

setup(
    ext_modules=[
        Extension(
            "ribbonopt.kernel._compiled",
            sorted(path.as_posix() for path in SOURCE.glob("*.c")),
            depends=sorted(path.as_posix() for path in SOURCE.glob("*.h")),
            # No -ffast-math: it would make every process that loads the kernel flush denormals.
            extra_compile_args=["-O3", "-std=c11"],
            optional=True,
        )
    ]
)
