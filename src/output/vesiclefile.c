#include "output/vesiclefile.h"

#define NAME "vesicles.h5"
#define MOST (GROWING_SERIES - 1)

static PetscErrorCode Name(int column, char name[], size_t length) {
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, length, "/%s", SeriesColumns[RecordVesicleColumns[column]]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(Scheme s, const char path[], H5File *f) {
  const Layout l = s->membrane->layout;
  char name[VESICLE_NAME];
  PetscFunctionBeginUser;
  PetscCall(H5FileCreate(s->scene->comm, path, f));
  PetscCall(H5PutString(f, "about",
                        "a row a step: columns of series.csv of each vesicle, [row, vesicle]; what is no number is "
                        "empty there"));
  PetscCall(H5CreateSeries(f, "/time", 0, NULL));
  PetscCall(H5CreateSeries(f, "/step", 0, NULL));
  for (int c = 0; RecordVesicleColumns[c] >= 0; c++) {
    PetscCall(Name(c, name, sizeof(name)));
    PetscCall(H5CreateSeries(f, name, 1, &l->bodies));
  }
  PetscCall(H5FileFlush(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Begin(VesicleFile *f, Scheme s, GrowingKind *kind) {
  PetscFunctionBeginUser;
  *kind = (GrowingKind){.name = NAME, .path = f->path, .scheme = s, .create = Create, .series = 1, .entries = {1}};
  f->path[0] = "/step";
  for (int c = 0; RecordVesicleColumns[c] >= 0; c++) {
    PetscCheck(c < MOST, s->scene->comm, PETSC_ERR_PLIB, "more columns than " NAME " has room for");
    PetscCall(Name(c, f->name[c], sizeof(f->name[c])));
    f->path[c + 1] = f->name[c];
    kind->entries[kind->series++] = s->membrane->layout->bodies;
  }
  PetscCall(PetscMalloc1(s->membrane->layout->bodies, &f->values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsMany(Scheme s) {
  return s->membrane->layout->bodies > RECORD_FEW ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode VesicleFileCreate(VesicleFile *f, Folder *folder, Scheme scheme) {
  GrowingKind kind;
  PetscFunctionBeginUser;
  if (!IsMany(scheme)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Begin(f, scheme, &kind));
  PetscCall(GrowingCreate(&f->grown, folder, &kind));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode VesicleFileGoOn(VesicleFile *f, Folder *folder, Scheme scheme, PetscInt step, const char restart[]) {
  GrowingKind kind;
  PetscReal first = 0, last = -1;
  PetscInt length, rows;
  PetscFunctionBeginUser;
  if (!IsMany(scheme)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Begin(f, scheme, &kind));
  PetscCall(GrowingOpen(&f->grown, folder, &kind, PETSC_MAX_INT, &length));
  if (length) PetscCall(H5ReadArray(&f->grown.file, "/step", 0, 1, &first));
  rows = step - (PetscInt)first + 1; /* the first is another than 0 in a folder that began with a restart */
  if (length >= rows && rows > 0) PetscCall(H5ReadArray(&f->grown.file, "/step", rows - 1, 1, &last));
  if (last != step) length = PetscMin(length, rows - 1);
  PetscCall(GrowingGoOn(&f->grown, length, rows, "rows", restart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode VesicleFileWrite(VesicleFile *f, const Record *r, PetscInt step, PetscReal time) {
  const PetscReal number = step;
  Growing *g = &f->grown;
  PetscFunctionBeginUser;
  if (!g->open) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(H5WriteArray(&g->file, "/step", g->count, 1, &number));
  for (int c = 0; RecordVesicleColumns[c] >= 0; c++) {
    for (PetscInt v = 0; v < r->vesicles; v++) f->values[v] = r->each[v * COLUMN_COUNT + RecordVesicleColumns[c]];
    PetscCall(H5WriteArray(&g->file, f->path[c + 1], g->count, r->vesicles, f->values));
  }
  PetscCall(GrowingAppend(g, time));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode VesicleFileFlush(VesicleFile *f, PetscBool sync) {
  PetscFunctionBeginUser;
  if (f->grown.open) PetscCall(GrowingFlush(&f->grown, sync));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode VesicleFileClose(VesicleFile *f, PetscBool *good) {
  PetscFunctionBeginUser;
  PetscCall(GrowingClose(&f->grown, good));
  PetscCall(PetscFree(f->values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
