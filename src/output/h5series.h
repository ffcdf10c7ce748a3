/* Series in an HDF5 file: datasets [entries, ..] that grow by one entry at a time.

   An entry has one chunk, which never moves in the file. Rank 0 writes and reads the file. Of a field on the grid every
   rank sends or receives its own rows, rank by rank, so that rank 0 holds one slab besides its own. What is read goes
   to every rank in one broadcast. */
#pragma once
#include "output/h5.h"

/* H5CreateSeries - an empty series of entries [dims[0]][dims[1]], [dims[0]] (ndims 1) or one number (ndims 0), in
   single or double precision in the file. Values are doubles in either case when they are written and read. Not
   collective. */
PETSC_EXTERN void H5CreateSeries(H5File *file, const char name[], PetscBool single, int ndims, const PetscInt dims[]);

/* H5SeriesLength - number of entries; collective. H5TruncateSeries - remove the entries from `length` on; not
   collective. */
PETSC_EXTERN PetscErrorCode H5SeriesLength(H5File *file, const char name[], PetscInt *length);
PETSC_EXTERN void H5TruncateSeries(H5File *file, const char name[], PetscInt length);

/* H5EntryPlace - byte of the file at which entry `index` begins; 0 when there is no such entry. HDF5 finds the entry by
   its tree; without the driver of h5.h it goes through all entries before it. Rank 0's. */
PETSC_EXTERN unsigned long long H5EntryPlace(H5File *file, const char name[], PetscInt index);

/* H5CheckEntry - the file fails unless the series has one entry of these dims, stored in the file itself and without
   filters, as H5CreateSeries makes it. Rank 0's. */
PETSC_EXTERN void H5CheckEntry(H5File *file, const char name[], int ndims, const PetscInt dims[]);

/* H5WriteArray, H5ReadArray - the n values of entry `index`: rank 0's array is written, every rank gets what is read.
   Writing the entry behind the last makes the series longer. Reading is collective. */
PETSC_EXTERN void H5WriteArray(H5File *file, const char name[], PetscInt index, PetscInt n, const PetscReal values[]);
PETSC_EXTERN PetscErrorCode H5ReadArray(H5File *file, const char name[], PetscInt index, PetscInt n,
                                        PetscReal values[]);

/* H5TransferRows - write or read an entry of a series with `each` numbers in every row of a field of the grid: a rank
   has the values of its own rows. Collective. */
typedef struct {
  const char *name; /* path of the series in the file */
  PetscInt index;
} H5Entry;
PETSC_EXTERN PetscErrorCode H5TransferRows(H5File *file, PetscBool write, const H5Entry *entry, Grid grid, Field field,
                                           PetscInt each, PetscScalar values[]);
