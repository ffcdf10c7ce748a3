/* HDF5 files of a run, and the attributes of their root group.

   Rank 0 owns every file, and the other ranks send it their rows. So a full disk or a broken file is found by one rank,
   and no rank waits for another that has failed. Rank 0 keeps an error in `failed`, and every later call on the file
   does nothing. H5FileFailed tells all ranks; writing tells nobody.

   Files are read and written by HDF5's driver of plain files with two changes. A write that fails is noted
   (H5WriteLost) and reported to HDF5 as done: HDF5 1.10 crashes at the program's end where a file is open that it
   cannot write. And where values were last read is noted (H5LastRead), by which the places of entries in a file are
   known. */
#pragma once
#include "base/base.h"
#include <hdf5.h>

typedef struct {
  MPI_Comm comm;
  PetscMPIInt rank;
  hid_t id;         /* rank 0; -1 on other ranks and when not open */
  PetscBool failed; /* rank 0 */
  char path[PETSC_MAX_PATH_LEN];
} H5File;

/* H5Try - a call of HDF5 on rank 0's file, made when all calls before it have succeeded. */
#define H5Try(file, call)                                                                                              \
  do {                                                                                                                 \
    if (!(file)->failed && ((call) < 0 || H5WriteLost())) (file)->failed = PETSC_TRUE;                                 \
  } while (0)

/* H5WriteLost - whether a write has failed since the last call. H5LastRead - byte of the file from which values were
   last read; HADDR_UNDEF: none since the last call. Not collective. */
PETSC_EXTERN PetscBool H5WriteLost(void);
PETSC_EXTERN haddr_t H5LastRead(void);

/* H5FileOpen - a new file, in place of a file of this name, or an existing file. Collective. */
typedef enum { H5_NEW, H5_READ, H5_WRITE } H5Mode;
PETSC_EXTERN PetscErrorCode H5FileOpen(MPI_Comm comm, const char path[], H5Mode mode, H5File *file);

/* H5FileFlush - hand everything to the system. H5FileClose - hand everything to the system and close the file; also
   after a failure. Not collective. */
PETSC_EXTERN void H5FileFlush(H5File *file);
PETSC_EXTERN void H5FileClose(H5File *file);

/* H5FileFailed - whether any call so far has failed, the same on every rank. Collective. */
PETSC_EXTERN PetscErrorCode H5FileFailed(const H5File *file, PetscBool *failed);

/* Numbers of the file's root, as an attribute or, of more than 8000 numbers, as a dataset. type: H5_REAL (PetscReal) or
   H5_INT (PetscInt). H5Put: rank 0's values are written; not collective. H5Get: every rank gets what is read; another
   number of values is a failure; collective. */
#define H5_REAL H5T_NATIVE_DOUBLE
#define H5_INT (sizeof(PetscInt) == 8 ? H5T_NATIVE_INT64 : H5T_NATIVE_INT32)
PETSC_EXTERN void H5Put(H5File *file, const char name[], hid_t type, PetscInt n, const void *values);
PETSC_EXTERN PetscErrorCode H5Get(H5File *file, const char name[], hid_t type, PetscInt n, void *values);

/* Texts of the root, in attributes. H5PutText writes a text of any length, in several attributes where HDF5 does not
   hold it in one. H5GetText: every rank gets the text, which it frees (PetscFree); a missing text is empty; collective.
   H5GetString reads at most length - 1 characters. */
PETSC_EXTERN void H5PutText(H5File *file, const char name[], const char value[]);
PETSC_EXTERN PetscErrorCode H5GetString(H5File *file, const char name[], size_t length, char value[]);
PETSC_EXTERN PetscErrorCode H5GetText(H5File *file, const char name[], char **value);

/* H5PutRows - a dataset values[rows][columns], or values[rows] with columns 0, of rank 0 that does not grow. Not
   collective. */
PETSC_EXTERN void H5PutRows(H5File *file, const char name[], hid_t type, PetscInt rows, PetscInt columns,
                            const void *values);

/* H5PutUnit - the attribute `units` of a dataset. Not collective. */
PETSC_EXTERN void H5PutUnit(H5File *file, const char dataset[], const char unit[]);

/* H5CheckLinks - whether the file itself holds all that its names stand for: a link to another file or name makes
   `plain` false. A file with a right checksum need not be one that petves wrote. Collective. */
PETSC_EXTERN PetscErrorCode H5CheckLinks(H5File *file, PetscBool *plain);
