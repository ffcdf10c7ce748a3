/* Small layer over parallel HDF5: files that all ranks open, arrays that one rank writes, fields that all write. */
#pragma once
#include "fluid/grid.h"
#include <hdf5.h>

/* H5Check - stop with one line naming the file when an HDF5 call fails (full disk, vanished folder). */
#define H5Check(call, comm, path)                                                                                      \
  PetscCheck((call) >= 0, comm, PETSC_ERR_USER_INPUT,                                                                  \
             "%s: cannot be written; allowed: a folder with space that can be written", path)

/* H5Create - new file, truncated, open on all ranks. H5Close flushes it. Collective. */
PETSC_EXTERN PetscErrorCode H5Create(MPI_Comm comm, const char path[], hid_t *file);
PETSC_EXTERN PetscErrorCode H5Close(MPI_Comm comm, const char path[], hid_t *file);

/* Attributes of the root group. Collective. */
PETSC_EXTERN PetscErrorCode H5PutReals(hid_t file, const char name[], PetscInt n, const PetscReal values[]);
PETSC_EXTERN PetscErrorCode H5PutInts(hid_t file, const char name[], PetscInt n, const PetscInt values[]);
PETSC_EXTERN PetscErrorCode H5PutString(hid_t file, const char name[], const char value[]);

/* H5CreateSeries - dataset [0.., dims...] that grows along its first index; ndims <= 2 further ones. chunk_rows: rows
   of a chunk along dims[0] (0: all). */
PETSC_EXTERN PetscErrorCode H5CreateSeries(hid_t file, const char name[], int ndims, const PetscInt dims[],
                                           PetscInt chunk_rows);

/* H5AppendArray - write entry `index` of a series from rank 0's array (the whole entry). Collective. */
PETSC_EXTERN PetscErrorCode H5AppendArray(MPI_Comm comm, hid_t file, const char name[], PetscInt index,
                                          const PetscReal values[]);

/* H5AppendRows - write entry `index` of a series [T,rows,columns], each rank its rows first .. first + rows - 1. */
PETSC_EXTERN PetscErrorCode H5AppendRows(hid_t file, const char name[], PetscInt index, PetscInt first, PetscInt rows,
                                         const PetscReal values[]);
