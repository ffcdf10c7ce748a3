/* One run, one folder: an exclusive lock on a file in it, and a look whether the files of a run are still its own. */
#pragma once
#include "output/folder.h"

/* FolderOpen - the folder of that name, with its lock when it is there already. FolderMake - make it, with those above
   it, and take the lock unless it is held. Nothing in a folder may be touched before. Collective. Errors:
   PETSC_ERR_USER_INPUT when another run has the lock, which is named by host and process, and when the folder or its
   lock cannot be made. On a file system without locks there is a warning and no lock. */
PETSC_EXTERN PetscErrorCode FolderOpen(MPI_Comm comm, const char path[], Folder *folder);
PETSC_EXTERN PetscErrorCode FolderMake(Folder *folder);

/* FolderRelease - remove the lock's file and give up the lock, on rank 0; the system does the latter when the process
   dies. */
PETSC_EXTERN void FolderRelease(Folder *folder);

/* FolderWatch - the file of this name, "series.csv" say, is this run's from now on; once more when it has been replaced
   by the run itself. Not collective. */
PETSC_EXTERN void FolderWatch(Folder *folder, const char file[]);

/* FolderCheckOwn - stop every rank with one line when a watched file has gone, or is another one. Collective. */
PETSC_EXTERN PetscErrorCode FolderCheckOwn(Folder *folder);
