#include "coupling/rootpc.h"
#include "base/agree.h"

PetscErrorCode RootPCCreate(Layout layout, const char prefix[], PetscInt levels, RootPC *out) {
  RootPC p;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&p));
  *out = p;
  p->layout = layout;
  p->root = LayoutOwner(layout, 0);
  PetscCall(PCCreate(PETSC_COMM_SELF, &p->pc));
  PetscCall(PCSetOptionsPrefix(p->pc, prefix));
  PetscCall(PCSetType(p->pc, PCILU));
  PetscCall(PCFactorSetLevels(p->pc, levels));
  PetscCall(PCFactorSetZeroPivot(p->pc, 0)); /* the default is a number, entries have a unit */
  PetscCall(PCFactorSetMatOrderingType(p->pc, MATORDERINGND));
  PetscCall(PCSetFromOptions(p->pc));
  if (layout->rank != p->root) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, layout->M, &p->x));
  PetscCall(VecDuplicate(p->x, &p->y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RootPCDestroy(RootPC *pc) {
  PetscFunctionBeginUser;
  if (!*pc) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PCDestroy(&(*pc)->pc));
  PetscCall(VecDestroy(&(*pc)->x));
  PetscCall(VecDestroy(&(*pc)->y));
  PetscCall(PetscFree(*pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RootPCIsNone(RootPC p, PetscBool *none) {
  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)p->pc, PCNONE, none));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RootPCSetMatrix(RootPC p, Mat A, PetscBool *failed) {
  PCFailedReason why = PC_NOERROR;
  PetscFunctionBeginUser;
  if (p->layout->rank == p->root) {
    PetscCall(PCSetOperators(p->pc, A, A));
    PetscCall(PCSetUp(p->pc));
    PetscCall(PCGetFailedReason(p->pc, &why));
  }
  PetscCall(AgreeFlag(p->layout->comm, why != PC_NOERROR ? PETSC_TRUE : PETSC_FALSE, failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RootPCApply(RootPC p, Vec x, Vec y) {
  const PetscBool here = p->layout->rank == p->root ? PETSC_TRUE : PETSC_FALSE;
  const PetscScalar *own;
  PetscScalar *all = NULL, *result;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(x, &own));
  if (here) PetscCall(VecGetArray(p->x, &all));
  PetscCall(LayoutToRank(p->layout, p->root, 1, own, all));
  if (here) PetscCall(VecRestoreArray(p->x, &all));
  PetscCall(VecRestoreArrayRead(x, &own));
  if (here) PetscCall(PCApply(p->pc, p->x, p->y));
  PetscCall(VecGetArray(y, &result));
  if (here) PetscCall(VecGetArray(p->y, &all));
  PetscCall(LayoutFromRank(p->layout, p->root, 1, all, result));
  if (here) PetscCall(VecRestoreArray(p->y, &all));
  PetscCall(VecRestoreArray(y, &result));
  PetscFunctionReturn(PETSC_SUCCESS);
}
