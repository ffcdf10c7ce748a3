#include "output/vesiclefile.h"

static PetscErrorCode VesicleFileDescribe(Scheme s, H5File *f) {
  H5PutText(f, "about",
            "a row a step: columns of series.csv of each vesicle, [row, vesicle]; what is no number is empty there");
  return PETSC_SUCCESS;
}

/* /step, then RecordVesicleColumns. */
static AppendedKind VesicleFileKind(Scheme s) {
  AppendedKind kind = {.name = "vesicles.h5", .entries = "rows", .scheme = s, .describe = VesicleFileDescribe};
  char path[APPENDED_NAME];
  AppendedAddSeries(&kind, "/step", 0, 1, PETSC_FALSE);
  for (int c = 0; RecordVesicleColumns[c] >= 0; c++) {
    (void)snprintf(path, sizeof(path), "/%s", SeriesColumns[RecordVesicleColumns[c]]);
    AppendedAddSeries(&kind, path, s->membrane->layout->bodies, 1, PETSC_FALSE);
  }
  return kind;
}

PetscErrorCode VesicleFileCreate(AppendedFile *f, Folder *folder, Scheme scheme) {
  const AppendedKind kind = VesicleFileKind(scheme);
  PetscFunctionBeginUser;
  if (scheme->membrane->layout->bodies > RECORD_FEW) PetscCall(AppendedCreate(f, folder, &kind));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode VesicleFileGoOn(AppendedFile *f, Folder *folder, Scheme scheme, PetscInt step, const char restart[]) {
  const AppendedKind kind = VesicleFileKind(scheme);
  PetscReal first = 0, last = -1;
  PetscInt length, rows;
  PetscFunctionBeginUser;
  if (scheme->membrane->layout->bodies <= RECORD_FEW) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(AppendedOpen(f, folder, &kind, PETSC_MAX_INT, &length));
  if (length) PetscCall(H5ReadArray(&f->file, "/step", 0, 1, &first));
  rows = step - (PetscInt)first + 1; /* first is not 0 in a folder that began with a restart */
  if (length >= rows && rows > 0) PetscCall(H5ReadArray(&f->file, "/step", rows - 1, 1, &last));
  if (last != step) length = PetscMin(length, rows - 1);
  PetscCall(AppendedGoOn(f, length, rows, restart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode VesicleFileWrite(AppendedFile *f, const Record *r, PetscInt step, PetscReal time) {
  const PetscReal number = step;
  PetscReal *values;
  PetscFunctionBeginUser;
  if (!f->open) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(r->vesicles, &values));
  AppendedSet(f, 0, &number);
  for (int c = 0; RecordVesicleColumns[c] >= 0; c++) {
    for (PetscInt v = 0; v < r->vesicles; v++) values[v] = r->each[v * COLUMN_COUNT + RecordVesicleColumns[c]];
    AppendedSet(f, c + 1, values);
  }
  PetscCall(PetscFree(values));
  PetscCall(AppendedAdd(f, time));
  PetscFunctionReturn(PETSC_SUCCESS);
}
