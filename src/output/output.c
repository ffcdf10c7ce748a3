#include "output/output.h"

/* The first multiple of -output_every after the present time. */
static PetscReal OutputNextTime(Output o) {
  const Model *m = o->model;
  const PetscReal every = m->scene->output.every;
  return StepDecimal(every * (PetscFloorReal((*m->t + 1e-9 * *m->dt) / every) + 1));
}

/* run.h5: new, or that of an earlier run, cut to its scheduled frames. A frame that was saved only because that run
   ended goes. */
static PetscErrorCode OutputOpenFrames(Output o) {
  const Model *m = o->model;
  AppendedKind kind = {
      .name = "run.h5", .entries = "frames", .now = *m->t, .context = m->context, .describe = m->ops.describe};
  PetscFunctionBeginUser;
  PetscCall(m->ops.series(m->context, &kind));
  PetscCall(
      AppendedOpen(&o->frames, &o->folder, &kind, o->go_on ? o->scheduled : APPENDED_NEW, m->scene->output.restart));
  o->scheduled = o->frames.count;
  if (o->scheduled) o->shown = o->frames.time[o->scheduled - 1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The files of a new run, which begin with the checkpoint's state after a restart in a new folder; or those of an
   earlier run, cut to what its checkpoint counts. Nothing of it is changed before all of it has been found good. */
static PetscErrorCode OutputOpenFiles(Output o) {
  const Model *m = o->model;
  const char *restart = m->scene->output.restart;
  static const char *const files[] = {"run.h5", "run.h5.new", "vesicles.h5", "vesicles.h5.new"};
  PetscInt rows = APPENDED_NEW;
  PetscFunctionBeginUser;
  if (o->go_on) PetscCall(SeriesCut(&o->series, &o->folder, o->record.header, *m->step, restart, &rows));
  FolderRemove(&o->folder, "summary.json"); /* what would be taken for this run's, as checkpoints are */
  for (int k = 0; k < 4 && !o->go_on; k++) FolderRemove(&o->folder, files[k]);
  if (!o->go_on) CheckpointClear(&o->folder);
  PetscCall(OutputOpenFrames(o));
  PetscCall(VesicleFileOpen(&o->vesicles, &o->folder, &m->columns, *m->t, rows, restart));
  if (o->go_on) PetscCall(XdmfWrite(&o->xdmf, &o->frames));
  PetscCall(SeriesOpen(&o->series, &o->folder, o->record.header, o->record.text));
  if (o->go_on) PetscCall(CheckpointAdopt(&o->checkpoint, restart));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputCreate(const Model *model, Output *out) {
  const Scene scene = model->scene;
  Output o;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&o));
  *out = o;
  o->model = model;
  PetscCall(RecordCreate(&model->columns, &o->record));
  PetscCall(FolderOpen(scene->comm, scene->output.dir, &o->folder));
  if (*scene->output.restart) PetscCall(RestartRead(model, &o->record, &o->scheduled));
  PetscCall(FolderMake(&o->folder));
  PetscCall(FolderClaim(&o->folder, scene->output.restart, scene->output.overwrite, &o->go_on));
  o->checkpoint = (Checkpoint){.folder = &o->folder, .keep = scene->output.checkpoint_keep, .step = -1};
  o->xdmf = (Xdmf){.folder = &o->folder, .print = model->ops.print, .context = model->context, .file = -1};
  PetscCall(OutputOpenFiles(o));
  o->summary = (Summary){.folder = &o->folder, .model = model, .record = &o->record};
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
  PetscCall(AppendedClose(&o->frames, &good[1]));
  good[2] = XdmfClose(&o->xdmf);
  PetscCall(AppendedClose(&o->vesicles, &good[3]));
  PetscCall(RecordDestroy(&o->record));
  FolderRelease(&o->folder);
  folder = o->folder;
  PetscCall(PetscFree(o));
  if (!*folder.path || folder.failed) PetscFunctionReturn(PETSC_SUCCESS); /* no folder, or its error is known */
  for (int k = 0; k < 4; k++) PetscCall(FolderCheck(&folder, good[k], names[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vesicles' own columns of the present state, on every rank. */
static PetscErrorCode OutputMeasure(Output o) {
  const Model *m = o->model;
  PetscMPIInt size;
  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(m->columns.vesicles * m->columns.columns, &size));
  PetscCall(PetscArrayzero(o->record.each, size));
  PetscCall(m->ops.measure(m->context, o->record.each, o->record.last));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, o->record.each, size, MPIU_REAL, MPI_SUM, m->scene->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A row of the present state and the last step. */
static PetscErrorCode OutputWriteRow(Output o) {
  const Model *m = o->model;
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  PetscCall(FolderCheckOwn(&o->folder));
  PetscCall(PetscArrayzero(o->record.last, m->columns.columns + m->columns.extras));
  PetscCall(m->ops.row(m->context, o->record.last));
  PetscCall(OutputMeasure(o));
  RecordCombine(&o->record);
  SeriesWrite(&o->series, o->record.text);
  PetscCall(VesicleFileWrite(&o->vesicles, &o->record, *m->step, *m->t));
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A frame of the present state, in run.h5 and run.xmf. It replaces a frame that is not scheduled, where a run goes on
   after its end. The rows so far go with it. */
static PetscErrorCode OutputWriteFrame(Output o, PetscBool scheduled) {
  const Model *m = o->model;
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  o->frames.count = o->scheduled;
  PetscCall(m->ops.frame(m->context, &o->frames));
  PetscCall(AppendedFlush(&o->frames, PETSC_FALSE)); /* values before the time by which readers count them */
  PetscCall(AppendedAdd(&o->frames, *m->t));
  PetscCall(AppendedFlush(&o->frames, PETSC_FALSE));
  if (scheduled) o->scheduled = o->frames.count;
  o->shown = *m->t;
  PetscCall(SeriesFlush(&o->series, PETSC_FALSE));
  PetscCall(AppendedFlush(&o->vesicles, PETSC_FALSE));
  PetscCall(XdmfWrite(&o->xdmf, &o->frames));
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputCheckpoint(Output o) {
  PetscLogDouble start, end;
  PetscFunctionBeginUser;
  if (o->checkpoint.step == *o->model->step) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscTime(&start));
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  PetscCall(FolderCheckOwn(&o->folder));
  PetscCall(SeriesFlush(&o->series, PETSC_TRUE));
  PetscCall(AppendedFlush(&o->frames, PETSC_TRUE));
  PetscCall(AppendedFlush(&o->vesicles, PETSC_TRUE));
  PetscCall(CheckpointWrite(&o->checkpoint, o->model, o->record.text, o->scheduled));
  PetscCall(PhaseEnd());
  PetscCall(PetscTime(&end));
  o->checkpoint_seconds = PetscMax(o->checkpoint_seconds, end - start);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputBegin(Output o) {
  const Model *m = o->model;
  const PetscBool restarted = *m->scene->output.restart != 0;
  PetscFunctionBeginUser;
  if (restarted) /* the checkpoint's row is there already, but for its vesicles in a new folder */
    PetscCall(OutputMeasure(o));
  else
    PetscCall(OutputWriteRow(o));
  if (restarted && !o->go_on) PetscCall(VesicleFileWrite(&o->vesicles, &o->record, *m->step, *m->t));
  if (!o->go_on) PetscCall(OutputWriteFrame(o, PETSC_TRUE));
  o->next = OutputNextTime(o);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputStep(Output o) {
  const Model *m = o->model;
  const PetscInt every = m->scene->output.checkpoint_every;
  PetscFunctionBeginUser;
  PetscCall(OutputWriteRow(o));
  if (m->ops.watch) PetscCall(m->ops.watch(m->context, o->record.last));
  if (*m->t >= o->next - 1e-9 * *m->dt) {
    PetscCall(OutputWriteFrame(o, PETSC_TRUE));
    o->next = OutputNextTime(o);
  }
  if (every && *m->step % every == 0) PetscCall(OutputCheckpoint(o));
  PetscCall(SummaryProgress(&o->summary, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputEnd(Output o, const char reason[], const char failure[]) {
  PetscFunctionBeginUser;
  PetscCall(FolderCheckOwn(&o->folder));
  PetscCall(OutputCheckpoint(o)); /* first: a frame asks the flow for values, which a caller's own may not have */
  if (*o->model->t > o->shown) PetscCall(OutputWriteFrame(o, PETSC_FALSE));
  PetscCall(SeriesFlush(&o->series, PETSC_FALSE));
  PetscCall(SummaryEnd(&o->summary, o->frames.count, reason, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}
