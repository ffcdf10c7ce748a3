/* Small layer over HDF5: rank 0 owns every file, the others send it their rows. So a full disk or a broken file is one
   rank's to find, and no rank waits for another that has failed.

   An error is kept in the file's `failed` and makes every later call on it do nothing: H5FileFailed tells all ranks. */
#pragma once
#include "fluid/grid.h"
#include <hdf5.h>

typedef struct {
  MPI_Comm comm;
  PetscMPIInt rank;
  hid_t id;         /* rank 0; -1 elsewhere and when not open */
  PetscBool failed; /* rank 0 */
  char path[PETSC_MAX_PATH_LEN];
} H5File;

/* H5FileCreate - new file, truncated. H5FileOpen - existing one, to read or to write on. Collective. */
PETSC_EXTERN PetscErrorCode H5FileCreate(MPI_Comm comm, const char path[], H5File *file);
PETSC_EXTERN PetscErrorCode H5FileOpen(MPI_Comm comm, const char path[], PetscBool write, H5File *file);

/* H5FileFlush - hand everything to the system. H5FileClose - the same, and close; also after a failure. */
PETSC_EXTERN PetscErrorCode H5FileFlush(H5File *file);
PETSC_EXTERN PetscErrorCode H5FileClose(H5File *file);

/* H5FileFailed - whether any call so far has failed; the same on every rank. Collective. */
PETSC_EXTERN PetscErrorCode H5FileFailed(const H5File *file, PetscBool *failed);

/* Attributes of the root group, of more than 8000 numbers datasets of their name: rank 0's values are written; what is
   read goes to every rank. A string that is not
   there is left empty. Reading is collective. */
PETSC_EXTERN PetscErrorCode H5PutReals(H5File *file, const char name[], PetscInt n, const PetscReal values[]);
PETSC_EXTERN PetscErrorCode H5PutInts(H5File *file, const char name[], PetscInt n, const PetscInt values[]);
PETSC_EXTERN PetscErrorCode H5PutString(H5File *file, const char name[], const char value[]);
PETSC_EXTERN PetscErrorCode H5GetReals(H5File *file, const char name[], PetscInt n, PetscReal values[]);
PETSC_EXTERN PetscErrorCode H5GetInts(H5File *file, const char name[], PetscInt n, PetscInt values[]);
PETSC_EXTERN PetscErrorCode H5GetString(H5File *file, const char name[], size_t length, char value[]);

/* H5PutRows - a dataset of its own that does not grow, values[rows][n]: rank 0's. */
PETSC_EXTERN PetscErrorCode H5PutRows(H5File *file, const char name[], PetscInt rows, PetscInt n,
                                      const PetscReal values[]);

/* H5PutText, H5GetText - a string of any length, in several attributes where it is longer than one may be. What is read
   is to be freed with PetscFree; empty when it is not there. Reading is collective. */
PETSC_EXTERN PetscErrorCode H5PutText(H5File *file, const char name[], const char value[]);
PETSC_EXTERN PetscErrorCode H5GetText(H5File *file, const char name[], char **value);

/* H5CreateSeries - dataset [0.., dims...] that grows along its first index; ndims <= 2 further ones. */
PETSC_EXTERN PetscErrorCode H5CreateSeries(H5File *file, const char name[], int ndims, const PetscInt dims[]);

/* H5CreateSingleSeries - the same in single precision; it is written and read as doubles. */
PETSC_EXTERN PetscErrorCode H5CreateSingleSeries(H5File *file, const char name[], int ndims, const PetscInt dims[]);

/* H5SeriesLength - entries of a series. H5TruncateSeries - drop the entries from `length` on. */
PETSC_EXTERN PetscErrorCode H5SeriesLength(H5File *file, const char name[], PetscInt *length);
PETSC_EXTERN PetscErrorCode H5TruncateSeries(H5File *file, const char name[], PetscInt length);

/* H5FramePlace - byte of the file where entry `index` of a series begins, whose entries are chunks; 0 when there is
   none. Rank 0's. */
PETSC_EXTERN unsigned long long H5FramePlace(H5File *file, const char name[], PetscInt index);

/* H5WriteArray, H5ReadArray - entry `index` of a series, n values: rank 0's array is written; every rank gets what is
   read. Writing entry `length` makes the series longer. */
PETSC_EXTERN PetscErrorCode H5WriteArray(H5File *file, const char name[], PetscInt index, PetscInt n,
                                         const PetscReal values[]);
PETSC_EXTERN PetscErrorCode H5ReadArray(H5File *file, const char name[], PetscInt index, PetscInt n,
                                        PetscReal values[]);

/* H5WriteRows, H5ReadRows - the same for `each` numbers in every row of a field of the grid, each rank its own rows.
   H5WriteField, H5ReadField - for the field itself. Collective. */
PETSC_EXTERN PetscErrorCode H5WriteRows(H5File *file, const char name[], PetscInt index, Grid grid, Field field,
                                        PetscInt each, const PetscScalar values[]);
PETSC_EXTERN PetscErrorCode H5ReadRows(H5File *file, const char name[], PetscInt index, Grid grid, Field field,
                                       PetscInt each, PetscScalar values[]);
static inline PetscErrorCode H5WriteField(H5File *file, const char name[], PetscInt index, Grid grid, Field field,
                                          const PetscScalar values[]) {
  return H5WriteRows(file, name, index, grid, field, grid->columns[field], values);
}
static inline PetscErrorCode H5ReadField(H5File *file, const char name[], PetscInt index, Grid grid, Field field,
                                         PetscScalar values[]) {
  return H5ReadRows(file, name, index, grid, field, grid->columns[field], values);
}
