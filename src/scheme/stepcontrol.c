#include "scheme/stepcontrol.h"
#include <stdlib.h>

#define FIRST_LEVEL (-10) /* the first step is base/32 */
#define LEAST_LEVEL (-80)
#define MOST_LEVEL 40
#define SAFETY 0.9
#define GROWTH                                                                                                         \
  2              /* levels that a step may grow by; 1 at order 3, which is stable for steps that grow by 1.53 at most  \
                  */
#define HALF 2   /* levels of a factor of 2 */
#define EQUAL 10 /* steps to a time to end at that are made equal */
#define STRETCH 1.1 /* of them, at most: SAFETY leaves that much */

StepPolicy StepPolicyCreate(Scene scene, PetscInt bodies) {
  return (StepPolicy){.adaptive = scene->time.adapt == ADAPT_ERROR && bodies ? PETSC_TRUE : PETSC_FALSE,
                      .base = scene->time.dt,
                      .tolerance = scene->time.adapt_tol,
                      .max_move = scene->time.adapt_max_move * FluidSpecCellSize(&scene->fluid),
                      .max_step = scene->time.adapt_max_step};
}

PetscInt StepFirstLevel(void) {
  return FIRST_LEVEL;
}

/* Of a time, which has 15 digits. */
static PetscReal Rounding(const StepPolicy *p, PetscReal t) {
  return 1e-9 * p->base + 1e-14 * t;
}

PetscReal StepDecimal(PetscReal t) {
  char digits[32];
  (void)snprintf(digits, sizeof(digits), "%.15g", (double)t);
  return strtod(digits, NULL);
}

PetscReal StepTime(const StepPolicy *p, PetscReal t, PetscReal dt, PetscReal until) {
  const PetscReal end = t + dt, n = PetscFloorReal(end / p->base + 0.5);
  if (PetscAbsReal(until - end) <= Rounding(p, end)) return until;
  if (p->adaptive) return end;
  return StepDecimal(PetscAbsReal(n * p->base - end) <= 1e-14 * end ? n * p->base : end);
}

PetscBool StepFinished(const StepPolicy *p, PetscReal t, PetscReal until) {
  return t >= until - Rounding(p, t) ? PETSC_TRUE : PETSC_FALSE;
}

PetscReal StepFixed(const StepPolicy *p, PetscReal t, PetscReal until) {
  const PetscReal most = until - t, rounding = Rounding(p, t);
  if (most >= 2 * p->base - rounding || PetscAbsReal(most - p->base) <= rounding) return p->base;
  return most > p->base ? most / 2 : most; /* a step that is far shorter than the one before adds noise (StepSize) */
}

static PetscReal SizeOfLevel(const StepPolicy *p, PetscInt level) {
  return p->base * PetscPowReal(2, 0.5 * (PetscReal)level);
}

/* Largest level with a step of at most dt, or at most a rounding above it. */
static PetscInt LevelOfSize(const StepPolicy *p, PetscReal dt, PetscReal above) {
  return (PetscInt)PetscFloorReal(2 * PetscLog2Real(dt / p->base) + above);
}

PetscReal StepSize(const StepPolicy *p, StepPlan *plan, PetscReal last, PetscReal courant, PetscReal most) {
  const PetscReal limit = PetscMin(courant, p->max_step > 0 ? p->max_step : PETSC_MAX_REAL);
  if (limit < PETSC_MAX_REAL) plan->level = PetscMin(plan->level, LevelOfSize(p, limit, 1e-9));
  const PetscReal grown = last > 0 ? 2 * last : PETSC_MAX_REAL, dt = PetscMin(SizeOfLevel(p, plan->level), grown);
  const PetscReal longest = PetscMax(dt, PetscMin(PetscMin(limit, grown), STRETCH * dt));
  if (most > EQUAL * dt) return dt;
  return most / PetscMax(PetscFloorReal(most / dt + 0.5), PetscCeilReal(most / longest - 1e-12));
}

/* The error X - X* is of the formula's order in dt. In a first step X* = X, and the error is not tested, as it is the
   whole motion. An error that a smaller step has not lowered does not come from the step: it is the correction of edge
   lengths at the start, or the solver's tolerance. An error that is not finite always counts as the step's. */
StepVerdict StepJudge(const StepPolicy *p, const StepTrial *t, StepPlan *plan) {
  const PetscBool lost = PetscIsInfOrNanReal(t->error) ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool fixed = !lost && t->error > 0.9 * plan->before ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool above = !t->first && !fixed && t->error > p->tolerance ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool inexact = lost || above ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool too_far = p->max_move > 0 && t->speed * t->dt > p->max_move ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool drained = t->loss > 1 ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool uneven = t->ratio <= 2 ? PETSC_FALSE : PETSC_TRUE; /* or not a number */
  const PetscReal spare = p->tolerance / PetscMax(t->error, 1e-30);
  PetscReal factor = SAFETY * (t->first ? 1 : t->order > 2 ? PetscCbrtReal(spare) : PetscSqrtReal(spare));
  PetscInt wanted;
  if (!t->solved) {
    plan->level = LevelOfSize(p, t->dt, 1e-9) - HALF;
    return plan->level < LEAST_LEVEL ? STEP_GIVE_UP : STEP_REPEAT;
  }
  if (too_far) factor = PetscMin(factor, SAFETY * p->max_move / (t->speed * t->dt));
  if (t->loss > 0) factor = PetscMin(factor, SAFETY / t->loss);
  if (uneven || lost) factor = 0.25;
  wanted = LevelOfSize(p, factor * t->dt, 0);
  if (inexact || too_far || uneven || drained) {
    plan->before = t->error;
    plan->level = PetscMin(plan->level - 1, wanted);
    return plan->level < LEAST_LEVEL ? STEP_GIVE_UP : STEP_REPEAT;
  }
  const PetscBool part = t->dt < 0.5 * SizeOfLevel(p, plan->level) ? PETSC_TRUE : PETSC_FALSE;
  if (t->first || fixed || part) return STEP_ACCEPT; /* the attempt does not tell what a larger step would do */
  wanted = PetscMin(PetscMin(wanted, plan->level + GROWTH - (t->order > 2)), MOST_LEVEL);
  if (p->max_move > 0 && t->speed > 0) wanted = PetscMin(wanted, LevelOfSize(p, SAFETY * p->max_move / t->speed, 0));
  if (t->loss > 0) wanted = PetscMin(wanted, LevelOfSize(p, SAFETY / t->loss * t->dt, 0));
  plan->level = wanted;
  return STEP_ACCEPT;
}
