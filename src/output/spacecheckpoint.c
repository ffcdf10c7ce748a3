/* Checkpoints of runs in three dimensions: the states as coefficients, and what the factors were made for. */
#include "output/spaceoutput.h"

/* Write or read whole numbers and times; a run has had those that are read. */
static PetscErrorCode SpaceMoveNumbers(SpaceOutput o, H5File *file, PetscBool write) {
  SpaceNumbers n = SpaceGetNumbers(o->space);
  PetscInt whole[] = {n.step, n.past, n.order, n.solved, o->scheduled, o->record.its};
  PetscReal real[2 + BDF_MOST + AGE_MEMORY] = {n.t, n.made};
  const PetscInt reals = 2 + BDF_MOST + AGE_MEMORY;
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(real + 2, n.dt_last, BDF_MOST));
  PetscCall(PetscArraycpy(real + 2 + BDF_MOST, n.age, AGE_MEMORY));
  if (write) {
    H5Put(file, "numbers", H5_INT, 6, whole);
    H5Put(file, "times", H5_REAL, reals, real);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(H5Get(file, "numbers", H5_INT, 6, whole));
  PetscCall(H5Get(file, "times", H5_REAL, reals, real));
  PetscBool fits = whole[0] >= 0 && whole[1] >= 0 && whole[1] < BDF_MOST && whole[2] >= 1 && whole[2] <= BDF_MOST &&
                           whole[4] >= 0
                       ? PETSC_TRUE
                       : PETSC_FALSE;
  for (PetscInt k = 0; k < reals; k++)
    if (PetscIsInfOrNanReal(real[k])) fits = PETSC_FALSE;
  if (!fits && !file->rank) file->failed = PETSC_TRUE;
  PetscCall(RestartEntries(o->scene, file));
  n = (SpaceNumbers){
      .step = whole[0], .past = whole[1], .order = whole[2], .solved = whole[3], .t = real[0], .made = real[1]};
  PetscCall(PetscArraycpy(n.dt_last, real + 2, BDF_MOST));
  PetscCall(PetscArraycpy(n.age, real + 2 + BDF_MOST, AGE_MEMORY));
  SpaceSetNumbers(o->space, &n);
  o->scheduled = whole[4];
  o->record.its = whole[5];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write or read the numbers and the arrays [vesicles][each] of all ranks. */
static PetscErrorCode SpaceMoveAll(SpaceOutput o, H5File *file, PetscBool write) {
  const VesicleShare *share = &o->space->share;
  SpaceArray array[SPACE_ARRAYS];
  PetscFunctionBeginUser;
  PetscCall(SpaceMoveNumbers(o, file, write));
  const PetscInt arrays = SpaceArrays(o->space, array);
  for (PetscInt k = 0; k < arrays; k++) {
    const PetscInt n = share->vesicles * array[k].each;
    PetscReal *all;
    PetscCall(PetscCalloc1(n, &all));
    if (write) PetscCall(ShareGather(share, array[k].each, array[k].own, all));
    PetscCall(CheckpointEntry(file, write, array[k].name, share->vesicles, array[k].each, all));
    if (!write) PetscCall(ShareScatter(share, array[k].each, all, array[k].own));
    for (PetscInt i = 0; i < n && !file->rank; i++)
      if (PetscIsInfOrNanReal(all[i])) file->failed = PETSC_TRUE;
    PetscCall(PetscFree(all));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpaceWriteCheckpoint(void *output, H5File *file) {
  const SpaceOutput o = output;
  PetscFunctionBeginUser;
  PetscCall(CheckpointPutScene(file, o->scene));
  H5PutText(file, "series_row", o->record.text);
  PetscCall(SpaceMoveAll(o, file, PETSC_TRUE));
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
  PetscCall(CheckpointStore(&o->checkpoint, o->space->state.step, SpaceWriteCheckpoint, o));
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
  PetscErrorCode error = SpaceMoveAll(o, &file, PETSC_FALSE);
  if (!error) error = H5GetText(&file, "series_row", &text);
  if (!error) error = RestartEntries(o->scene, &file);
  H5FileClose(&file);
  PetscCall(error);
  PetscCall(PetscStrncpy(o->record.text, text, o->record.room));
  PetscCall(PetscFree(text));
  PetscCall(SpaceRecall(o->space));
  PetscFunctionReturn(PETSC_SUCCESS);
}
