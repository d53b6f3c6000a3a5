"""The compiled kernel; everything else is in pyproject.toml.

It is optional: without a compiler the package installs all the same, and numpy does the work.
"""

from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = Path("ribbonopt") / "kernel" / "source"
# No -ffast-math: it would make every process that loads the kernel flush denormals.
FLAGS = {"msvc": ["/O2", "/std:c11"]}
OTHERS = ["-O3", "-std=c11", "-fvisibility=hidden"]


class Build(build_ext):
    """Compiles with the flags that the compiler knows."""

    def build_extension(self, ext: Extension) -> None:
        """Build one extension."""
        ext.extra_compile_args = FLAGS.get(self.compiler.compiler_type, OTHERS)
        super().build_extension(ext)


setup(
    cmdclass={"build_ext": Build},
    ext_modules=[
        Extension(
            "ribbonopt.kernel._compiled",
            sorted(path.as_posix() for path in SOURCE.glob("*.c")),
            depends=sorted(path.as_posix() for path in SOURCE.glob("*.h")),
            optional=True,
        )
    ],
)
