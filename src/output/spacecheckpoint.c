/* Checkpoints of runs in three dimensions: the states as coefficients, and what the factors were made for. */
#include "output/spaceoutput.h"

/* Write or read the numbers of all vesicles [vesicles][each]. */
static PetscErrorCode MoveVesicles(Space s, H5File *file, PetscBool write, const char group[], const char name[],
                                   PetscInt each, PetscReal own[]) {
  PetscReal *all;
  char path[64];
  PetscFunctionBeginUser;
  (void)snprintf(path, sizeof(path), "%s/vesicle/%s", group, name);
  PetscCall(PetscCalloc1(s->share.vesicles * each, &all));
  if (write) PetscCall(ShareGather(&s->share, each, own, all));
  PetscCall(CheckpointEntry(file, write, path, s->share.vesicles, each, all));
  if (!write) PetscCall(ShareScatter(&s->share, each, all, own));
  for (PetscInt k = 0; k < s->share.vesicles * each && !file->rank; k++)
    if (PetscIsInfOrNanReal(all[k])) file->failed = PETSC_TRUE;
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MoveState(Space s, H5File *file, PetscBool write, PetscInt j) {
  static const char *const groups[] = {"", "/previous", "/previous_1"};
  SpaceState *q = j ? &s->old[j - 1] : &s->state;
  PetscFunctionBeginUser;
  PetscCall(MoveVesicles(s, file, write, groups[j], "shape", s->size, q->X));
  PetscCall(MoveVesicles(s, file, write, groups[j], "velocity", s->size, q->U));
  PetscCall(MoveVesicles(s, file, write, groups[j], "tension", s->count, q->sigma));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whole numbers and times; areas and volumes of the first shapes. */
static PetscErrorCode MoveNumbers(SpaceOutput o, H5File *file, PetscBool write) {
  const Space s = o->space;
  PetscInt whole[] = {s->state.step, s->past, o->scheduled, o->record.its, s->state.solved};
  PetscReal real[] = {s->state.t, s->state.dt_last, s->old[0].dt_last, s->old[1].dt_last, s->made.a0}, age[AGE_MEMORY];
  PetscReal *size;
  PetscFunctionBeginUser;
  AgeGetMemory(&s->age, age);
  PetscCall(PetscMalloc1(2 * s->share.own, &size));
  for (PetscInt v = 0; v < s->share.own; v++) {
    size[2 * v] = s->vesicle[v]->setting.area;
    size[2 * v + 1] = s->vesicle[v]->setting.volume;
  }
  if (write) {
    H5Put(file, "numbers", H5_INT, 5, whole);
    H5Put(file, "times", H5_REAL, 5, real);
    H5Put(file, "age", H5_REAL, AGE_MEMORY, age);
  } else {
    PetscCall(H5Get(file, "numbers", H5_INT, 5, whole));
    PetscCall(H5Get(file, "times", H5_REAL, 5, real));
    PetscCall(H5Get(file, "age", H5_REAL, AGE_MEMORY, age));
  }
  PetscCall(MoveVesicles(s, file, write, "", "size", 2, size));
  PetscCall(RestartEntries(o->scene, file));
  for (PetscInt v = 0; v < s->share.own && !write; v++) {
    s->vesicle[v]->setting.area = size[2 * v];
    s->vesicle[v]->setting.volume = size[2 * v + 1];
  }
  PetscCall(PetscFree(size));
  s->state.step = whole[0];
  s->past = PetscClipInterval(whole[1], 0, BDF_MOST - 1);
  o->scheduled = whole[2];
  o->record.its = whole[3];
  s->state.solved = whole[4] ? PETSC_TRUE : PETSC_FALSE;
  s->state.t = real[0];
  s->state.dt_last = real[1];
  for (int j = 0; j < BDF_MOST - 1; j++) s->old[j].dt_last = real[2 + j];
  s->made.a0 = real[4];
  s->age = AgeSetMemory(age);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MoveAll(SpaceOutput o, H5File *file, PetscBool write) {
  const Space s = o->space;
  PetscFunctionBeginUser;
  PetscCall(MoveNumbers(o, file, write));
  for (PetscInt j = 0; j <= s->past; j++) PetscCall(MoveState(s, file, write, j));
  if (s->made.a0 > 0) PetscCall(MoveVesicles(s, file, write, "/solver", "shape", s->size, s->made.X));
  if (s->made.a0 > 0) PetscCall(MoveVesicles(s, file, write, "/solver", "tension", s->count, s->made.sigma));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteCheckpoint(void *output, H5File *file) {
  const SpaceOutput o = output;
  PetscFunctionBeginUser;
  PetscCall(CheckpointPutScene(file, o->scene));
  H5PutText(file, "series_row", o->record.text);
  PetscCall(MoveAll(o, file, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceCheckpoint(SpaceOutput o) {
  PetscLogDouble start, end;
  PetscFunctionBeginUser;
  if (o->checkpoint.step == o->space->state.step) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscTime(&start));
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  PetscCall(FolderCheckOwn(&o->folder));
  PetscCall(SeriesFlush(&o->series, PETSC_TRUE));
  PetscCall(AppendedFlush(&o->frames, PETSC_TRUE));
  PetscCall(CheckpointStore(&o->checkpoint, o->space->state.step, WriteCheckpoint, o));
  PetscCall(PhaseEnd());
  PetscCall(PetscTime(&end));
  o->checkpoint_seconds = PetscMax(o->checkpoint_seconds, end - start);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceRestart(SpaceOutput o) {
  H5File file;
  char *text;
  PetscFunctionBeginUser;
  PetscCall(RestartOpen(o->scene, &file));
  PetscErrorCode error = MoveAll(o, &file, PETSC_FALSE);
  if (!error) error = H5GetText(&file, "series_row", &text);
  if (!error) error = RestartEntries(o->scene, &file);
  H5FileClose(&file);
  PetscCall(error);
  PetscCall(PetscStrncpy(o->record.text, text, o->record.room));
  PetscCall(PetscFree(text));
  PetscCall(SpaceRecall(o->space));
  PetscFunctionReturn(PETSC_SUCCESS);
}
