#include "base/agree.h"

PetscErrorCode AgreeFlag(MPI_Comm comm, PetscBool mine, PetscBool *any) {
  PetscMPIInt flag = mine ? 1 : 0;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &flag, 1, MPI_INT, MPI_MAX, comm));
  *any = flag ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AgreeFinite(Vec x, PetscBool *finite) {
  const PetscScalar *a;
  PetscInt n;
  PetscBool bad = PETSC_FALSE;
  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(x, &n));
  PetscCall(VecGetArrayRead(x, &a));
  for (PetscInt k = 0; k < n; k++)
    if (PetscIsInfOrNanReal(a[k])) bad = PETSC_TRUE;
  PetscCall(VecRestoreArrayRead(x, &a));
  PetscCall(AgreeFlag(PetscObjectComm((PetscObject)x), bad, &bad));
  *finite = bad ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AgreeMessage(MPI_Comm comm, char message[PETVES_MAX_MESSAGE]) {
  PetscMPIInt rank, size, first;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  if (size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  first = *message ? rank : size;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, comm));
  if (first < size) PetscCallMPI(MPI_Bcast(message, PETVES_MAX_MESSAGE, MPI_CHAR, first, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AgreeLargest(MPI_Comm comm, PetscReal *value, PetscMPIInt *rank) {
  struct {
    double value;
    int rank;
  } mine = {.value = *value};
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &mine.rank));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &mine, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm));
  *value = mine.value;
  if (rank) *rank = mine.rank;
  PetscFunctionReturn(PETSC_SUCCESS);
}
