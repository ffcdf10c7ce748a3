#include "output/folder.h"
#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

PetscErrorCode FolderPath(Folder *folder, const char file[], char path[PETSC_MAX_PATH_LEN]) {
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(path, PETSC_MAX_PATH_LEN, "%s/%s", folder->path, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FolderCheck(Folder *folder, PetscBool written, const char path[]) {
  PetscMPIInt failed = !folder->rank && !written;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, folder->comm));
  if (failed) folder->failed = PETSC_TRUE;
  PetvesCheck(!failed, folder->comm, "%s: cannot be written; allowed: a folder with space that can be written", path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int FileSync(const char path[]) {
  const int fd = open(path, O_RDONLY), failed = fd < 0 || fsync(fd);
  return (fd >= 0 && close(fd)) || failed;
}

PetscErrorCode FolderRemove(Folder *folder, const char file[]) {
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  PetscCall(FolderPath(folder, file, path));
  if (!folder->rank) (void)unlink(path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FolderWriteText(Folder *folder, const char file[], FolderPrint print, const void *what) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN], name[PETSC_MAX_PATH_LEN];
  PetscBool done = PETSC_TRUE;
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s.tmp", file));
  PetscCall(FolderPath(folder, file, path));
  PetscCall(FolderPath(folder, name, temporary));
  if (!folder->rank) {
    FILE *f = FileNew(temporary);
    done = f && !print(f, what) && !ferror(f) ? PETSC_TRUE : PETSC_FALSE;
    if (f && fclose(f)) done = PETSC_FALSE;
    if (done && (FileSync(temporary) || rename(temporary, path))) done = PETSC_FALSE;
    if (f && !done) (void)unlink(temporary);
  }
  PetscCall(FolderCheck(folder, done, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether a file lies in the folder. */
static PetscBool LiesHere(Folder *folder, const char file[]) {
  char above[PETSC_MAX_PATH_LEN], *slash;
  struct stat here, there;
  if (!*file) return PETSC_FALSE;
  (void)PetscStrncpy(above, file, sizeof(above));
  slash = strrchr(above, '/');
  if (slash) slash[slash == above] = 0;
  if (stat(slash ? above : ".", &there) || stat(folder->path, &here)) return PETSC_FALSE;
  return here.st_dev == there.st_dev && here.st_ino == there.st_ino ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode FolderClaim(Folder *folder, const char restart[], PetscBool overwrite, PetscBool *here) {
  const char *const results[] = {"series.csv", "run.h5", "checkpoint.h5"};
  char path[PETSC_MAX_PATH_LEN];
  PetscMPIInt found[2] = {0, -1}; /* go on here; result of another run */
  PetscFunctionBeginUser;
  if (!folder->rank) found[0] = LiesHere(folder, restart);
  for (int k = 0; k < 3 && !folder->rank && !found[0] && !overwrite; k++) {
    PetscCall(FolderPath(folder, results[k], path));
    if (!access(path, F_OK)) found[1] = k;
  }
  PetscCallMPI(MPI_Bcast(found, 2, MPI_INT, 0, folder->comm));
  *here = found[0] ? PETSC_TRUE : PETSC_FALSE;
  PetvesCheck(found[1] < 0, folder->comm,
              "-output_dir %s: holds %s of another run; allowed: a new folder, -output_overwrite to replace what is "
              "there, or -restart %s/checkpoint.h5 to go on",
              folder->path, results[PetscMax(found[1], 0)], folder->path);
  PetscFunctionReturn(PETSC_SUCCESS);
}
