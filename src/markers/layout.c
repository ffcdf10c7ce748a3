#include "markers/layout.h"

/* Fill in the first body of each rank: a body goes to the rank in whose equal share of the work the middle of its work
   lies. */
static void LayoutShare(Layout l) {
  PetscReal total = 0, before = 0;
  PetscMPIInt rank = 0;
  for (PetscInt b = 0; b < l->bodies; b++) total += PetscSqr((PetscReal)LayoutCount(l, b));
  l->body[0] = 0;
  for (PetscInt b = 0; b < l->bodies; b++) {
    const PetscReal work = PetscSqr((PetscReal)LayoutCount(l, b)), middle = (before + 0.5 * work) / total;
    while (rank < l->size - 1 && middle * l->size > rank + 1) l->body[++rank] = b;
    before += work;
  }
  while (rank < l->size) l->body[++rank] = l->bodies;
}

PetscErrorCode LayoutCreate(MPI_Comm comm, PetscInt bodies, const PetscInt start[], const PetscInt body[],
                            Layout *out) {
  Layout l;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&l));
  *out = l;
  l->comm = comm;
  PetscCallMPI(MPI_Comm_rank(comm, &l->rank));
  PetscCallMPI(MPI_Comm_size(comm, &l->size));
  l->bodies = bodies;
  l->M = start[bodies];
  PetscCall(PetscMalloc2(bodies + 1, &l->start, l->size + 1, &l->body));
  PetscCall(PetscArraycpy(l->start, start, bodies + 1));
  if (body)
    PetscCall(PetscArraycpy(l->body, body, l->size + 1));
  else
    LayoutShare(l);
  l->own = l->body[l->rank];
  l->end = l->body[l->rank + 1];
  l->first = start[l->own];
  l->n = start[l->end] - l->first;
  for (int each = 1; each <= 3; each++) {
    PetscCall(PetscMalloc2(l->size, &l->count[each - 1], l->size, &l->at[each - 1]));
    for (PetscMPIInt r = 0; r < l->size; r++) {
      PetscCall(PetscMPIIntCast(each * (start[l->body[r + 1]] - start[l->body[r]]), &l->count[each - 1][r]));
      PetscCall(PetscMPIIntCast(each * start[l->body[r]], &l->at[each - 1][r]));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LayoutCreatePart(Layout all, PetscInt first, PetscInt end, Layout *layout) {
  PetscInt *start, *body;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(end - first + 1, &start, all->size + 1, &body));
  for (PetscInt b = first; b <= end; b++) start[b - first] = all->start[b] - all->start[first];
  for (PetscMPIInt r = 0; r <= all->size; r++) body[r] = PetscMax(first, PetscMin(all->body[r], end)) - first;
  PetscCall(LayoutCreate(all->comm, end - first, start, body, layout));
  PetscCall(PetscFree2(start, body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LayoutDestroy(Layout *layout) {
  Layout l = *layout;
  PetscFunctionBeginUser;
  if (!l) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2(l->start, l->body));
  for (int k = 0; k < 3; k++) PetscCall(PetscFree2(l->count[k], l->at[k]));
  PetscCall(PetscFree(*layout));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LayoutCreateVec(Layout l, int each, Vec *x) {
  PetscFunctionBeginUser;
  PetscCall(VecCreate(l->comm, x));
  PetscCall(VecSetSizes(*x, each * l->n, each * l->M));
  PetscCall(VecSetType(*x, VECSTANDARD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscMPIInt LayoutOwner(Layout l, PetscInt body) {
  PetscMPIInt rank = 0;
  while (rank < l->size - 1 && body >= l->body[rank + 1]) rank++;
  return rank;
}

PetscErrorCode LayoutGather(Layout l, int each, const PetscScalar own[], PetscScalar all[]) {
  PetscFunctionBeginUser;
  if (l->size == 1)
    PetscCall(PetscArraycpy(all, own, each * l->n));
  else
    PetscCallMPI(MPI_Allgatherv(own, l->count[each - 1][l->rank], MPIU_SCALAR, all, l->count[each - 1], l->at[each - 1],
                                MPIU_SCALAR, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LayoutGatherVec(Layout l, Vec x, PetscScalar all[]) {
  const PetscScalar *own;
  PetscInt n;
  PetscFunctionBeginUser;
  PetscCall(VecGetSize(x, &n));
  PetscCall(VecGetArrayRead(x, &own));
  PetscCall(LayoutGather(l, n > l->M ? 2 : 1, own, all));
  PetscCall(VecRestoreArrayRead(x, &own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LayoutSum(Layout l, int each, const PetscScalar part[], PetscScalar own[]) {
  PetscFunctionBeginUser;
  if (l->size == 1)
    PetscCall(PetscArraycpy(own, part, each * l->n));
  else
    PetscCallMPI(MPI_Reduce_scatter(part, own, l->count[each - 1], MPIU_SCALAR, MPI_SUM, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether rank `root` owns all markers, so that no message is needed. */
static PetscBool LayoutIsOnRank(Layout l, PetscMPIInt root) {
  return l->count[0][root] == l->M;
}

PetscErrorCode LayoutToRank(Layout l, PetscMPIInt root, int each, const PetscScalar own[], PetscScalar all[]) {
  PetscFunctionBeginUser;
  if (!LayoutIsOnRank(l, root))
    PetscCallMPI(MPI_Gatherv(own, l->count[each - 1][l->rank], MPIU_SCALAR, all, l->count[each - 1], l->at[each - 1],
                             MPIU_SCALAR, root, l->comm));
  else if (l->rank == root)
    PetscCall(PetscArraycpy(all, own, each * l->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LayoutFromRank(Layout l, PetscMPIInt root, int each, const PetscScalar all[], PetscScalar own[]) {
  PetscFunctionBeginUser;
  if (!LayoutIsOnRank(l, root))
    PetscCallMPI(MPI_Scatterv(all, l->count[each - 1], l->at[each - 1], MPIU_SCALAR, own, l->count[each - 1][l->rank],
                              MPIU_SCALAR, root, l->comm));
  else if (l->rank == root)
    PetscCall(PetscArraycpy(own, all, each * l->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}
