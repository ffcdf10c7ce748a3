/* checkpoint.h5: everything that a restart needs. */
#include "output/output.h"
#include <fcntl.h>
#include <unistd.h>

#define CHECKPOINT_FORMAT 1

static PetscErrorCode WriteField(Output o, hid_t file, const char name[], Field f, const PetscScalar a[]) {
  const Grid g = o->scheme->fluid->grid;
  const PetscInt dims[2] = {g->all_rows[f], g->columns[f]};
  PetscFunctionBeginUser;
  PetscCall(H5CreateSeries(file, name, 2, dims, g->block));
  PetscCall(H5AppendRows(file, name, 0, g->first, g->rows[f], a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteMarkers(Output o, hid_t file, const char name[], int ndims, Vec x) {
  const PetscInt dims[2] = {o->scheme->membrane->M, 2};
  const PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(H5CreateSeries(file, name, ndims, dims, 0));
  PetscCall(VecGetArrayRead(x, &a));
  PetscCall(H5AppendArray(o->comm, file, name, 0, a));
  PetscCall(VecRestoreArrayRead(x, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The vectors of one state into the groups <prefix>/fluid and <prefix>/vesicle. */
static PetscErrorCode WriteVectors(Output o, hid_t file, const char prefix[], const State *q) {
  static const char *const fluid[3] = {"u", "v", "p"}, *const vesicle[3] = {"markers", "velocity", "tension"};
  const Grid g = o->scheme->fluid->grid;
  const Vec marker[3] = {q->X, q->U, q->sigma};
  char name[64];
  const PetscScalar *a[3];
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(q->w, &a[0]));
  a[1] = a[0] + GridLocalU(g);
  PetscCall(VecGetArrayRead(q->p, &a[2]));
  for (int f = 0; f < 3; f++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/fluid/%s", prefix, fluid[f]));
    PetscCall(WriteField(o, file, name, (Field)f, a[f]));
  }
  PetscCall(VecRestoreArrayRead(q->p, &a[2]));
  PetscCall(VecRestoreArrayRead(q->w, &a[0]));
  for (int k = 0; k < 3 && o->scheme->membrane->vesicles; k++) {
    PetscCall(PetscSNPrintf(name, sizeof(name), "%s/vesicle/%s", prefix, vesicle[k]));
    PetscCall(WriteMarkers(o, file, name, k < 2 ? 2 : 1, marker[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteState(Output o, hid_t file) {
  const State *q = &o->scheme->state;
  const Membrane m = o->scheme->membrane;
  const PetscInt format = CHECKPOINT_FORMAT;
  char value[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  PetscCall(H5PutInts(file, "format", 1, &format));
  PetscCall(H5PutInts(file, "step", 1, &q->step));
  PetscCall(H5PutReals(file, "time", 1, &q->t));
  PetscCall(H5PutReals(file, "dt", 1, &q->dt));
  PetscCall(H5PutReals(file, "dt_last", 1, &q->dt_last));
  PetscCall(H5PutString(file, "version", PETVES_VERSION));
  for (PetscInt i = 0; SceneOptionName(i); i++) {
    PetscCall(SceneOptionValue(o->scene, i, value, sizeof(value)));
    PetscCall(H5PutString(file, SceneOptionName(i), value));
  }
  if (m->vesicles) {
    PetscCall(H5PutInts(file, "vesicle_start", m->vesicles + 1, m->start));
    PetscCall(H5PutReals(file, "vesicle_ds", m->vesicles, m->ds));
    PetscCall(H5PutReals(file, "vesicle_area", m->vesicles, m->A0));
    PetscCall(H5PutReals(file, "vesicle_length", m->vesicles, m->L0));
  }
  PetscCall(WriteVectors(o, file, "", q));
  if (o->scheme->old) PetscCall(WriteVectors(o, file, "/previous", o->scheme->old));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputCheckpoint(Output o) {
  char path[PETSC_MAX_PATH_LEN], temporary[PETSC_MAX_PATH_LEN];
  hid_t file;
  PetscMPIInt failed = 0;
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  PetscCall(OutputPath(o, "checkpoint.h5", path));
  PetscCall(OutputPath(o, "checkpoint.h5.tmp", temporary));
  PetscCall(H5Create(o->comm, temporary, &file));
  PetscCall(WriteState(o, file));
  PetscCall(H5Close(o->comm, temporary, &file));
  PetscCallMPI(MPI_Barrier(o->comm));
  if (!o->rank) {
    const int fd = open(temporary, O_RDWR);
    failed = fd < 0 || fsync(fd) || close(fd) || rename(temporary, path);
  }
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, o->comm));
  PetscCheck(!failed, o->comm, PETSC_ERR_USER_INPUT, "%s: cannot be written; allowed: a folder that can be written",
             path);
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}
