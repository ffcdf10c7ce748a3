"""pip install ./python: the package takes along the scenes, and the libpetves.so that make has built beside it."""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

ROOT = Path(__file__).resolve().parent.parent
LIBRARY = ROOT / "lib" / "libpetves.so"


class WithLibrary(build_py):
    """Copy scenes into the package, and the library when it has been built; else it is where make install put it."""

    def run(self) -> None:
        super().run()
        if (ROOT / "runs").is_dir():
            shutil.copytree(ROOT / "runs", Path(self.build_lib) / "petves" / "runs", dirs_exist_ok=True)
        if LIBRARY.is_file():
            shutil.copy2(LIBRARY, Path(self.build_lib) / "petves")


setup(cmdclass={"build_py": WithLibrary})
