#include "output/folder.h"
#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <time.h>
#include <unistd.h>

#define LOCK "run.lock"

void FolderPath(const Folder *folder, const char file[], char path[PETSC_MAX_PATH_LEN]) {
  (void)PetscSNPrintf(path, PETSC_MAX_PATH_LEN, "%s/%s", folder->path, file);
}

PetscErrorCode FolderCheck(Folder *folder, PetscBool written, const char file[]) {
  PetscMPIInt failed = !folder->rank && !written;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, folder->comm));
  if (failed) folder->failed = PETSC_TRUE;
  PetvesCheck(!failed, folder->comm, "%s/%s: cannot be written; allowed: a folder with space that can be written",
              folder->path, file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

int FileSync(const char path[]) {
  const int fd = open(path, O_RDONLY), failed = fd < 0 || fsync(fd);
  return (fd >= 0 && close(fd)) || failed;
}

void FolderRemove(Folder *folder, const char file[]) {
  char path[PETSC_MAX_PATH_LEN];
  FolderPath(folder, file, path);
  if (!folder->rank) (void)unlink(path);
}

PetscErrorCode FolderWriteText(Folder *folder, const char file[], FolderPrint print, const void *what) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN], name[PETSC_MAX_PATH_LEN];
  PetscBool done = PETSC_TRUE;
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s.tmp", file));
  FolderPath(folder, file, path);
  FolderPath(folder, name, temporary);
  if (!folder->rank) {
    FILE *f = FileNew(temporary);
    done = f && !print(f, what) && !ferror(f);
    if (f && fclose(f)) done = PETSC_FALSE;
    if (done && (FileSync(temporary) || rename(temporary, path))) done = PETSC_FALSE;
    if (f && !done) (void)unlink(temporary);
  }
  PetscCall(FolderCheck(folder, done, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsSameFile(const struct stat *a, const struct stat *b) {
  return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

/* Whether a file lies in the folder. */
static PetscBool FolderHolds(Folder *folder, const char file[]) {
  char above[PETSC_MAX_PATH_LEN], *slash;
  struct stat here, there;
  if (!*file) return PETSC_FALSE;
  (void)PetscStrncpy(above, file, sizeof(above));
  slash = strrchr(above, '/');
  if (slash) slash[slash == above] = 0;
  if (stat(slash ? above : ".", &there) || stat(folder->path, &here)) return PETSC_FALSE;
  return IsSameFile(&here, &there);
}

PetscErrorCode FolderClaim(Folder *folder, const char restart[], PetscBool overwrite, PetscBool *here) {
  const char *const results[] = {"series.csv", "run.h5", "checkpoint.h5"};
  char path[PETSC_MAX_PATH_LEN];
  PetscMPIInt found[2] = {0, -1}; /* files go on here; number of a result of another run */
  PetscFunctionBeginUser;
  if (!folder->rank) found[0] = FolderHolds(folder, restart);
  for (int k = 0; k < 3 && !folder->rank && !found[0] && !overwrite; k++) {
    FolderPath(folder, results[k], path);
    if (!access(path, F_OK)) found[1] = k;
  }
  PetscCallMPI(MPI_Bcast(found, 2, MPI_INT, 0, folder->comm));
  *here = found[0];
  PetvesCheck(found[1] < 0, folder->comm,
              "-output_dir %s: holds %s of another run; allowed: a new folder, -output_overwrite to replace what is "
              "there, or -restart %s/checkpoint.h5 to go on",
              folder->path, results[PetscMax(found[1], 0)], folder->path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lock a file, which is made unless it exists; returns the error number, or 0. A run that ends removes the file while
   it holds the lock: a process that has locked a removed file tries again. */
static PetscMPIInt LockFile(const char path[], int *file) {
  struct stat mine, there;
  for (;;) {
    *file = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (*file < 0) return errno;
    const int error = flock(*file, LOCK_EX | LOCK_NB) ? errno : 0;
    if (!error && !fstat(*file, &mine) && !stat(path, &there) && IsSameFile(&mine, &there)) return 0;
    (void)close(*file);
    *file = -1;
    if (error) return error;
  }
}

/* Read who holds the lock, after a moment in which a new holder writes it; false when the holder has ended meanwhile.
 */
static PetscBool LockReadHolder(const char path[], char who[], size_t length) {
  const struct timespec moment = {.tv_nsec = 100000000};
  FILE *f;
  (void)nanosleep(&moment, NULL);
  f = fopen(path, "r");
  if (!f) return PETSC_FALSE;
  if (!fgets(who, (int)length, f)) (void)PetscStrncpy(who, "another run", length);
  who[strcspn(who, "\n")] = 0;
  (void)fclose(f);
  return PETSC_TRUE;
}

/* Rank 0 takes the lock and tells all ranks. */
static PetscErrorCode FolderLock(Folder *folder) {
  char path[PETSC_MAX_PATH_LEN], who[192] = "";
  PetscMPIInt error = 0;
  PetscFunctionBeginUser;
  FolderPath(folder, LOCK, path);
  if (!folder->rank) error = LockFile(path, &folder->lock);
  while (error == EWOULDBLOCK && !LockReadHolder(path, who, sizeof(who))) error = LockFile(path, &folder->lock);
  if (!folder->rank && !error) {
    /* who holds the lock, for runs that are refused; on a full disk it stays empty, which does no harm */
    (void)gethostname(who, sizeof(who) - 1);
    if (!ftruncate(folder->lock, 0)) (void)!dprintf(folder->lock, "process %ld on %s\n", (long)getpid(), who);
  }
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, folder->comm));
  PetscCallMPI(MPI_Bcast(who, sizeof(who), MPI_CHAR, 0, folder->comm));
  if (error == ENOENT || error == ENOTDIR) PetscFunctionReturn(PETSC_SUCCESS); /* there is no folder yet */
  if (error == ENOLCK || error == ENOSYS || error == EOPNOTSUPP || error == EINVAL) {
    PetscCall(PetvesSay(folder->comm,
                        "petves: warning: %s: no locks on this file system (%s); nothing keeps a second run out of "
                        "the folder\n",
                        path, strerror(error)));
    folder->locked = PETSC_TRUE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetvesCheck(error != EWOULDBLOCK, folder->comm,
              "-output_dir %s: in use by %s; allowed: another folder, or the end of that run first", folder->path, who);
  PetvesCheck(!error, folder->comm, "%s: cannot be written (%s); allowed: a folder with space that can be written",
              path, strerror(error));
  folder->locked = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void FolderRelease(Folder *folder) {
  char path[PETSC_MAX_PATH_LEN];
  struct stat mine, there;
  if (folder->locked && !folder->rank && folder->lock >= 0) {
    FolderPath(folder, LOCK, path);
    if (!fstat(folder->lock, &mine) && !stat(path, &there) && IsSameFile(&mine, &there)) (void)unlink(path);
    (void)close(folder->lock);
  }
  folder->locked = PETSC_FALSE;
}

PetscErrorCode FolderOpen(MPI_Comm comm, const char path[], Folder *folder) {
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(folder, sizeof(*folder)));
  folder->comm = comm;
  folder->lock = -1;
  PetscCallMPI(MPI_Comm_rank(comm, &folder->rank));
  PetscCall(PetscStrncpy(folder->path, path, sizeof(folder->path)));
  PetscCall(FolderLock(folder));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Make a folder and those above it; returns the error number, or 0. */
static PetscMPIInt FolderMakeParts(const char path[]) {
  char part[PETSC_MAX_PATH_LEN];
  struct stat what;
  (void)PetscStrncpy(part, path, sizeof(part));
  for (char *p = part + 1; *p; p++)
    if (*p == '/') {
      *p = 0;
      (void)mkdir(part, 0777);
      *p = '/';
    }
  if (mkdir(part, 0777) && errno != EEXIST) return errno;
  return stat(part, &what) || !S_ISDIR(what.st_mode) ? ENOTDIR : 0;
}

PetscErrorCode FolderMake(Folder *folder) {
  PetscMPIInt error = 0;
  PetscFunctionBeginUser;
  if (!folder->rank) error = FolderMakeParts(folder->path);
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, folder->comm));
  PetvesCheck(!error, folder->comm, "-output_dir %s: cannot be made (%s); allowed: a folder that can be written",
              folder->path, strerror(error));
  if (!folder->locked) PetscCall(FolderLock(folder));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void FolderWatch(Folder *folder, const char file[]) {
  char path[PETSC_MAX_PATH_LEN];
  int k = 0;
  if (folder->rank) return;
  FolderPath(folder, file, path);
  while (k < folder->files && strcmp(folder->file[k].name, file)) k++;
  if (k == FOLDER_FILES || stat(path, &folder->file[k].status)) return;
  folder->file[k].name = file;
  folder->files = PetscMax(folder->files, k + 1);
}

PetscErrorCode FolderCheckOwn(Folder *folder) {
  char path[PETSC_MAX_PATH_LEN] = "";
  PetscMPIInt foreign = 0;
  struct stat there;
  PetscFunctionBeginUser;
  for (int k = 0; k < folder->files && !foreign;
       k++) { /* on rank 0; a file system that does not answer proves nothing */
    FolderPath(folder, folder->file[k].name, path);
    const int error = stat(path, &there) ? errno : 0;
    foreign = error ? error == ENOENT || error == ENOTDIR : !IsSameFile(&there, &folder->file[k].status);
  }
  PetscCallMPI(MPI_Bcast(&foreign, 1, MPI_INT, 0, folder->comm));
  if (!foreign) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Bcast(path, sizeof(path), MPI_CHAR, 0, folder->comm));
  folder->failed = PETSC_TRUE;
  PetvesCheck(PETSC_FALSE, folder->comm,
              "%s: cannot be written: it is gone, or another file has its name; allowed: a run's files left where they "
              "are while it goes on",
              path);
  PetscFunctionReturn(PETSC_SUCCESS);
}
