#include "scheme/adapt.h"
#include "scheme/coupled.h"

#define LEVELS_OF_START 10 /* the first step is base/32 */
#define LEAST_LEVEL (-80)
#define MOST_LEVEL 40
#define SAFETY 0.9
#define GROWTH 2 /* levels a step, a factor of 2 */

PetscErrorCode StepControlCreate(Scene scene, Membrane m, StepControl *c) {
  PetscFunctionBeginUser;
  c->on = scene->time.adapt == ADAPT_ERROR && m->vesicles ? PETSC_TRUE : PETSC_FALSE;
  c->tolerance = scene->time.adapt_tol;
  c->base = scene->time.dt;
  c->max_move = scene->time.adapt_max_move;
  c->max_step = scene->time.adapt_max_step;
  c->level = -LEVELS_OF_START;
  c->R0 = PETSC_MAX_REAL;
  for (PetscInt v = 0; v < m->vesicles; v++) c->R0 = PetscMin(c->R0, m->L0[v] / (2 * PETSC_PI));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Convection is explicit: its CFL number bounds the step. So does -time_adapt_max_step. */
static PetscErrorCode LimitLevel(Scheme s, StepControl *c) {
  PetscReal speed, most = c->max_step > 0 ? c->max_step : PETSC_MAX_REAL;
  PetscFunctionBeginUser;
  PetscCall(CoupledSpeed(s, &speed));
  if (speed > 0) most = PetscMin(most, s->scene->time.cfl_limit * s->fluid->grid->h / speed);
  if (most < PETSC_MAX_REAL)
    c->level = PetscMin(c->level, (PetscInt)PetscFloorReal(2 * PetscLog2Real(most / c->base) + 1e-9));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal StepOfLevel(const StepControl *c, PetscInt level) {
  return c->base * PetscPowReal(2, 0.5 * (PetscReal)level);
}

/* max |X - X*|/R0 */
static PetscErrorCode Estimate(const StepControl *c, Vec Xstar, Vec X, PetscReal *error) {
  const PetscScalar *a, *b;
  PetscInt n;
  PetscFunctionBeginUser;
  *error = 0;
  PetscCall(VecGetLocalSize(X, &n));
  PetscCall(VecGetArrayRead(X, &a));
  PetscCall(VecGetArrayRead(Xstar, &b));
  for (PetscInt k = 0; k < n; k += 2) {
    const PetscReal d = PetscSqrtReal(PetscSqr(a[k] - b[k]) + PetscSqr(a[k + 1] - b[k + 1])) / c->R0;
    *error = d > *error || PetscIsNanReal(d) ? d : *error;
  }
  PetscCall(VecRestoreArrayRead(Xstar, &b));
  PetscCall(VecRestoreArrayRead(X, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest speed of a marker relative to its vesicle's mean, and the worst edge ratio. */
static PetscErrorCode Watch(Membrane m, const State *next, PetscReal *speed, PetscReal *edge_ratio) {
  const PetscScalar *X, *U;
  PetscFunctionBeginUser;
  *speed = 0;
  *edge_ratio = 1;
  PetscCall(VecGetArrayRead(next->X, &X));
  PetscCall(VecGetArrayRead(next->U, &U));
  for (PetscInt v = 0; v < m->vesicles; v++) {
    const PetscInt n = m->start[v + 1] - m->start[v];
    PetscReal mean[2] = {0, 0};
    Measures measures;
    for (PetscInt k = m->start[v]; k < m->start[v + 1]; k++)
      for (int c = 0; c < 2; c++) mean[c] += U[2 * k + c] / n;
    for (PetscInt k = m->start[v]; k < m->start[v + 1]; k++)
      *speed = PetscMax(*speed, PetscSqrtReal(PetscSqr(U[2 * k] - mean[0]) + PetscSqr(U[2 * k + 1] - mean[1])));
    MembraneMeasure(m, v, X, &measures);
    *edge_ratio = PetscMax(*edge_ratio, measures.edge_ratio);
  }
  PetscCall(VecRestoreArrayRead(next->U, &U));
  PetscCall(VecRestoreArrayRead(next->X, &X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Towards the end two equal steps: a last one that is far shorter than the one before it leaves noise in the velocity,
   which is a difference over the step, and in the tension. */
static PetscReal StepBefore(PetscReal dt, PetscReal most) {
  if (most <= dt * (1 + 1e-12)) return most;
  return most < 2 * dt ? most / 2 : dt;
}

PetscErrorCode StepControlStep(Scheme s, StepControl *c, Vec Xstar, const State *next, PetscReal *dt,
                               PetscBool *solved) {
  const PetscReal most = *dt, h = s->fluid->grid->h;
  PetscFunctionBeginUser;
  PetscReal before = PETSC_MAX_REAL; /* estimate of the attempt rejected last */
  PetscCall(LimitLevel(s, c));
  for (;;) {
    const PetscBool first = s->state.dt_last == 0 ? PETSC_TRUE : PETSC_FALSE;
    PetscReal error, speed, edge_ratio, factor;
    *dt = StepBefore(StepOfLevel(c, c->level), most);
    PetscCall(CoupledAttempt(s, *dt, solved));
    if (!*solved) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(Estimate(c, Xstar, next->X, &error));
    PetscCall(Watch(s->membrane, next, &speed, &edge_ratio));
    /* X - X* is of second order; in a backward Euler step X* = X, so there it is the whole movement */
    factor = SAFETY * (first ? 1 : PetscSqrtReal(c->tolerance / PetscMax(error, 1e-30)));
    const PetscBool too_far = c->max_move > 0 && speed * *dt > c->max_move * h ? PETSC_TRUE : PETSC_FALSE;
    /* not of the step: what the length target puts right in the first steps, or the solver's tolerance */
    const PetscBool fixed = error > 0.9 * before ? PETSC_TRUE : PETSC_FALSE;
    const PetscBool inexact = !first && !fixed && !(error <= c->tolerance) ? PETSC_TRUE : PETSC_FALSE;
    const PetscBool bad = inexact || too_far || !(edge_ratio <= 2) ? PETSC_TRUE : PETSC_FALSE;
    if (too_far) factor = PetscMin(factor, SAFETY * c->max_move * h / (speed * *dt));
    if (!(edge_ratio <= 2) || PetscIsNanReal(error)) factor = 0.25;
    const PetscInt wanted = (PetscInt)PetscFloorReal(2 * PetscLog2Real(factor * *dt / c->base));
    if (!bad) {
      PetscInt limit = c->level + GROWTH;
      if (c->max_move > 0 && speed > 0)
        limit = PetscMin(limit,
                         (PetscInt)PetscFloorReal(2 * PetscLog2Real(SAFETY * c->max_move * h / (speed * c->base))));
      if (!first && !fixed && *dt >= StepOfLevel(c, c->level) * (1 - 1e-12))
        c->level = PetscMin(PetscMin(wanted, limit), MOST_LEVEL);
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    before = error;
    c->rejected++;
    c->level = PetscMin(c->level - 1, wanted);
    if (c->level < LEAST_LEVEL) {
      *solved = PETSC_FALSE;
      PetscCall(
          PetscSNPrintf(s->report.failure, sizeof(s->report.failure),
                        "-time_adapt error: no step small enough in step %" PetscInt_FMT
                        " at time %g (estimate %g, edge ratio %g); a larger -time_adapt_tol or more markers may help",
                        s->state.step + 1, (double)s->state.t, (double)error, (double)edge_ratio));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
}
