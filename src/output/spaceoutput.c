#include "output/spaceoutput.h"

#define ROUGH 0.01 /* spectrum_tail from which on a higher degree is due */

static void SpaceOutputNextTime(SpaceOutput o) {
  const PetscReal every = o->scene->output.every, dt = o->space->setting.policy.base;
  o->next = StepDecimal(every * (PetscFloorReal((o->space->state.t + 1e-9 * dt) / every) + 1));
}

static PetscErrorCode SpaceOutputOptions(FILE *file, const void *scene) {
  return SummaryPrintOptions((Scene)scene, NULL, file);
}

PetscErrorCode SpaceOutputCreate(Scene scene, Space space, SpaceOutput *out) {
  const char *restart = scene->output.restart;
  SpaceOutput o;
  PetscInt rows;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&o));
  *out = o;
  o->scene = scene;
  o->space = space;
  PetscCall(SpaceRecordCreate(space, &o->record));
  PetscCall(FolderOpen(scene->comm, scene->output.dir, &o->folder));
  if (*restart) PetscCall(SpaceRestart(o));
  PetscCall(FolderMake(&o->folder));
  PetscCall(FolderClaim(&o->folder, restart, scene->output.overwrite, &o->go_on));
  o->checkpoint = (Checkpoint){.folder = &o->folder, .keep = scene->output.checkpoint_keep, .step = -1};
  o->xdmf = (Xdmf){.folder = &o->folder, .print = SpaceFramesPrint, .context = o, .file = -1};
  if (o->go_on)
    PetscCall(SeriesCut(&o->series, &o->folder, o->record.header, space->state.step, restart, &rows));
  else
    PetscCall(SeriesPrepare(&o->series, &o->folder, o->record.header, o->record.text));
  FolderRemove(&o->folder, "summary.json");
  for (int k = 0; k < 2 && !o->go_on; k++) FolderRemove(&o->folder, k ? "run.h5.new" : "run.h5");
  if (!o->go_on) CheckpointClear(&o->folder);
  PetscCall(SpaceFramesOpen(o));
  if (o->go_on) PetscCall(XdmfWrite(&o->xdmf, &o->frames));
  PetscCall(SeriesOpen(&o->series));
  if (o->go_on) PetscCall(CheckpointAdopt(&o->checkpoint, restart));
  PetscCall(FolderWriteText(&o->folder, "resolved.opts", SpaceOutputOptions, scene));
  o->clock = ProgressBegin(space->state.t, scene->time.end);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceOutputDestroy(SpaceOutput *output) {
  SpaceOutput o = *output;
  static const char *const names[3] = {"series.csv", "run.h5", "run.xmf"};
  PetscBool good[3];
  Folder folder;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  *output = NULL; /* destroyed also when a file cannot be closed */
  good[0] = SeriesClose(&o->series);
  PetscCall(AppendedClose(&o->frames, &good[1]));
  good[2] = XdmfClose(&o->xdmf);
  PetscCall(SpaceRecordDestroy(&o->record));
  PetscCall(PetscFree(o->Y));
  FolderRelease(&o->folder);
  folder = o->folder;
  PetscCall(PetscFree(o));
  if (!*folder.path || folder.failed) PetscFunctionReturn(PETSC_SUCCESS); /* no folder, or its error is known */
  for (int k = 0; k < 3; k++) PetscCall(FolderCheck(&folder, good[k], names[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpaceOutputRow(SpaceOutput o) {
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  PetscCall(FolderCheckOwn(&o->folder));
  PetscCall(SpaceRecordTake(&o->record));
  SeriesWrite(&o->series, o->record.text);
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A warning, once, when the degree is too small. */
static PetscErrorCode SpaceOutputWarn(SpaceOutput o) {
  const PetscReal tail = o->record.last[SPACE_TAIL];
  PetscFunctionBeginUser;
  if (tail < ROUGH || *o->warning) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(o->warning, sizeof(o->warning),
                          "the spherical harmonics do not resolve a vesicle after step %" PetscInt_FMT
                          ", time %g: spectrum_tail is %.2g; try -sphere_degree %" PetscInt_FMT,
                          o->space->state.step, (double)o->space->state.t, (double)tail, o->space->sphere->p + 4));
  PetscCall(PetvesSay(o->scene->comm, "petves: warning: %s\n", o->warning));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpaceOutputFrame(SpaceOutput o, PetscBool scheduled) {
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  PetscCall(SpaceFramesWrite(o, scheduled));
  PetscCall(SeriesFlush(&o->series, PETSC_FALSE));
  PetscCall(XdmfWrite(&o->xdmf, &o->frames));
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceOutputBegin(SpaceOutput o) {
  PetscFunctionBeginUser;
  if (*o->scene->output.restart) /* the checkpoint's row is there already */
    PetscCall(SpaceRecordMeasure(&o->record));
  else
    PetscCall(SpaceOutputRow(o));
  if (!o->go_on) PetscCall(SpaceOutputFrame(o, PETSC_TRUE));
  SpaceOutputNextTime(o);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceOutputStep(SpaceOutput o) {
  const SpaceState *q = &o->space->state;
  const PetscInt every = o->scene->output.checkpoint_every;
  PetscFunctionBeginUser;
  PetscCall(SpaceOutputRow(o));
  PetscCall(SpaceOutputWarn(o));
  if (q->t >= o->next - 1e-9 * o->space->report.dt) {
    PetscCall(SpaceOutputFrame(o, PETSC_TRUE));
    SpaceOutputNextTime(o);
  }
  if (every && q->step % every == 0) PetscCall(SpaceCheckpoint(o));
  PetscCall(ProgressSay(&o->clock, o->scene->comm, q->step, q->t, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpaceOutputSummary(FILE *f, const void *output) {
  const SpaceOutput o = (SpaceOutput)output;
  fprintf(f, "{\n  \"reason\": ");
  SummaryPrintString(f, o->reason);
  fprintf(f, ",\n  \"last\": {");
  for (int c = 0; c < SPACE_COUNT; c++)
    fprintf(f, PetscIsNanReal(o->record.last[c]) ? "%s\"%s\": null" : "%s\"%s\": %.17g", c ? ", " : "", SpaceColumns[c],
            (double)o->record.last[c]);
  fprintf(f, "},\n  \"totals\": {\"steps\": %d, \"coupled_its\": %d},\n  \"dim\": 3,\n  \"degree\": %d,\n",
          (int)o->space->state.step, (int)o->record.its, (int)o->space->sphere->p);
  fprintf(f, "  \"vesicles\": %d,\n  \"written\": {\"frames\": %d},\n  \"warnings\": [", (int)o->space->share.vesicles,
          (int)o->frames.count);
  if (*o->warning) SummaryPrintString(f, o->warning);
  fprintf(f, "],\n");
  SummaryPrintOrigin(f);
  return PETSC_SUCCESS;
}

PetscErrorCode SpaceOutputEnd(SpaceOutput o, const char reason[], const char failure[]) {
  const SpaceState *q = &o->space->state;
  PetscFunctionBeginUser;
  PetscCall(FolderCheckOwn(&o->folder));
  PetscCall(SpaceCheckpoint(o));
  if (q->t > o->shown) PetscCall(SpaceOutputFrame(o, PETSC_FALSE));
  PetscCall(SeriesFlush(&o->series, PETSC_FALSE));
  o->reason = failure ? failure : reason;
  PetscCall(FolderWriteText(&o->folder, "summary.json", SpaceOutputSummary, o));
  PetscCall(ProgressSay(&o->clock, o->scene->comm, q->step, q->t, PETSC_TRUE));
  PetscCall(PetvesSay(o->scene->comm,
                      "\n%s at time %g after %" PetscInt_FMT " steps, %.1f iterations a step; files in %s\n",
                      failure ? "stopped" : reason, (double)q->t, q->step,
                      (double)o->record.its / (double)PetscMax(1, q->step), o->folder.path));
  PetscFunctionReturn(PETSC_SUCCESS);
}
