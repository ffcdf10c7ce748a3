/* A file that HDF5 reads need not be the one that petves wrote, though its checksum is right: what is looked at before
   anything in it is used. */
#pragma once
#include "output/h5.h"

/* H5CheckLinks - whether the file holds all that its names stand for: no link leads to another file or another name.
   Collective. */
PETSC_EXTERN PetscErrorCode H5CheckLinks(H5File *file, PetscBool *plain);

/* H5CheckEntry - that a series has one entry, of this size, in the file itself as H5CreateSeries has it there; else the
   file has failed. Rank 0's. */
PETSC_EXTERN void H5CheckEntry(H5File *file, const char name[], int ndims, const PetscInt dims[]);
