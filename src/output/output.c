#include "output/output.h"
#include "output/lock.h"
#include "output/resolved.h"
#include "output/restart.h"
#include "output/summary.h"

/* The first multiple of -output_every after the present time. */
static PetscReal NextTime(Output o) {
  const State *q = &o->scheme->state;
  const PetscReal every = o->scene->output.every;
  return every * (PetscFloorReal((q->t + 1e-9 * q->dt) / every) + 1);
}

/* Remove what would be taken for this run's: the summary, and checkpoints of a run that is written over. */
static PetscErrorCode ClearFolder(Output o) {
  PetscFunctionBeginUser;
  PetscCall(FolderRemove(&o->folder, "summary.json"));
  if (o->go_on) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FolderRemove(&o->folder, "run.h5"));
  PetscCall(FolderRemove(&o->folder, "run.h5.new"));
  PetscCall(FolderRemove(&o->folder, "vesicles.h5"));
  PetscCall(FolderRemove(&o->folder, "vesicles.h5.new"));
  PetscCall(CheckpointClear(&o->folder));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The files of a new run; after a restart in a new folder they begin with the checkpoint's state. */
static PetscErrorCode BeginFiles(Output o) {
  PetscFunctionBeginUser;
  PetscCall(SeriesPrepare(&o->series, &o->folder, o->record.header, o->record.text));
  PetscCall(ClearFolder(o));
  PetscCall(FramesCreate(&o->frames, &o->folder, o->scheme));
  PetscCall(VesicleFileCreate(&o->vesicles, &o->folder, o->scheme));
  PetscCall(SeriesOpen(&o->series));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The files of an earlier run, cut to what its checkpoint counts. Nothing of it is changed before all of it has been
   found good. */
static PetscErrorCode GoOnWithFiles(Output o, PetscInt frames) {
  const char *restart = o->scene->output.restart;
  PetscReal *markers;
  PetscFunctionBeginUser;
  PetscCall(SeriesCut(&o->series, &o->folder, o->record.header, o->scheme->state.step, restart));
  PetscCall(ClearFolder(o));
  PetscCall(FramesGoOn(&o->frames, &o->folder, o->scheme, frames, restart));
  PetscCall(VesicleFileGoOn(&o->vesicles, &o->folder, o->scheme, o->scheme->state.step, restart));
  PetscCall(FramesMarkers(&o->frames, &markers));
  PetscCall(XdmfGoOn(&o->xdmf, frames, o->frames.grown.time, markers));
  PetscCall(PetscFree(markers));
  PetscCall(SeriesOpen(&o->series));
  PetscCall(CheckpointAdopt(&o->checkpoint, restart));
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
  PetscCall(RecordCreate(scheme->membrane->layout->bodies, &scene->obstacles, &o->record));
  PetscCall(GatheredCreate(&scheme->state, &o->now));
  PetscCall(FolderOpen(scene->comm, scene->output.dir, &o->folder));
  if (*scene->output.restart) PetscCall(RestartRead(scheme, &o->record, &frames));
  PetscCall(FolderMake(&o->folder));
  PetscCall(FolderClaim(&o->folder, scene->output.restart, scene->output.overwrite, &o->go_on));
  PetscCall(CheckpointCreate(&o->checkpoint, &o->folder, scene->output.checkpoint_keep));
  PetscCall(XdmfCreate(&o->xdmf, &o->folder, scheme));
  PetscCall(o->go_on ? GoOnWithFiles(o, frames) : BeginFiles(o));
  PetscCall(ResolvedWrite(&o->folder, scheme));
  PetscCall(ProgressStart(&o->progress, scene->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputDestroy(Output *output) {
  Output o = *output;
  static const char *const names[4] = {"series.csv", "run.h5", "run.xmf", "vesicles.h5"};
  char path[PETSC_MAX_PATH_LEN];
  PetscBool good[4];
  PetscInt bad = 0;
  Folder folder;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  *output = NULL; /* it is gone also when a file cannot be closed */
  PetscCall(SeriesClose(&o->series, &good[0]));
  PetscCall(FramesClose(&o->frames, &good[1]));
  PetscCall(XdmfClose(&o->xdmf, &good[2]));
  PetscCall(VesicleFileClose(&o->vesicles, &good[3]));
  PetscCall(RecordDestroy(&o->record));
  PetscCall(GatheredDestroy(&o->now));
  FolderRelease(&o->folder);
  folder = o->folder;
  PetscCall(PetscFree(o));
  if (!*folder.path || folder.failed) PetscFunctionReturn(PETSC_SUCCESS); /* no folder, or its error is known */
  while (bad < 4 && good[bad]) bad++;
  PetscCallMPI(MPI_Bcast(&bad, 1, MPIU_INT, 0, folder.comm));
  PetscCall(FolderPath(&folder, names[PetscMin(bad, 3)], path));
  PetscCall(FolderCheck(&folder, bad == 4, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vesicles' rows of the present state. */
static PetscErrorCode WriteVesicles(Output o) {
  const State *q = &o->scheme->state;
  PetscFunctionBeginUser;
  PetscCall(VesicleFileWrite(&o->vesicles, &o->record, q->step, q->t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A row of the present state and the last step. */
static PetscErrorCode WriteRow(Output o) {
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  PetscCall(FolderCheckOwn(&o->folder));
  PetscCall(RecordTake(&o->record, o->scheme));
  PetscCall(SeriesWrite(&o->series, o->record.text));
  PetscCall(WriteVesicles(o));
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A frame of the present state, in run.h5 and run.xmf. The rows so far go with it. */
static PetscErrorCode WriteFrame(Output o, PetscBool scheduled) {
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  PetscCall(GatherState(&o->scheme->state, &o->now));
  PetscCall(FramesWrite(&o->frames, &o->now, scheduled));
  PetscCall(SeriesFlush(&o->series, PETSC_FALSE));
  PetscCall(VesicleFileFlush(&o->vesicles, PETSC_FALSE));
  PetscCall(XdmfWrite(&o->xdmf, o->frames.grown.count - 1, o->frames.time, o->now.markers));
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
  PetscCall(FramesSync(&o->frames));
  PetscCall(VesicleFileFlush(&o->vesicles, PETSC_TRUE));
  PetscCall(CheckpointWrite(&o->checkpoint, o->scheme, &o->record, o->frames.scheduled));
  PetscCall(PhaseEnd());
  PetscCall(PetscTime(&end));
  o->checkpoint_seconds = PetscMax(o->checkpoint_seconds, end - start);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputBegin(Output o) {
  PetscFunctionBeginUser;
  if (*o->scene->output.restart) /* the checkpoint's row is there already, but for its vesicles in a new folder */
    PetscCall(RecordMeasure(&o->record, o->scheme));
  else
    PetscCall(WriteRow(o));
  if (*o->scene->output.restart && !o->go_on) PetscCall(WriteVesicles(o));
  if (!o->go_on) PetscCall(WriteFrame(o, PETSC_TRUE));
  o->next = NextTime(o);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputStep(Output o) {
  const State *q = &o->scheme->state;
  const PetscInt every = o->scene->output.checkpoint_every;
  PetscFunctionBeginUser;
  PetscCall(WriteRow(o));
  if (q->t >= o->next - 1e-9 * q->dt) {
    PetscCall(WriteFrame(o, PETSC_TRUE));
    o->next = NextTime(o);
  }
  if (every && q->step % every == 0) PetscCall(OutputCheckpoint(o));
  PetscCall(ProgressLine(&o->progress, q, o->scene->time.end, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputEnd(Output o, const char reason[], const char failure[]) {
  const State *q = &o->scheme->state;
  Written written;
  PetscFunctionBeginUser;
  PetscCall(FolderCheckOwn(&o->folder));
  PetscCall(OutputCheckpoint(o)); /* first: a frame asks the flow for values, which a caller's own may not have */
  if (q->t > o->frames.time) PetscCall(WriteFrame(o, PETSC_FALSE));
  PetscCall(SeriesFlush(&o->series, PETSC_FALSE));
  PetscCall(WrittenCount(&o->folder, o->frames.grown.count, o->checkpoint.keep, &written));
  PetscCall(SummaryWrite(&o->folder, o->scheme, &o->record, &written, ProgressSeconds(&o->progress),
                         failure ? failure : reason));
  PetscCall(ProgressLine(&o->progress, q, o->scene->time.end, PETSC_TRUE));
  PetscCall(ProgressTable(&o->progress, &o->record, o->folder.path, &written, failure ? "stopped" : reason));
  PetscFunctionReturn(PETSC_SUCCESS);
}
