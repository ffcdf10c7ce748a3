#include "coupling/mobilitybox.h"

#define NEAR 8 /* cells up to which a pair has the lattice's sums */

struct _p_MobilityBox {
  Coupling coupling; /* borrowed */
  BoxPart smooth;    /* W */
};

PetscErrorCode MobilityBoxCreate(const FluidSpec *spec, Coupling c, MobilityBox *out) {
  MobilityBox b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->coupling = c;
  PetscCall(NearFieldCreateBoxPart(c->near, spec, PETSC_TRUE, &b->smooth));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityBoxDestroy(MobilityBox *box) {
  PetscFunctionBeginUser;
  if (!*box) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BoxPartDestroy(&(*box)->smooth));
  PetscCall(PetscFree(*box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* L - C_image and the exact images of markers i and j, the nearest image: xx, yy, xy, yx. Pairs far from one another
   and from walls take those of S, which leaves out a C of the order h^2/r^2. */
static void Lattice(NearField f, PetscInt i, PetscInt j, PetscReal value[4]) {
  const PetscReal *X = f->set.markers->X, h = f->set.markers->grid->h;
  PetscReal d[2] = {X[2 * i] - X[2 * j], X[2 * i + 1] - X[2 * j + 1]}, L[4], C[4] = {0, 0, 0, 0};
  const PetscReal fade = BoxPartImage(f->box, d);
  if (d[0] * d[0] + d[1] * d[1] < PetscSqr(NEAR * h)) {
    NearLatticePair(f->pairs, i, j, d, L);
    NearImageAdd(f->pairs->image, NULL, i, j, d, L, C);
  } else {
    Lanes S[3];
    StokesletFour(&f->set, d[0] + (Lanes){0}, d[1] + (Lanes){0}, S);
    for (int q = 0; q < 4; q++) L[q] = S[PetscMin(q, 2)][0];
  }
  NearImageAddBlake(f->pairs->image, i, j, d, -1, C);
  for (int q = 0; q < 4; q++) value[q] = fade * (L[q] - C[q]);
}

PetscErrorCode MobilityBoxAdd(MobilityBox b, const MarkerRange *rows, const MarkerRange *columns, PetscReal out[]) {
  const NearField f = b->coupling->near;
  const Layout l = b->coupling->bodies->layout;
  const PetscReal h2 = PetscSqr(b->coupling->fluid->grid->h);
  const PetscInt begin = PetscMax(l->first, rows->first), end = PetscMin(l->first + l->n, rows->first + rows->n);
  /* of the own markers among themselves a pair and its mirror image are one another's transposes */
  const PetscBool same = rows->first == columns->first && rows->n == columns->n && end - begin == rows->n ? PETSC_TRUE
                                                                                                          : PETSC_FALSE;
  PetscFunctionBeginUser;
  PetscCall(BoxPartPlace(b->smooth));
  PetscCall(BoxPartAdd(b->smooth, h2, rows, columns, out));
  for (PetscInt j = 0; j < columns->n; j++)
    for (PetscInt i = same ? j : begin - rows->first; i < end - rows->first; i++) {
      PetscReal L[4];
      Lattice(f, rows->first + i, columns->first + j, L);
      MobilityAddPair(h2, rows->n, i, j, L, out);
      if (same && i > j) MobilityAddPair(h2, rows->n, j, i, (PetscReal[]){L[0], L[1], L[3], L[2]}, out);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}
