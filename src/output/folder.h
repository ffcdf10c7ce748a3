/* The folder -output_dir of one run: its path, its lock, its files, and writes whose success all ranks agree on.

   Rank 0 alone makes, writes and removes files. Whether a file could be written is one broadcast (FolderCheck), so that
   every rank stops with the same line. No two runs write into one folder: rank 0 holds an exclusive lock on the file
   run.lock, which the system releases when the process dies. A run also stops when one of its files has been removed or
   replaced by somebody else (FolderWatch, FolderCheckOwn).

   Order: FolderOpen, FolderMake, FolderClaim, then any writes, FolderRelease. */
#pragma once
#include "base/base.h"
#include <sys/stat.h>

/* A file as it was when the run opened it. */
typedef struct {
  const char *name;
  struct stat status;
} FolderFile;

#define FOLDER_FILES 4

typedef struct {
  MPI_Comm comm;
  PetscMPIInt rank;
  PetscBool failed; /* the line of a file that could not be written has been printed; the same on every rank */
  char path[PETSC_MAX_PATH_LEN];
  PetscBool locked;              /* the folder is this run's; the same on every rank */
  int lock;                      /* rank 0: descriptor of run.lock; -1 where the file system has no locks */
  int files;                     /* rank 0: number of watched files */
  FolderFile file[FOLDER_FILES]; /* [files] */
} Folder;

/* FolderOpen - the folder of that name, locked when it exists. FolderMake - make the folder and those above it, and
   lock it unless it is locked. Nothing in a folder may be touched before. Collective. Errors: PETSC_ERR_USER_INPUT when
   another run has the lock (the line names its host and process), or the folder or the lock cannot be made. On a file
   system without locks the run prints a warning and goes on without a lock. */
PETSC_EXTERN PetscErrorCode FolderOpen(MPI_Comm comm, const char path[], Folder *folder);
PETSC_EXTERN PetscErrorCode FolderMake(Folder *folder);

/* FolderRelease - remove run.lock and release the lock, on rank 0. Not collective. */
PETSC_EXTERN void FolderRelease(Folder *folder);

/* FolderClaim - refuse a folder that holds another run's results, unless overwrite. here: the checkpoint `restart` (""
   for none) lies in this folder, so that its files go on. Collective. */
PETSC_EXTERN PetscErrorCode FolderClaim(Folder *folder, const char restart[], PetscBool overwrite, PetscBool *here);

/* FolderPath - path of a file in the folder. FolderRemove - remove a file, on rank 0; a file that does not exist is no
   error. Not collective. */
PETSC_EXTERN void FolderPath(const Folder *folder, const char file[], char path[PETSC_MAX_PATH_LEN]);
PETSC_EXTERN void FolderRemove(Folder *folder, const char file[]);

/* FolderCheck - stop every rank with one line when rank 0 could not write a file; `written` counts on rank 0 only. A
   failure sets folder->failed. Collective. */
PETSC_EXTERN PetscErrorCode FolderCheck(Folder *folder, PetscBool written, const char file[]);

/* FolderWriteText - write a text file under a temporary name and rename it, on rank 0. Collective; stops every rank
   with one line when the file cannot be written. */
typedef PetscErrorCode (*FolderPrint)(FILE *file, const void *what);
PETSC_EXTERN PetscErrorCode FolderWriteText(Folder *folder, const char file[], FolderPrint print, const void *what);

/* FolderWatch - from now on the file of this name belongs to the run. A run that has replaced a file calls FolderWatch
   again. FolderCheckOwn - stop every rank with one line when a watched file has been removed or replaced. FolderWatch
   is not collective, FolderCheckOwn is. */
PETSC_EXTERN void FolderWatch(Folder *folder, const char file[]);
PETSC_EXTERN PetscErrorCode FolderCheckOwn(Folder *folder);

/* FileSync - put a file on the disk; 0 when all of it is there. Not collective. */
PETSC_EXTERN int FileSync(const char path[]);
