#include "output/lock.h"
#include <errno.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define NAME "run.lock"

static PetscBool Same(const struct stat *a, const struct stat *b) {
  return a->st_dev == b->st_dev && a->st_ino == b->st_ino ? PETSC_TRUE : PETSC_FALSE;
}

/* The lock of a file that is made if need be; the error number, or 0. A run that ends removes the file while it holds
   the lock: who has locked that one tries again. */
static PetscMPIInt TakeLock(const char path[], int *file) {
  struct stat mine, there;
  for (;;) {
    *file = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (*file < 0) return errno;
    const int error = flock(*file, LOCK_EX | LOCK_NB) ? errno : 0;
    if (!error && !fstat(*file, &mine) && !stat(path, &there) && Same(&mine, &there)) return 0;
    (void)close(*file);
    *file = -1;
    if (error) return error;
  }
}

/* For those who are refused. A full disk has no room for it, which does no harm. */
static void WriteHolder(int file) {
  char host[128] = "";
  (void)gethostname(host, sizeof(host) - 1);
  if (!ftruncate(file, 0)) (void)!dprintf(file, "process %ld on %s\n", (long)getpid(), host);
}

/* After a moment in which a holder that has just taken the lock writes who it is; false when it has ended meanwhile. */
static PetscBool ReadHolder(const char path[], char who[], size_t length) {
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

/* Rank 0 takes the lock, all ranks hear of it. */
static PetscErrorCode Lock(Folder *folder) {
  char path[PETSC_MAX_PATH_LEN], who[192] = "";
  PetscMPIInt error = 0;
  PetscFunctionBeginUser;
  PetscCall(FolderPath(folder, NAME, path));
  if (!folder->rank) error = TakeLock(path, &folder->lock);
  while (error == EWOULDBLOCK && !ReadHolder(path, who, sizeof(who))) error = TakeLock(path, &folder->lock);
  if (!folder->rank && !error) WriteHolder(folder->lock);
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, folder->comm));
  PetscCallMPI(MPI_Bcast(who, sizeof(who), MPI_CHAR, 0, folder->comm));
  if (error == ENOENT || error == ENOTDIR) PetscFunctionReturn(PETSC_SUCCESS); /* no folder */
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
    (void)FolderPath(folder, NAME, path);
    if (!fstat(folder->lock, &mine) && !stat(path, &there) && Same(&mine, &there)) (void)unlink(path);
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
  PetscCall(Lock(folder));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* mkdir -p; the error number, or 0. */
static PetscMPIInt MakeParts(const char path[]) {
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
  if (!folder->rank) error = MakeParts(folder->path);
  PetscCallMPI(MPI_Bcast(&error, 1, MPI_INT, 0, folder->comm));
  PetvesCheck(!error, folder->comm, "-output_dir %s: cannot be made (%s); allowed: a folder that can be written",
              folder->path, strerror(error));
  if (!folder->locked) PetscCall(Lock(folder));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void FolderWatch(Folder *folder, const char file[]) {
  char path[PETSC_MAX_PATH_LEN];
  struct stat there;
  int k = 0;
  if (folder->rank) return;
  (void)FolderPath(folder, file, path);
  while (k < folder->files && strcmp(folder->file[k].name, file)) k++;
  if (k == FOLDER_FILES || stat(path, &there)) return;
  folder->file[k] = (FolderFile){.name = file, .device = there.st_dev, .inode = there.st_ino};
  folder->files = PetscMax(folder->files, k + 1);
}

/* The first watched file that is not there, or is another one; -1 when there is none. A file system that does not
   answer says nothing. */
static PetscMPIInt FindForeign(Folder *folder, char path[PETSC_MAX_PATH_LEN]) {
  struct stat there;
  for (int k = 0; k < folder->files; k++) {
    const FolderFile *f = &folder->file[k];
    (void)FolderPath(folder, f->name, path);
    const int error = stat(path, &there) ? errno : 0;
    if (error == ENOENT || error == ENOTDIR) return k;
    if (!error && (there.st_dev != f->device || there.st_ino != f->inode)) return k;
  }
  return -1;
}

PetscErrorCode FolderCheckOwn(Folder *folder) {
  char path[PETSC_MAX_PATH_LEN] = "";
  PetscMPIInt foreign = -1;
  PetscFunctionBeginUser;
  if (!folder->rank) foreign = FindForeign(folder, path);
  PetscCallMPI(MPI_Bcast(&foreign, 1, MPI_INT, 0, folder->comm));
  if (foreign < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Bcast(path, sizeof(path), MPI_CHAR, 0, folder->comm));
  folder->failed = PETSC_TRUE;
  PetvesCheck(PETSC_FALSE, folder->comm,
              "%s: cannot be written: it is gone, or another file has its name; allowed: a run's files left where they "
              "are while it goes on",
              path);
  PetscFunctionReturn(PETSC_SUCCESS);
}
