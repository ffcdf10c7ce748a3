#include "output/frames.h"
#include "output/cells.h"

static PetscErrorCode Begin(Frames *f, Scheme scheme) {
  const Grid g = scheme->fluid->grid;
  const PetscInt n = g->n[0] * g->rows[FIELD_P];
  PetscFunctionBeginUser;
  const Obstacles o = scheme->coupling->bodies->obstacles;
  f->scheme = scheme;
  PetscCall(PetscMalloc4(n, &f->cells[0], n, &f->cells[1], n, &f->cells[2], o ? 2 * o->layout->M : 0, &f->force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesCreate(Frames *f, Folder *folder, Scheme scheme) {
  GrowingKind kind;
  PetscFunctionBeginUser;
  PetscCall(Begin(f, scheme));
  PetscCall(FrameKind(scheme, &kind));
  PetscCall(GrowingCreate(&f->grown, folder, &kind));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesGoOn(Frames *f, Folder *folder, Scheme scheme, PetscInt scheduled, const char restart[]) {
  GrowingKind kind;
  PetscInt length;
  PetscFunctionBeginUser;
  PetscCall(Begin(f, scheme));
  PetscCall(FrameKind(scheme, &kind));
  PetscCall(GrowingOpen(&f->grown, folder, &kind, scheduled, &length));
  PetscCall(GrowingGoOn(&f->grown, length, scheduled, "frames", restart));
  f->scheduled = scheduled;
  if (scheduled) f->time = f->grown.time[scheduled - 1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The values of the present frame, at entry `count`. */
static PetscErrorCode WriteValues(Frames *f, const Gathered *now) {
  const Grid g = f->scheme->fluid->grid;
  const PetscInt count = f->grown.count;
  const PetscReal *const marker[3] = {now->markers, now->velocity, now->tension};
  H5File *file = &f->grown.file;
  PetscFunctionBeginUser;
  PetscCall(CellFields(f->scheme, f->cells[0], f->cells[1], f->cells[2]));
  for (int c = 0; c < 3; c++) PetscCall(H5WriteField(file, FrameSeries[c], count, g, FIELD_P, f->cells[c]));
  for (int k = 0; k < 3 && now->M; k++)
    PetscCall(H5WriteArray(file, FrameSeries[FRAME_VESICLES + k], count, k < 2 ? 2 * now->M : now->M, marker[k]));
  if (now->W) {
    ObstaclesOrder(f->scheme->coupling->bodies->obstacles, now->solid, f->force);
    PetscCall(H5WriteArray(file, FrameSeries[FRAME_FORCE], count, 2 * now->W, f->force));
  }
  if (f->scheme->scene->obstacles.moving) {
    ObstaclesCurves(f->scheme->coupling->bodies->obstacles, f->scheme->state.t, f->force);
    PetscCall(H5WriteArray(file, FrameSeries[FRAME_SOLIDS], count, 2 * now->W, f->force));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesWrite(Frames *f, const Gathered *now, PetscBool scheduled) {
  const PetscReal t = f->scheme->state.t;
  PetscFunctionBeginUser;
  f->grown.count = f->scheduled;
  PetscCall(WriteValues(f, now));
  PetscCall(GrowingFlush(&f->grown, PETSC_FALSE)); /* values before the time by which readers count them */
  PetscCall(GrowingAppend(&f->grown, t));
  PetscCall(GrowingFlush(&f->grown, PETSC_FALSE));
  if (scheduled) f->scheduled = f->grown.count;
  f->time = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesMarkers(Frames *f, PetscReal **markers) {
  const PetscInt M = f->scheme->membrane->layout->M;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * M * f->grown.count, markers));
  for (PetscInt t = 0; t < f->grown.count && M; t++)
    PetscCall(H5ReadArray(&f->grown.file, FrameSeries[FRAME_VESICLES], t, 2 * M, *markers + 2 * M * t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesSync(Frames *f) {
  PetscFunctionBeginUser;
  PetscCall(GrowingFlush(&f->grown, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesClose(Frames *f, PetscBool *good) {
  PetscFunctionBeginUser;
  PetscCall(GrowingClose(&f->grown, good));
  PetscCall(PetscFree4(f->cells[0], f->cells[1], f->cells[2], f->force));
  PetscFunctionReturn(PETSC_SUCCESS);
}
