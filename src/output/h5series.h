/* Series in an HDF5 file: datasets [entries, ..] that grow by one entry at a time.

   An entry has one chunk, which never moves in the file. Rank 0 writes and reads the file. */
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

/* H5BeginEntry - a series of one entry of these dims: made, or found in the file. The file fails unless the series that
   is found has one entry of these dims, stored in the file itself and without filters, as H5CreateSeries makes it. Not
   collective. */
PETSC_EXTERN void H5BeginEntry(H5File *file, PetscBool write, const char name[], int ndims, const PetscInt dims[]);

/* H5Transfer - write or read the n values of entry `index` on rank 0; a series whose entries have another size makes
   the file fail. Writing the entry behind the last makes the series longer. Not collective. H5ReadArray - every rank
   gets what is read; collective. */
PETSC_EXTERN void H5Transfer(H5File *file, PetscBool write, const char name[], PetscInt index, PetscInt n,
                             PetscReal values[]);
PETSC_EXTERN PetscErrorCode H5ReadArray(H5File *file, const char name[], PetscInt index, PetscInt n,
                                        PetscReal values[]);
