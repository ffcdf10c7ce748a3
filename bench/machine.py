"""What the measurements were made on: no names, no paths."""

from __future__ import annotations

import os
import re
import subprocess

from petves.program import command


def _output(*command: str) -> str:
    try:
        return subprocess.run(command, capture_output=True, text=True).stdout
    except OSError:
        return ""


def _package(name: str) -> str:
    """Return the upstream version of a Debian package."""
    version = _output("dpkg-query", "-W", "-f", "${Version}", name)
    return re.split(r"[+~-]", re.sub(r"^\d+:", "", version))[0] or "unknown"


def _blas() -> str:
    """Return the library behind libblas.so.3."""
    target = _output("readlink", "-f", _output("sh", "-c", "ldconfig -p | grep -m1 -o '/.*libblas.so.3'").strip())
    return f"OpenBLAS {_package('libopenblas0-serial')}" if "openblas" in target else "reference BLAS"


def _processor() -> str:
    """Return the compiler's option for the processor that petves was built for."""
    option = re.search(r" -m\w+=\S+", _output(*command(), "-version"))
    return option[0] if option else ""


def machine() -> dict[str, str]:
    """Return the processor, its caches, memory, compiler and libraries."""
    cpu = dict(re.findall(r"^([^:\n]+):\s+(.*)$", _output("lscpu"), re.MULTILINE))
    memory = re.search(r"MemTotal:\s+(\d+)", open("/proc/meminfo").read())
    family = "/".join(cpu.get(key, "?") for key in ("CPU family", "Model", "Stepping"))
    vectors = [name for name in ("avx2", "avx512f") if name in cpu.get("Flags", "").split()]
    return {
        "processor": f"{cpu.get('Model name', 'unknown')} (family/model/stepping {family}; {', '.join(vectors)})",
        "virtual": cpu.get("Hypervisor vendor", "no"),
        "cores": cpu.get("CPU(s)", "?"),
        "caches": ", ".join(f"{key} {cpu[key + ' cache']}" for key in ("L1d", "L2", "L3") if key + " cache" in cpu),
        "memory": f"{int(memory[1]) / 2**20:.0f} GiB" if memory else "unknown",
        "compiler": _output("gcc", "--version").split("\n")[0] + ", -O3" + _processor(),
        "PETSc": re.sub(r"^.*?(\d+\.\d+\.\d+).*$", r"\1", _output("pkg-config", "--modversion", "PETSc").strip()),
        "FFTW": _output("pkg-config", "--modversion", "fftw3").strip(),
        "BLAS": _blas(),
        "MPI": (_output("mpirun", "--version").split("\n")[0]).replace("mpirun ", ""),
        "load when it began": f"{os.getloadavg()[0]:.2f} (one minute, of all processes)",
    }
