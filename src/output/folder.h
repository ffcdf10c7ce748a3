/* The folder of a run's files: its path, whether it may be used, and writes whose success all ranks agree on. Rank 0
   writes every file. */
#pragma once
#include "base/base.h"
#include <sys/types.h>

/* A file as it was when the run opened it. */
typedef struct {
  const char *name;
  dev_t device;
  ino_t inode;
} FolderFile;

#define FOLDER_FILES 4

typedef struct {
  MPI_Comm comm;
  PetscMPIInt rank;
  PetscBool failed; /* that a file could not be written has been said; the same on every rank */
  char path[PETSC_MAX_PATH_LEN];
  PetscBool locked;              /* the folder is this run's; the same on every rank. lock.h has what is below */
  int lock;                      /* rank 0: the lock's file; -1 where there are no locks */
  int files;                     /* rank 0: files that are watched */
  FolderFile file[FOLDER_FILES]; /* [files] */
} Folder;

/* FolderClaim - refuse a folder that holds another run's results, unless overwrite. here: the checkpoint `restart` (""
   for none) lies in this folder, so that its files go on. Collective. */
PETSC_EXTERN PetscErrorCode FolderClaim(Folder *folder, const char restart[], PetscBool overwrite, PetscBool *here);

/* FolderPath - name of a file in the folder. */
PETSC_EXTERN PetscErrorCode FolderPath(Folder *folder, const char file[], char path[PETSC_MAX_PATH_LEN]);

/* FolderRemove - remove a file, on rank 0; one that is not there is no error. */
PETSC_EXTERN PetscErrorCode FolderRemove(Folder *folder, const char file[]);

/* FolderCheck - stop every rank with one line when rank 0 could not write a file; `written` counts on rank 0 only.
   Afterwards folder->failed. Collective. */
PETSC_EXTERN PetscErrorCode FolderCheck(Folder *folder, PetscBool written, const char path[]);

/* FolderWriteText - write a text file under a temporary name, on rank 0, and rename it; stops every rank with one line
   when that fails. Collective. */
typedef PetscErrorCode (*FolderPrint)(FILE *file, const void *what);
PETSC_EXTERN PetscErrorCode FolderWriteText(Folder *folder, const char file[], FolderPrint print, const void *what);

/* FileSync - 0 when all of a file is on the disk. Not collective. */
PETSC_EXTERN int FileSync(const char path[]);
