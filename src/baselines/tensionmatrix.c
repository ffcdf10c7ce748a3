#include "baselines/tensionmatrix.h"

#define ENTRIES                                                                                                        \
  (12 * KERNEL_MAX_POINTS * KERNEL_MAX_POINTS) /* of a column: two ends, two components, face and cells                \
                                                */

/* Column k of S, tau_k (E_k - E_before)^T/h^2, and behind it that of Q = (-diag(L))^{-1/2} G^T S, as row k of A. */
static PetscErrorCode AddColumn(Coupling c, PetscInt k, PetscInt before, const PetscReal tau[2], Mat A) {
  const Grid g = c->fluid->grid;
  const PetscInt cells = g->n[0] * g->n[1];
  PetscFunctionBeginUser;
  for (int end = 0; end < 2; end++)
    for (int comp = 0; comp < 2; comp++) {
      const Stencil *s = &c->markers->stencil[2 * (end ? before : k) + comp];
      const PetscReal f = (end ? -1 : 1) * tau[comp] / PetscSqr(g->h);
      for (PetscInt q = 0; q < s->n[0] * s->n[1]; q++) {
        const PetscInt a = q % s->n[0], b = q / s->n[0];
        const PetscReal value = f * s->weight[0][a] * s->weight[1][b];
        PetscInt cell[2] = {(s->first[0] + a) % g->n[0], (s->first[1] + b) % g->n[1]};
        PetscCall(MatSetValue(A, k, comp * cells + cell[1] * g->n[0] + cell[0], value, ADD_VALUES));
        for (int side = 0; side < 2; side++) { /* the face is the end of this cell and the beginning of the next one */
          PetscInt faces = 4;                  /* diag(L) = -faces/h^2 */
          for (int dir = 0; dir < 2; dir++)
            if (g->wall[dir]) faces -= (cell[dir] <= 0) + (cell[dir] >= g->n[dir] - 1);
          const PetscReal part = (side ? value : -value) / PetscSqrtReal((PetscReal)faces);
          PetscCall(MatSetValue(A, k, (2 * g->n[1] + cell[1]) * g->n[0] + cell[0], part, ADD_VALUES));
          cell[comp] = (cell[comp] + 1) % g->n[comp];
        }
      }
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* S^T S - Q^T Q = A B^T, A = (S^T, Q^T), B = (S^T, -Q^T) */
PetscErrorCode TensionAssemble(Coupling c, Mat *Chat) {
  const Layout l = c->membrane->layout;
  const PetscInt cells = c->fluid->grid->n[0] * c->fluid->grid->n[1];
  PetscReal *tau;
  PetscLogEvent event;
  Vec sign;
  Mat A, B;
  PetscFunctionBeginUser;
  PetscCall(PetvesEvent("AssembleChat", &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  PetscCall(MatCreateSeqAIJ(PETSC_COMM_SELF, l->M, 3 * cells, ENTRIES, NULL, &A));
  PetscCall(PetscMalloc1(2 * l->M, &tau));
  MembraneTangents(c->membrane, 0, l->bodies, c->markers->X, tau);
  for (PetscInt v = 0; v < l->bodies; v++) {
    const PetscInt first = l->start[v], end = l->start[v + 1];
    for (PetscInt k = first; k < end; k++) PetscCall(AddColumn(c, k, (k > first ? k : end) - 1, tau + 2 * k, A));
  }
  PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatCreateVecs(A, &sign, NULL));
  for (PetscInt k = 0; k < 3 * cells; k++) PetscCall(VecSetValue(sign, k, k < 2 * cells ? 1 : -1, INSERT_VALUES));
  PetscCall(VecAssemblyBegin(sign));
  PetscCall(VecAssemblyEnd(sign));
  PetscCall(MatDuplicate(A, MAT_COPY_VALUES, &B));
  PetscCall(MatDiagonalScale(B, NULL, sign));
  PetscCall(MatMatTransposeMult(A, B, MAT_INITIAL_MATRIX, PETSC_DEFAULT, Chat));
  PetscCall(VecDestroy(&sign));
  PetscCall(MatDestroy(&B));
  PetscCall(MatDestroy(&A));
  PetscCall(PetscFree(tau));
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
