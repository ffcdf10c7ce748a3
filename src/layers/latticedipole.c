/* A source in a cell moves the lattice's faces by the gradient of its Green's function (LatticePressure), a unit force
   by the Stokeslet: the dipoles are differences of both. With I, J the offset in cells of a face of u,

       U_xx(I + 1/2, J) = uu(I, J) - uu(I + 1, J) + su(I + 1/2, J)/2                                    from a cell
       U_yy(I + 1/2, J) = vu(I + 1/2, J - 1/2) - vu(I + 1/2, J + 1/2) + su(I + 1/2, J)/2                from a cell
       U_xy(I, J + 1/2) = uu(I, J) - uu(I, J + 1) + vu(I - 1/2, J + 1/2) - vu(I + 1/2, J + 1/2)         from a node

   su of a source in a cell; V by exchange of the directions. */
#include "layers/latticedipole.h"
#include "layers/latticegreen.h"

/* What the offset tables hold, by half offsets. */
typedef struct {
  OffsetTable stokeslet, source;
} Lattice;

static PetscReal UU(const Lattice *l, PetscInt i, PetscInt j) {
  return OffsetAt(&l->stokeslet, OFFSET_UU, i, j);
}
/* vu(i + 1/2, j + 1/2): v lies half a cell left of and above u */
static PetscReal VU(const Lattice *l, PetscInt i, PetscInt j) {
  return OffsetAt(&l->stokeslet, OFFSET_VU, i + 1, j);
}
/* su(i + 1/2, j): the pressure at (i, j) of a force along x at the face (i - 1/2, j), the offset turned */
static PetscReal SU(const Lattice *l, PetscInt i, PetscInt j) {
  return OffsetAt(&l->source, OFFSET_UU, i + 1, j);
}

static PetscReal XX(const Lattice *l, PetscInt i, PetscInt j) {
  return UU(l, i, j) - UU(l, i + 1, j) + 0.5 * SU(l, i, j);
}
static PetscReal YY(const Lattice *l, PetscInt i, PetscInt j) {
  return VU(l, i, j - 1) - VU(l, i, j) + 0.5 * SU(l, i, j);
}
static PetscReal XY(const Lattice *l, PetscInt i, PetscInt j) {
  return UU(l, i, j) - UU(l, i, j + 1) + VU(l, i - 1, j) - VU(l, i, j);
}

PetscErrorCode LatticeDipoles(PetscInt reach, OffsetTable table[2]) {
  const PetscInt size[2] = {reach, reach}, width = 2 * reach + 1;
  Lattice l;
  PetscFunctionBeginUser;
  PetscCall(LatticeStokeslet(reach + 2, &l.stokeslet));
  PetscCall(LatticePressure(reach + 2, &l.source));
  for (int c = 0; c < 2; c++) PetscCall(OffsetTableCreate(size, &table[c]));
  for (PetscInt j = -reach; j <= reach; j++)
    for (PetscInt i = -reach; i <= reach; i++) {
      /* a face of u is half a cell right of its cell's centre and below its node; v with x and y exchanged */
      const PetscInt at = (j + reach) * width + i + reach;
      table[0].value[DIPOLE_XX][at] = XX(&l, i, j);
      table[0].value[DIPOLE_YY][at] = YY(&l, i, j);
      table[0].value[DIPOLE_XY][at] = XY(&l, i, j - 1);
      table[1].value[DIPOLE_XX][at] = YY(&l, j, i);
      table[1].value[DIPOLE_YY][at] = XX(&l, j, i);
      table[1].value[DIPOLE_XY][at] = XY(&l, j, i - 1);
    }
  PetscCall(OffsetTableDestroy(&l.stokeslet));
  PetscCall(OffsetTableDestroy(&l.source));
  PetscFunctionReturn(PETSC_SUCCESS);
}
