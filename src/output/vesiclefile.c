#include "output/vesiclefile.h"

static PetscErrorCode VesicleFileDescribe(const void *none, H5File *f) {
  H5PutText(f, "about",
            "a row a step: columns of series.csv of each vesicle, [row, vesicle]; what is no number is empty there");
  return PETSC_SUCCESS;
}

PetscErrorCode VesicleFileOpen(AppendedFile *f, Folder *folder, Scheme s, PetscInt rows, const char restart[]) {
  AppendedKind kind = {.name = "vesicles.h5", .entries = "rows", .now = s->state.t, .describe = VesicleFileDescribe};
  const PetscInt vesicles = s->membrane->layout->bodies;
  PetscFunctionBeginUser;
  if (vesicles <= RECORD_FEW) PetscFunctionReturn(PETSC_SUCCESS);
  kind.series[kind.n++] = (AppendedSeries){"/step", 0, 1};
  for (int c = 0; c < COLUMN_COUNT; c++)
    if (RecordIsOwn(c)) {
      (void)snprintf(kind.series[kind.n].path, APPENDED_NAME, "/%s", SeriesColumns[c]);
      kind.series[kind.n].rows = vesicles;
      kind.series[kind.n++].columns = 1;
    }
  PetscCall(AppendedOpen(f, folder, &kind, rows, restart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode VesicleFileWrite(AppendedFile *f, const Record *r, PetscInt step, PetscReal time) {
  PetscReal number = step;
  PetscInt k = 0;
  PetscReal *values;
  PetscFunctionBeginUser;
  if (!f->open) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(r->vesicles, &values));
  AppendedSet(f, k++, &number);
  for (int c = 0; c < COLUMN_COUNT; c++)
    if (RecordIsOwn(c)) {
      for (PetscInt v = 0; v < r->vesicles; v++) values[v] = r->each[v * COLUMN_COUNT + c];
      AppendedSet(f, k++, values);
    }
  PetscCall(PetscFree(values));
  PetscCall(AppendedAdd(f, time));
  PetscFunctionReturn(PETSC_SUCCESS);
}
