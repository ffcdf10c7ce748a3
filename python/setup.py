"""pip install ./python: the package takes along the libpetves.so that make has built beside it."""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

LIBRARY = Path(__file__).resolve().parent.parent / "lib" / "libpetves.so"


class WithLibrary(build_py):
    """Copy the library into the package when it has been built; else it is looked for where make install put it."""

    def run(self) -> None:
        super().run()
        if LIBRARY.is_file():
            shutil.copy2(LIBRARY, Path(self.build_lib) / "petves")


setup(cmdclass={"build_py": WithLibrary})
