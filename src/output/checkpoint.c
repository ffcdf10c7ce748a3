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

static PetscErrorCode WriteState(Output o, hid_t file) {
  const State *q = &o->scheme->state;
  const Grid g = o->scheme->fluid->grid;
  const Membrane m = o->scheme->membrane;
  const PetscInt format = CHECKPOINT_FORMAT;
  const PetscScalar *a;
  char value[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  PetscCall(H5PutInts(file, "format", 1, &format));
  PetscCall(H5PutInts(file, "step", 1, &q->step));
  PetscCall(H5PutReals(file, "time", 1, &q->t));
  PetscCall(H5PutReals(file, "dt", 1, &q->dt));
  PetscCall(H5PutString(file, "version", PETVES_VERSION));
  for (PetscInt i = 0; SceneOptionName(i); i++) {
    PetscCall(SceneOptionValue(o->scene, i, value, sizeof(value)));
    PetscCall(H5PutString(file, SceneOptionName(i), value));
  }
  PetscCall(VecGetArrayRead(q->w, &a));
  PetscCall(WriteField(o, file, "/fluid/u", FIELD_U, a));
  PetscCall(WriteField(o, file, "/fluid/v", FIELD_V, a + GridLocalU(g)));
  PetscCall(VecRestoreArrayRead(q->w, &a));
  PetscCall(VecGetArrayRead(q->p, &a));
  PetscCall(WriteField(o, file, "/fluid/p", FIELD_P, a));
  PetscCall(VecRestoreArrayRead(q->p, &a));
  if (m->vesicles) {
    PetscCall(H5PutInts(file, "vesicle_start", m->vesicles + 1, m->start));
    PetscCall(H5PutReals(file, "vesicle_ds", m->vesicles, m->ds));
    PetscCall(H5PutReals(file, "vesicle_area", m->vesicles, m->A0));
    PetscCall(H5PutReals(file, "vesicle_length", m->vesicles, m->L0));
    PetscCall(WriteMarkers(o, file, "/vesicle/markers", 2, q->X));
    PetscCall(WriteMarkers(o, file, "/vesicle/velocity", 2, q->U));
    PetscCall(WriteMarkers(o, file, "/vesicle/tension", 1, q->sigma));
  }
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
