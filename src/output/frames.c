#include "output/frames.h"
#include "output/cells.h"
#include "output/lock.h"

static PetscErrorCode Begin(Frames *f, Folder *folder, Scheme scheme, char path[PETSC_MAX_PATH_LEN]) {
  const Grid g = scheme->fluid->grid;
  PetscFunctionBeginUser;
  f->folder = folder;
  f->scheme = scheme;
  PetscCall(FolderPath(folder, "run.h5", path));
  const PetscInt n = g->n[0] * g->rows[FIELD_P];
  PetscCall(PetscMalloc3(n, &f->cells[0], n, &f->cells[1], n, &f->cells[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stop every rank when the file could not be written. It is closed at once: HDF5 crashes at the program's end where a
   file is open that it cannot write. */
static PetscErrorCode Check(Frames *f) {
  PetscFunctionBeginUser;
  if (f->file.failed) PetscCall(H5FileClose(&f->file));
  PetscCall(FolderCheck(f->folder, !f->file.failed, f->file.path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesCreate(Frames *f, Folder *folder, Scheme scheme) {
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  PetscCall(Begin(f, folder, scheme, path));
  PetscCall(FrameFileCreate(scheme, path, &f->file));
  f->open = PETSC_TRUE;
  PetscCall(Check(f));
  FolderWatch(folder, "run.h5");
  PetscCall(FrameIndexOpen(&f->index, folder, scheme, &f->file, 0, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Drop the frames from `count` on. */
static PetscErrorCode Cut(Frames *f, const char restart[]) {
  H5File *file = &f->file;
  PetscBool failed;
  PetscFunctionBeginUser;
  PetscCall(H5TruncateSeries(file, "/time", f->count)); /* the readers' count of frames goes first */
  PetscCall(H5FileFlush(file));
  for (int k = 0; k < FrameSeriesCount(f->scheme); k++) PetscCall(H5TruncateSeries(file, FrameSeries[k], f->count));
  PetscCall(H5FileFlush(file));
  PetscCall(H5FileFailed(file, &failed));
  if (failed) PetscCall(H5FileClose(file));
  PetvesCheck(!failed, file->comm,
              "-restart %s: %s cannot be cut to the %" PetscInt_FMT
              " readable frames that the checkpoint counts; allowed: run.h5 as the run left it, or a new -output_dir",
              restart, file->path, f->count);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesGoOn(Frames *f, Folder *folder, Scheme scheme, PetscInt scheduled, const char restart[]) {
  char path[PETSC_MAX_PATH_LEN];
  PetscBool failed;
  PetscInt length;
  PetscFunctionBeginUser;
  PetscCall(Begin(f, folder, scheme, path));
  PetscCall(FrameIndexRepair(folder, scheme, scheduled));
  PetscCall(H5FileOpen(folder->comm, path, PETSC_TRUE, &f->file));
  f->open = PETSC_TRUE;
  PetscCall(H5SeriesLength(&f->file, "/time", &length));
  PetscCall(H5FileFailed(&f->file, &failed));
  PetvesCheck(!failed && length >= scheduled, folder->comm,
              "-restart %s: %s has %" PetscInt_FMT " readable frames, the checkpoint counts %" PetscInt_FMT
              "; allowed: run.h5 as the run left it, or a new -output_dir",
              restart, path, length, scheduled);
  f->count = f->scheduled = scheduled;
  PetscCall(PetscMalloc1(scheduled, &f->times));
  for (PetscInt t = 0; t < scheduled; t++) PetscCall(H5ReadArray(&f->file, "/time", t, 1, &f->times[t]));
  if (scheduled) f->time = f->times[scheduled - 1];
  PetscCall(FrameIndexOpen(&f->index, folder, scheme, &f->file, scheduled, f->times)); /* before anything is changed */
  PetscCall(Cut(f, restart));
  FolderWatch(folder, "run.h5");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The values of the present frame, at entry `count`. */
static PetscErrorCode WriteValues(Frames *f, const Gathered *now) {
  const Grid g = f->scheme->fluid->grid;
  const PetscReal *const marker[3] = {now->markers, now->velocity, now->tension};
  PetscFunctionBeginUser;
  PetscCall(CellFields(f->scheme, f->cells[0], f->cells[1], f->cells[2]));
  for (int c = 0; c < 3; c++) PetscCall(H5WriteField(&f->file, FrameSeries[c], f->count, g, FIELD_P, f->cells[c]));
  for (int k = 0; k < 3 && now->M; k++)
    PetscCall(H5WriteArray(&f->file, FrameSeries[3 + k], f->count, k < 2 ? 2 * now->M : now->M, marker[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesWrite(Frames *f, const Gathered *now, PetscBool scheduled) {
  const PetscReal t = f->scheme->state.t;
  PetscFunctionBeginUser;
  f->count = f->scheduled;
  PetscCall(WriteValues(f, now));
  PetscCall(H5FileFlush(&f->file));
  PetscCall(FrameIndexAppend(&f->index, &f->file, f->count, t));
  PetscCall(H5WriteArray(&f->file, "/time", f->count, 1, &t)); /* last: readers count the frames by it */
  PetscCall(H5FileFlush(&f->file));
  PetscCall(Check(f));
  f->count++;
  if (scheduled) f->scheduled = f->count;
  f->time = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesSync(Frames *f) {
  PetscFunctionBeginUser;
  PetscCall(H5FileFlush(&f->file));
  if (!f->folder->rank && (FileSync(f->file.path) || FrameIndexSync(&f->index))) f->file.failed = PETSC_TRUE;
  PetscCall(Check(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesClose(Frames *f, PetscBool *good) {
  const PetscBool known = f->open ? f->file.failed : PETSC_FALSE; /* said when it was found */
  PetscFunctionBeginUser;
  *good = PETSC_TRUE;
  if (f->open) {
    PetscCall(H5FileClose(&f->file));
    PetscCall(FrameIndexClose(&f->index, !f->file.failed && !f->folder->failed));
    *good = !f->file.failed || known ? PETSC_TRUE : PETSC_FALSE;
  }
  f->open = PETSC_FALSE;
  PetscCall(PetscFree3(f->cells[0], f->cells[1], f->cells[2]));
  PetscCall(PetscFree(f->times));
  PetscFunctionReturn(PETSC_SUCCESS);
}
