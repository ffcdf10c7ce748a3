/* Scheme "penalty": the penalty immersed boundary method of Kim and Lai, J. Comput. Phys. 229 (2010) 4840. Stiff
   springs in place of the constraint, explicit forces, a projection step of the fluid. First order in time. */
#include "baselines/baselines.h"
#include "fluid/stokes/stokes.h"
#include "scheme/stepcommon.h"

typedef struct {
  Stokes stokes;
  Vec r, dp;      /* momentum's right-hand side, change of pressure */
  Vec constraint; /* -bc2, the divergence of moving walls; NULL without */
  Vec force;      /* edge vector, sigma/|X_s|: S takes X_s where the spring pulls along X_s/|X_s| */
  PetscReal *tau; /* [2n] X_s of the own vesicles */
} Penalty;

/* sigma = sigma_0 (|X_s| - 1) at the markers X; force may be NULL */
static PetscErrorCode SpringTension(Scheme s, Penalty *d, Vec X, Vec sigma, Vec force) {
  const Layout l = s->membrane->layout;
  PetscScalar *x, *tension, *f = NULL;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayPair(X, sigma, &x, &tension));
  if (force) PetscCall(VecGetArray(force, &f));
  MembraneTangents(s->membrane, l->own, l->end, x, d->tau);
  for (PetscInt k = 0; k < l->n; k++) {
    const PetscReal stretch = PetscSqrtReal(PetscSqr(d->tau[2 * k]) + PetscSqr(d->tau[2 * k + 1])); /* |X_s| */
    tension[k] = s->scene->scheme.stiffness * (stretch - 1);
    if (f) f[k] = tension[k] / stretch;
  }
  if (force) PetscCall(VecRestoreArray(force, &f));
  PetscCall(VecRestoreArrayPair(X, sigma, &x, &tension));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* r = u/dt - G p + bc1 - S (sigma/|X_s|) - B X */
static PetscErrorCode Momentum(Scheme s, Penalty *d) {
  State *q = &s->state;
  Coupling c = s->coupling;
  PetscFunctionBeginUser;
  PetscCall(VecCopy(q->w, d->r));
  PetscCall(VecScale(d->r, 1 / q->dt));
  PetscCall(GridGradient(s->fluid->grid, -1, q->p, PETSC_TRUE, d->r));
  if (s->fluid->bc1) PetscCall(VecAXPY(d->r, 1, s->fluid->bc1));
  if (!CouplingHasMembrane(c)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SpringTension(s, d, q->X, q->sigma, d->force));
  PetscCall(CouplingSpreadTension(c, -1, d->force, d->r));
  if (s->membrane->bending > 0) PetscCall(CouplingSpreadBending(c, -1, q->X, d->r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Step_Penalty(Scheme s, PetscReal most) {
  Penalty *d = (Penalty *)s->data;
  State *q = &s->state;
  PetscFunctionBeginUser;
  PetscCall(SchemePlace(s, 1 / q->dt, q->X, NULL, StateInstant(q)));
  if (*s->report.failure) PetscFunctionReturn(PETSC_SUCCESS);
  /* 1  forces of springs and bending at X^n */
  PetscCall(Momentum(s, d));
  /* 2  H u* = r,  L psi = -(G^T u* + bc2),  u = u* - G psi,  dp = psi/dt + nu (G^T u* + bc2) */
  PetscCall(StokesProject(d->stokes, d->r, d->constraint, q->w, d->dp));
  PetscCall(VecAXPY(q->p, 1, d->dp));
  PetscCall(SchemeMeasureDivergence(s, q->w, s->fluid->bc2));
  if (!CouplingHasMembrane(s->coupling)) PetscFunctionReturn(PETSC_SUCCESS);
  /* 3  X += dt (u_inf + E u), and the tension that goes with it */
  PetscCall(CouplingInterpolate(s->coupling, q->w, q->U));
  PetscCall(SchemeMarkerVelocity(s, q->U, q->sigma, q->U));
  PetscCall(VecAXPY(q->X, q->dt, q->U));
  PetscCall(SpringTension(s, d, q->X, q->sigma, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp_Penalty(Scheme s) {
  Penalty *d = (Penalty *)s->data;
  const State *q = &s->state;
  PetscFunctionBeginUser;
  PetscCall(StokesCreate(s->fluid, &d->stokes));
  PetscCall(VecDuplicate(q->w, &d->r));
  PetscCall(VecDuplicate(q->p, &d->dp));
  PetscCall(VecDuplicate(q->sigma, &d->force));
  PetscCall(PetscMalloc1(2 * s->membrane->layout->n, &d->tau));
  if (s->fluid->bc2) {
    PetscCall(VecDuplicate(q->p, &d->constraint));
    PetscCall(VecAXPBY(d->constraint, -1, 0, s->fluid->bc2));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode View_Penalty(Scheme s, PetscViewer viewer) {
  PetscFunctionBeginUser;
  if (CouplingHasMembrane(s->coupling))
    PetscCall(PetscViewerASCIIPrintf(viewer, "springs: sigma = sigma_0 (|X_s| - 1), sigma_0 = %g\n",
                                     (double)s->scene->scheme.stiffness));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Penalty(Scheme s) {
  Penalty *d = (Penalty *)s->data;
  PetscFunctionBeginUser;
  PetscCall(StokesDestroy(&d->stokes));
  PetscCall(VecDestroy(&d->r));
  PetscCall(VecDestroy(&d->dp));
  PetscCall(VecDestroy(&d->constraint));
  PetscCall(VecDestroy(&d->force));
  PetscCall(PetscFree(d->tau));
  PetscCall(PetscFree(d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeCreate_Penalty(Scheme s) {
  const SchemeOps ops = {.step = Step_Penalty, .view = View_Penalty, .destroy = Destroy_Penalty};
  Penalty *d;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  SchemeImplement(s, &ops, d);
  PetscCall(SetUp_Penalty(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
