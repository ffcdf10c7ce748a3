#include "output/written.h"
#include <sys/stat.h>

static PetscErrorCode Size(Folder *folder, const char name[], double *bytes) {
  char path[PETSC_MAX_PATH_LEN];
  struct stat status;
  PetscFunctionBeginUser;
  PetscCall(FolderPath(folder, name, path));
  *bytes = !folder->rank && !stat(path, &status) ? (double)status.st_size : 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WrittenCount(Folder *folder, PetscInt frames, PetscInt checkpoints, Written *w) {
  static const char *const names[] = {"series.csv", "run.xmf", "vesicles.h5", "checkpoint.h5"};
  double bytes;
  PetscFunctionBeginUser;
  w->frames = frames;
  PetscCall(Size(folder, "run.h5", &w->h5));
  w->all = w->h5;
  for (PetscInt k = 0; k < 3 + checkpoints; k++) {
    char name[64];
    PetscCall(k < 4 ? PetscStrncpy(name, names[k], sizeof(name))
                    : PetscSNPrintf(name, sizeof(name), "checkpoint_%d.h5", (int)k - 3));
    PetscCall(Size(folder, name, &bytes));
    w->all += bytes;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
