/* run.h5.index: where in run.h5 the frames lie, while a run writes on it. HDF5 changes its tables in place, so that a
   process that is killed can leave a file that cannot be read, or not be written on. The frames themselves never move:
   with their places they are copied into a new file. A run that closes run.h5 removes the index. */
#include "output/output.h"
#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

const char *const FrameSeries[FRAME_SERIES] = {"/fluid/u",         "/fluid/v",          "/fluid/p",
                                               "/vesicle/markers", "/vesicle/velocity", "/vesicle/tension"};

PetscInt FrameSeriesCount(Output o) {
  return o->scheme->membrane->M ? FRAME_SERIES : 3;
}

/* Numbers in one frame of a series. */
static PetscInt Entries(Output o, PetscInt k) {
  const Grid g = o->scheme->fluid->grid;
  if (k < 3) return g->n[0] * g->n[1];
  return o->scheme->membrane->M * (k < 5 ? 2 : 1);
}

PetscErrorCode FramesAppend(Output o, PetscInt frame, PetscReal t) {
  PetscBool done = PETSC_TRUE;
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  if (!o->rank && o->index) {
    fprintf(o->index, "%d %.17g", (int)frame, (double)t);
    for (PetscInt k = 0; k < FrameSeriesCount(o); k++)
      fprintf(o->index, " %llu", (unsigned long long)H5FramePlace(&o->fields, FrameSeries[k], frame));
    fprintf(o->index, "\n");
    done = !fflush(o->index) && !ferror(o->index) ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCall(OutputPath(o, "run.h5.index", path));
  PetscCall(OutputCheck(o, done, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesOpen(Output o) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  PetscBool done = PETSC_TRUE;
  PetscFunctionBeginUser;
  PetscCall(OutputPath(o, "run.h5.index", path));
  PetscCall(OutputPath(o, "run.h5.index.tmp", temporary));
  if (!o->rank) {
    o->index = fopen(temporary, "w");
    done = o->index ? PETSC_TRUE : PETSC_FALSE;
  }
  PetscCall(OutputCheck(o, done, path));
  for (PetscInt t = 0; t < o->frames; t++) PetscCall(FramesAppend(o, t, o->times[t]));
  if (!o->rank) done = o->fields.failed ? !unlink(temporary) : !rename(temporary, path);
  PetscCall(OutputCheck(o, done, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int FramesSync(Output o) {
  return o->index && (fflush(o->index) || fsync(fileno(o->index)));
}

PetscErrorCode FramesClose(Output o, PetscBool closed) {
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  if (!o->index) PetscFunctionReturn(PETSC_SUCCESS);
  (void)fclose(o->index);
  o->index = NULL;
  PetscCall(OutputPath(o, "run.h5.index", path));
  if (closed) (void)unlink(path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One line of the index: the frame, its time and places. */
static PetscBool ReadPlaces(FILE *index, PetscInt n, PetscInt *frame, PetscReal *t, unsigned long long place[]) {
  char line[512], *p = line;
  if (!fgets(line, sizeof(line), index) || !strchr(line, '\n')) return PETSC_FALSE;
  *frame = (PetscInt)strtol(p, &p, 10);
  *t = strtod(p, &p);
  for (PetscInt k = 0; k < n; k++) {
    char *end;
    place[k] = strtoull(p, &end, 10);
    if (end == p || !place[k]) return PETSC_FALSE;
    p = end;
  }
  return PETSC_TRUE;
}

/* Copy the frames that the checkpoint counts into the new file `f`; the number that could be read. A frame may have
   several lines, where a run went on after its end: the last one holds. */
static PetscErrorCode CopyFrames(Output o, FILE *index, int old, H5File *f, PetscInt *copied) {
  const PetscInt series = FrameSeriesCount(o);
  PetscReal *values, t;
  PetscInt most = 0, frame;
  unsigned long long place[FRAME_SERIES];
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < series; k++) most = PetscMax(most, Entries(o, k));
  PetscCall(PetscMalloc1(most, &values));
  *copied = 0;
  while (ReadPlaces(index, series, &frame, &t, place) && frame <= *copied) {
    PetscBool good = PETSC_TRUE;
    if (frame >= o->scheduled) continue;
    for (PetscInt k = 0; good && k < series; k++) {
      const PetscInt n = Entries(o, k);
      const ssize_t bytes = (ssize_t)((size_t)n * sizeof(*values));
      good = pread(old, values, (size_t)bytes, (off_t)place[k]) == bytes ? PETSC_TRUE : PETSC_FALSE;
      if (good) PetscCall(H5WriteArray(f, FrameSeries[k], frame, n, values));
    }
    if (!good) break;
    PetscCall(H5WriteArray(f, "/time", frame, 1, &t));
    *copied = frame + 1;
  }
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* run.h5.new is whole when it has that name; the index, which is of the old run.h5, goes before it. */
static PetscBool TakeNew(const char fresh[], const char index[], const char path[]) {
  return !access(fresh, F_OK) && (!unlink(index) || errno == ENOENT) && !rename(fresh, path) ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode FramesRepair(Output o, const char path[]) {
  char index[PETSC_MAX_PATH_LEN], part[PETSC_MAX_PATH_LEN], fresh[PETSC_MAX_PATH_LEN];
  FILE *lines = NULL;
  H5File f;
  PetscInt copied = 0;
  int old = -1;
  PetscMPIInt here = 0;
  PetscFunctionBeginUser;
  PetscCall(OutputPath(o, "run.h5.index", index));
  PetscCall(OutputPath(o, "run.h5.tmp", part));
  PetscCall(OutputPath(o, "run.h5.new", fresh));
  if (!o->rank && !TakeNew(fresh, index, path)) {
    lines = fopen(index, "r");
    old = lines ? open(path, O_RDONLY) : -1;
    here = old >= 0;
  }
  PetscCallMPI(MPI_Bcast(&here, 1, MPI_INT, 0, o->comm));
  if (here) {
    PetscCall(FieldsCreateFile(o, part, &f));
    if (!o->rank) PetscCall(CopyFrames(o, lines, old, &f, &copied));
    PetscCall(H5FileClose(&f));
    PetscCall(H5FileCheck(&f));
    if (!o->rank && copied == o->scheduled && (OutputSync(part) || rename(part, fresh) || !TakeNew(fresh, index, path)))
      f.failed = PETSC_TRUE;
    PetscCall(H5FileCheck(&f));
    if (!o->rank) (void)unlink(part);
  }
  if (lines) (void)fclose(lines);
  if (old >= 0) (void)close(old);
  PetscFunctionReturn(PETSC_SUCCESS);
}
