#include "output/output.h"

/* The first multiple of -output_every after the present time. */
static PetscReal OutputNextTime(Output o) {
  const State *q = &o->scheme->state;
  const PetscReal every = o->scene->output.every;
  return StepDecimal(every * (PetscFloorReal((q->t + 1e-9 * q->dt) / every) + 1));
}

/* The files of a new run, which begin with the checkpoint's state after a restart in a new folder; or those of an
   earlier run, cut to what its checkpoint counts. Nothing of it is changed before all of it has been found good. */
static PetscErrorCode OutputOpenFiles(Output o, PetscInt frames) {
  const char *restart = o->scene->output.restart;
  static const char *const files[] = {"run.h5", "run.h5.new", "vesicles.h5", "vesicles.h5.new"};
  PetscInt rows = APPENDED_NEW;
  PetscFunctionBeginUser;
  if (o->go_on)
    PetscCall(SeriesCut(&o->series, &o->folder, o->record.header, o->scheme->state.step, restart, &rows));
  else
    PetscCall(SeriesPrepare(&o->series, &o->folder, o->record.header, o->record.text));
  FolderRemove(&o->folder, "summary.json"); /* what would be taken for this run's, as checkpoints are */
  for (int k = 0; k < 4 && !o->go_on; k++) FolderRemove(&o->folder, files[k]);
  if (!o->go_on) CheckpointClear(&o->folder);
  PetscCall(FramesOpen(&o->frames, &o->folder, o->scheme, o->go_on ? frames : APPENDED_NEW, restart));
  PetscCall(VesicleFileOpen(&o->vesicles, &o->folder, o->scheme, rows, restart));
  if (o->go_on) PetscCall(XdmfWrite(&o->xdmf, &o->frames.file));
  PetscCall(SeriesOpen(&o->series));
  if (o->go_on) PetscCall(CheckpointAdopt(&o->checkpoint, restart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputCreate(Scene scene, Scheme scheme, Output *out) {
  Output o;
  PetscInt frames = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&o));
  *out = o;
  o->scene = scene;
  o->scheme = scheme;
  PetscCall(RecordCreate(scheme->membrane->layout->bodies, &scene->obstacles, scheme->coupling->forces, &o->record));
  PetscCall(TracersCreate(scene, &o->tracers));
  PetscCall(FolderOpen(scene->comm, scene->output.dir, &o->folder));
  if (*scene->output.restart) PetscCall(RestartRead(scheme, &o->record, &o->tracers, &frames));
  PetscCall(FolderMake(&o->folder));
  PetscCall(FolderClaim(&o->folder, scene->output.restart, scene->output.overwrite, &o->go_on));
  o->checkpoint = (Checkpoint){.folder = &o->folder, .keep = scene->output.checkpoint_keep, .step = -1};
  o->xdmf = (Xdmf){.folder = &o->folder, .print = FramesPrintXdmf, .context = &o->frames, .file = -1};
  o->frames.tracers = &o->tracers;
  PetscCall(OutputOpenFiles(o, frames));
  o->summary = (Summary){.folder = &o->folder, .scheme = scheme, .record = &o->record};
  PetscCall(SummaryBegin(&o->summary));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputDestroy(Output *output) {
  Output o = *output;
  static const char *const names[4] = {"series.csv", "run.h5", "run.xmf", "vesicles.h5"};
  PetscBool good[4];
  Folder folder;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  *output = NULL; /* the output is destroyed also when a file cannot be closed */
  good[0] = SeriesClose(&o->series);
  PetscCall(FramesClose(&o->frames, &good[1]));
  good[2] = XdmfClose(&o->xdmf);
  PetscCall(AppendedClose(&o->vesicles, &good[3]));
  PetscCall(RecordDestroy(&o->record));
  PetscCall(TracersDestroy(&o->tracers));
  FolderRelease(&o->folder);
  folder = o->folder;
  PetscCall(PetscFree(o));
  if (!*folder.path || folder.failed) PetscFunctionReturn(PETSC_SUCCESS); /* no folder, or its error is known */
  for (int k = 0; k < 4; k++) PetscCall(FolderCheck(&folder, good[k], names[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A row of the present state and the last step. */
static PetscErrorCode OutputWriteRow(Output o) {
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  PetscCall(FolderCheckOwn(&o->folder));
  PetscCall(RecordTake(&o->record, o->scheme));
  SeriesWrite(&o->series, o->record.text);
  PetscCall(VesicleFileWrite(&o->vesicles, &o->record, o->scheme->state.step, o->scheme->state.t));
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A frame of the present state, in run.h5 and run.xmf. The rows so far go with it. */
static PetscErrorCode OutputWriteFrame(Output o, PetscBool scheduled) {
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  PetscCall(FramesWrite(&o->frames, scheduled));
  PetscCall(SeriesFlush(&o->series, PETSC_FALSE));
  PetscCall(AppendedFlush(&o->vesicles, PETSC_FALSE));
  PetscCall(XdmfWrite(&o->xdmf, &o->frames.file));
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputCheckpoint(Output o) {
  PetscLogDouble start, end;
  PetscFunctionBeginUser;
  if (o->checkpoint.step == o->scheme->state.step) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscTime(&start));
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  PetscCall(FolderCheckOwn(&o->folder));
  PetscCall(SeriesFlush(&o->series, PETSC_TRUE));
  PetscCall(AppendedFlush(&o->frames.file, PETSC_TRUE));
  PetscCall(AppendedFlush(&o->vesicles, PETSC_TRUE));
  PetscCall(CheckpointWrite(&o->checkpoint, o->scheme, &o->record, &o->tracers, o->frames.scheduled));
  PetscCall(PhaseEnd());
  PetscCall(PetscTime(&end));
  o->checkpoint_seconds = PetscMax(o->checkpoint_seconds, end - start);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputBegin(Output o) {
  const State *q = &o->scheme->state;
  PetscFunctionBeginUser;
  if (*o->scene->output.restart) /* the checkpoint's row is there already, but for its vesicles in a new folder */
    PetscCall(RecordMeasure(&o->record, o->scheme));
  else
    PetscCall(OutputWriteRow(o));
  if (*o->scene->output.restart && !o->go_on) PetscCall(VesicleFileWrite(&o->vesicles, &o->record, q->step, q->t));
  if (!o->go_on) PetscCall(OutputWriteFrame(o, PETSC_TRUE));
  o->next = OutputNextTime(o);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputStep(Output o) {
  const State *q = &o->scheme->state;
  const PetscInt every = o->scene->output.checkpoint_every;
  PetscFunctionBeginUser;
  PetscCall(TracersMove(&o->tracers, o->scheme));
  PetscCall(OutputWriteRow(o));
  if (q->t >= o->next - 1e-9 * q->dt) {
    PetscCall(OutputWriteFrame(o, PETSC_TRUE));
    o->next = OutputNextTime(o);
  }
  if (every && q->step % every == 0) PetscCall(OutputCheckpoint(o));
  PetscCall(SummaryProgress(&o->summary, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputEnd(Output o, const char reason[], const char failure[]) {
  const State *q = &o->scheme->state;
  PetscFunctionBeginUser;
  PetscCall(FolderCheckOwn(&o->folder));
  PetscCall(OutputCheckpoint(o)); /* first: a frame asks the flow for values, which a caller's own may not have */
  if (q->t > o->frames.time) PetscCall(OutputWriteFrame(o, PETSC_FALSE));
  PetscCall(SeriesFlush(&o->series, PETSC_FALSE));
  PetscCall(SummaryEnd(&o->summary, o->frames.file.count, reason, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}
