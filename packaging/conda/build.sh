#!/usr/bin/env bash
# What rattler-build runs: conda's compiler, MPI and HDF5 (which has no file for pkg-config), for any processor of this kind.
set -euo pipefail
export PKG_CONFIG_PATH="$PREFIX/lib/pkgconfig"
modules="PETSc fftw3 muparser"
# shellcheck disable=SC2086 # words
libraries="$(pkg-config --libs $modules) -L$PREFIX/lib -lhdf5 -lfftw3_mpi -lm"
words=(ARCH= CC="$PREFIX/bin/mpicc" PYTHON="$PYTHON" MODULES="$modules" LIBS="$libraries" PREFIX="$PREFIX" PYTHON_DIR="$SP_DIR")
make -j"${CPU_COUNT:-2}" "${words[@]}"
make install "${words[@]}"
