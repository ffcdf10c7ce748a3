#!/usr/bin/env bash
# What rattler-build runs: conda's compiler, MPI and HDF5, for any processor of this kind.
set -euo pipefail
export PKG_CONFIG_PATH="$PREFIX/lib/pkgconfig"
words=(ARCH= CC="$PREFIX/bin/mpicc" PYTHON="$PYTHON" MODULES="PETSc hdf5 fftw3 muparser" PREFIX="$PREFIX" PYTHON_DIR="$SP_DIR")
make -j"${CPU_COUNT:-2}" "${words[@]}"
make install "${words[@]}"
