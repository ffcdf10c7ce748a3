#include "output/vesiclefile.h"

static PetscErrorCode VesicleFileDescribe(const void *none, H5File *f) {
  H5PutText(f, "about",
            "a row a step: columns of series.csv of each vesicle, [row, vesicle]; what is no number is empty there");
  return PETSC_SUCCESS;
}

PetscErrorCode VesicleFileOpen(AppendedFile *f, Folder *folder, const RecordSetting *s, PetscReal now, PetscInt rows,
                               const char restart[]) {
  AppendedKind kind = {.name = "vesicles.h5", .entries = "rows", .now = now, .describe = VesicleFileDescribe};
  PetscFunctionBeginUser;
  if (s->vesicles <= RECORD_FEW) PetscFunctionReturn(PETSC_SUCCESS);
  kind.series[kind.n++] = (AppendedSeries){"/step", 0, 1};
  for (PetscInt c = 0; c < s->columns; c++)
    if (RecordIsOwn(&s->column[c])) {
      (void)snprintf(kind.series[kind.n].path, APPENDED_NAME, "/%.*s", APPENDED_NAME - 2, s->column[c].name);
      kind.series[kind.n].rows = s->vesicles;
      kind.series[kind.n++].columns = 1;
    }
  PetscCall(AppendedOpen(f, folder, &kind, rows, restart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode VesicleFileWrite(AppendedFile *f, const Record *r, PetscInt step, PetscReal time) {
  const RecordSetting *s = &r->setting;
  PetscReal number = step;
  PetscInt k = 0;
  PetscReal *values;
  PetscFunctionBeginUser;
  if (!f->open) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(s->vesicles, &values));
  AppendedSet(f, k++, &number);
  for (PetscInt c = 0; c < s->columns; c++)
    if (RecordIsOwn(&s->column[c])) {
      for (PetscInt v = 0; v < s->vesicles; v++) values[v] = r->each[v * s->columns + c];
      AppendedSet(f, k++, values);
    }
  PetscCall(PetscFree(values));
  PetscCall(AppendedAdd(f, time));
  PetscFunctionReturn(PETSC_SUCCESS);
}
