/* Step sizes: what StepJudge makes of an attempt and StepSize of a plan, both pure functions, as tables of cases. */
#include "facts.h"
#include "scheme/stepcontrol.h"

#define TOL 1e-4 /* of the error */
#define MOVE 0.1 /* that a marker may move */
#define SMALL 1e-12
#define NONE PETSC_MAX_REAL

/* An attempt at a level and what is made of it; sizes are over the base, speeds times it. What is zero is as usual: a
   whole step, none before it, an error of SMALL, edges of ratio 1. */
typedef struct {
  const char *name;
  PetscInt level;
  StepVerdict verdict;
  PetscInt next;    /* level after */
  PetscReal part;   /* of the level's step that was tried: another than 1 before a time of output */
  PetscReal before; /* error of the attempt before in the same step */
  PetscReal error, speed, ratio;
  PetscBool unsolved, first, exact; /* exact: no error */
  PetscInt order;                   /* 3: the error goes like dt^3, and steps grow by a level at most; 0: order 2 */
  PetscReal loss;                   /* of a film, over what it may lose */
} Row;

static const Row rows[] = {
    /* accepted: 0.9 sqrt(TOL/error) of the step, at most two levels up, as many down as that says */
    {"a tiny error grows by a factor of 2 only", 0, STEP_ACCEPT, 2},
    {"the same from a deep level", -20, STEP_ACCEPT, -18},
    {"an error of zero", 0, STEP_ACCEPT, 2, .exact = PETSC_TRUE},
    {"a quarter of the tolerance grows by a level", 0, STEP_ACCEPT, 1, .error = 0.25 * TOL},
    {"half of the tolerance keeps its size", 0, STEP_ACCEPT, 0, .error = 0.5 * TOL},
    {"just inside the tolerance is accepted and then smaller", 0, STEP_ACCEPT, -1, .error = 0.95 * TOL},
    {"an error equal to the tolerance is accepted", 0, STEP_ACCEPT, -1, .error = TOL},
    {"no growth above the largest level", 40, STEP_ACCEPT, 40},
    {"nor beyond it by half a growth", 39, STEP_ACCEPT, 40},
    {"less than half a step says nothing of a larger one", 0, STEP_ACCEPT, 0, .part = 0.49},
    {"nor of a smaller one", 0, STEP_ACCEPT, 0, .part = 0.49, .error = 0.95 * TOL},
    {"half a step lets steps grow", 0, STEP_ACCEPT, 2, .part = 0.51},
    {"or stay as they are", 0, STEP_ACCEPT, 0, .part = 0.71, .error = 0.25 * TOL},
    {"or shrink", 0, STEP_ACCEPT, -1, .part = 0.71, .error = 0.5 * TOL},
    {"a step that was stretched keeps its level", 0, STEP_ACCEPT, 0, .part = 1.1, .error = 0.9 * TOL},
    {"growth no further than markers may move", 0, STEP_ACCEPT, 1, .speed = 0.05},
    {"or smaller when they nearly moved too far", 0, STEP_ACCEPT, -1, .speed = 0.095},
    {"edges of ratio 2 are even enough", 0, STEP_ACCEPT, 2, .ratio = 2},
    /* above the tolerance: smaller, by a level at least */
    {"just above the tolerance", 0, STEP_REPEAT, -1, .error = 1.001 * TOL},
    {"twice the tolerance", 0, STEP_REPEAT, -2, .error = 2 * TOL},
    {"a hundred times the tolerance", 0, STEP_REPEAT, -7, .error = 100 * TOL},
    {"a part of a step with a large error", 0, STEP_REPEAT, -5, .part = 0.5, .error = 4 * TOL},
    {"an error that is not a number: a quarter", 0, STEP_REPEAT, -4, .error = NAN},
    {"not a number after a known error", 0, STEP_REPEAT, -4, .before = 2 * TOL, .error = NAN},
    {"an error that asks for less than the least level", 0, STEP_GIVE_UP, -114, .error = 1e30},
    {"an infinite error: a quarter", 0, STEP_REPEAT, -4, .error = INFINITY},
    {"an infinite error after a known one", 0, STEP_REPEAT, -4, .before = 2 * TOL, .error = INFINITY},
    {"a large error after an infinite one", 0, STEP_REPEAT, -7, .before = INFINITY, .error = 100 * TOL},
    /* not solved: half the step, whatever the rest says */
    {"not solved", 0, STEP_REPEAT, -2, .error = NAN, .speed = NAN, .ratio = NAN, .unsolved = PETSC_TRUE},
    {"not solved, with numbers that would do", 6, STEP_REPEAT, 4, .unsolved = PETSC_TRUE},
    {"a part of a step not solved: half of the part", 0, STEP_REPEAT, -6, .part = 0.3, .error = NAN, .speed = NAN,
     .ratio = NAN, .unsolved = PETSC_TRUE},
    {"a first step not solved", -10, STEP_REPEAT, -12, .exact = PETSC_TRUE, .unsolved = PETSC_TRUE,
     .first = PETSC_TRUE},
    {"not solved at the last levels", -78, STEP_REPEAT, -80, .exact = PETSC_TRUE, .unsolved = PETSC_TRUE},
    {"not solved below them", -79, STEP_GIVE_UP, -81, .exact = PETSC_TRUE, .unsolved = PETSC_TRUE},
    /* too far: 0.9 of the step that moves as far as allowed */
    {"twice too far", 0, STEP_REPEAT, -3, .speed = 0.2},
    {"just too far", 0, STEP_REPEAT, -1, .speed = 0.1001},
    {"too far and too large an error: the smaller step", 0, STEP_REPEAT, -7, .error = 100 * TOL, .speed = 0.2},
    {"too far, from a large level", 4, STEP_REPEAT, -3, .speed = 0.2},
    /* uneven edges: a quarter */
    {"uneven edges", 0, STEP_REPEAT, -4, .ratio = 2.1},
    {"an edge ratio that is not a number", 0, STEP_REPEAT, -4, .ratio = NAN},
    {"uneven edges, large error", 0, STEP_REPEAT, -4, .error = 1e4 * TOL, .ratio = 3},
    /* a first step's error is its whole movement and does not count */
    {"a first step, whatever its error", -10, STEP_ACCEPT, -10, .error = 1e6 * TOL, .first = PETSC_TRUE},
    {"a first step does not grow", -10, STEP_ACCEPT, -10, .first = PETSC_TRUE},
    {"a first step to where nothing is finite", -10, STEP_REPEAT, -14, .error = NAN, .first = PETSC_TRUE},
    {"a first step too far", 0, STEP_REPEAT, -3, .error = 1e6 * TOL, .speed = 0.2, .first = PETSC_TRUE},
    {"a first step with uneven edges", 0, STEP_REPEAT, -4, .ratio = 3, .first = PETSC_TRUE},
    /* an error that a smaller step does not lower is not the step's */
    {"an error hardly lowered is accepted, without growth", -2, STEP_ACCEPT, -2, .before = 2 * TOL, .error = 1.9 * TOL},
    {"a larger error than before too", -2, STEP_ACCEPT, -2, .before = 2 * TOL, .error = 5 * TOL},
    {"an error lowered by more than a tenth repeats", 0, STEP_REPEAT, -2, .before = 2 * TOL, .error = 1.7 * TOL},
    {"not lowered, but too far", 0, STEP_REPEAT, -3, .before = 2 * TOL, .error = 1.9 * TOL, .speed = 0.2},
    {"not lowered, but uneven", 0, STEP_REPEAT, -4, .before = 2 * TOL, .error = 1.9 * TOL, .ratio = 3},
    /* nothing smaller is left */
    {"too large an error at the least level", -80, STEP_GIVE_UP, -81, .error = 1.001 * TOL},
    {"too large an error one above", -79, STEP_REPEAT, -80, .error = 1.001 * TOL},
    {"uneven edges near the least level", -77, STEP_GIVE_UP, -81, .ratio = 3},
    {"a good step at the least level", -80, STEP_ACCEPT, -78},
    /* a film's loss: above 1 a smaller step, below it growth no further than it bears */
    {"a film's loss of 0.3", 0, STEP_ACCEPT, 2, .loss = 0.3},
    {"a film's loss of 0.6", 0, STEP_ACCEPT, 1, .loss = 0.6},
    {"a film's loss of 0.95", 0, STEP_ACCEPT, -1, .loss = 0.95},
    {"a film's loss of 1", 0, STEP_ACCEPT, -1, .loss = 1},
    {"a film's loss of 1.0001", 0, STEP_REPEAT, -1, .loss = 1.0001},
    {"a film's loss of 1.5", 0, STEP_REPEAT, -2, .loss = 1.5},
    {"a film's loss of 2", 0, STEP_REPEAT, -3, .loss = 2},
    {"order 3", 0, STEP_ACCEPT, 1, .order = 3},
    {"order 3, a quarter", 0, STEP_ACCEPT, 1, .error = 0.25 * TOL, .order = 3},
    {"order 3, half", 0, STEP_ACCEPT, 0, .error = 0.5 * TOL, .order = 3},
    {"order 3, just inside", 0, STEP_ACCEPT, -1, .error = 0.95 * TOL, .order = 3},
    {"order 3, above", 0, STEP_REPEAT, -1, .error = 1.5 * TOL, .order = 3},
    {"order 3, eight times", 0, STEP_REPEAT, -3, .error = 8 * TOL, .order = 3}};

static StepPolicy Policy(PetscReal base) {
  return (StepPolicy){.adaptive = PETSC_TRUE, .base = base, .tolerance = TOL, .max_move = MOVE};
}

static PetscReal SizeOf(PetscReal base, PetscInt level) {
  return base * PetscPowReal(2, 0.5 * (PetscReal)level);
}

/* A row at a base; twice, as a pure function says the same again. What an attempt that is tried again leaves behind is
   its error. */
static void CheckRow(const Row *r, PetscReal base) {
  const StepPolicy policy = Policy(base);
  const PetscReal before = r->before != 0 ? r->before : NONE, part = r->part != 0 ? r->part : 1;
  const StepTrial trial = {.solved = !r->unsolved,
                           .first = r->first,
                           .order = r->order,
                           .loss = r->loss,
                           .dt = part * SizeOf(base, r->level),
                           .error = r->error != 0 || r->exact ? r->error : SMALL,
                           .speed = r->speed / base,
                           .ratio = r->ratio != 0 ? r->ratio : 1};
  StepPlan plan[2];
  StepVerdict verdict[2];
  for (int k = 0; k < 2; k++) {
    plan[k] = (StepPlan){.level = r->level, .before = before};
    verdict[k] = StepJudge(&policy, &trial, &plan[k]);
  }
  const PetscReal left = trial.solved && verdict[0] != STEP_ACCEPT ? trial.error : before;
  TestAbout("base %g, %s", base, r->name);
  CHECK(verdict[0] == r->verdict && plan[0].level == r->next, "verdict %d, level %d to %d (wanted: %d, %d)", verdict[0],
        (int)r->level, (int)plan[0].level, r->verdict, (int)r->next);
  CHECK(plan[0].before == left || (PetscIsNanReal(left) && PetscIsNanReal(plan[0].before)),
        "it leaves the error %g behind", plan[0].before);
  CHECK(verdict[1] == verdict[0] && plan[1].level == plan[0].level, "it says the same again");
}

/* Without a limit on what markers move, and with other tolerances. */
static void CheckPolicies(void) {
  StepPolicy policy = Policy(1);
  StepTrial trial = {.solved = PETSC_TRUE, .dt = 1, .error = SMALL, .speed = 1e6, .ratio = 1};
  StepPlan plan = {.before = NONE};
  policy.max_move = 0;
  CHECK(StepJudge(&policy, &trial, &plan) == STEP_ACCEPT && plan.level == 2, "max_move = 0: markers may go anywhere");
  policy.tolerance = 1;
  trial.error = 0.5;
  plan = (StepPlan){.before = NONE};
  CHECK(StepJudge(&policy, &trial, &plan) == STEP_ACCEPT && plan.level == 0, "half of another tolerance");
  trial.error = 2;
  CHECK(StepJudge(&policy, &trial, &plan) == STEP_REPEAT && plan.level == -2, "twice another tolerance");
}

/* Sizes, over the base. */
static const struct {
  const char *name;
  PetscInt level;
  PetscReal max_step, courant, most; /* max_step 0, courant and most NONE: no limit */
  PetscReal dt;
  PetscInt next;
  PetscReal last; /* 0: none */
} sizes[] = {{"a level's step", 2, 0, NONE, NONE, 2, 2},
             {"an odd level's step", 1, 0, NONE, NONE, PETSC_SQRT2, 1},
             {"max_step lowers the level", 2, 1, NONE, NONE, 1, 0},
             {"to a whole level below it", 2, 1.3, NONE, NONE, 1, 0},
             {"to itself where it is one", 4, PETSC_SQRT2, NONE, NONE, PETSC_SQRT2, 1},
             {"max_step above the step", 0, 100, NONE, NONE, 1, 0},
             {"the Courant limit lowers the level", 2, 0, 0.5, NONE, 0.5, -2},
             {"to a whole level below it", 2, 0, 0.6, NONE, 0.5, -2},
             {"a Courant limit above the step", 2, 0, 3, NONE, 2, 2},
             {"the lower one of two limits", 2, 1, 0.5, NONE, 0.5, -2},
             {"whichever it is", 2, 0.5, 1, NONE, 0.5, -2},
             {"a whole step, far from the end", 0, 0, NONE, 100, 1, 0},
             {"a whole step, more than ten from it", 0, 0, NONE, 10.4, 1, 0},
             {"a ninth of what is left, less than ten steps from it", 0, 0, NONE, 9.4, 9.4 / 9, 0},
             {"an eighth, hardly less", 0, 0, NONE, 7.6, 7.6 / 8, 0},
             {"a whole step, two from the end", 0, 0, NONE, 2, 1, 0},
             {"half of what is left, less than two steps from it", 0, 0, NONE, 1.5, 0.75, 0},
             {"half of what is left, a tenth more than a step", 0, 0, NONE, 1.101, 0.5505, 0},
             {"what is left, hardly more than a step", 0, 0, NONE, 1.099, 1.099, 0},
             {"what is left, where a step reaches it", 0, 0, NONE, 1, 1, 0},
             {"what is left, a rounding above a step", 0, 0, NONE, 1 + 1e-13, 1 + 1e-13, 0},
             {"what is left, less than a step", 0, 0, NONE, 0.3, 0.3, 0},
             {"half of what is left, of a lowered step", 6, 0, 1, 1.5, 0.75, 0},
             {"a limit holds for equal steps too", 0, 1, NONE, 1.05, 0.525, 0},
             {"but for what is above it by rounding", 0, 1, NONE, 2 + 1e-13, 1 + 5e-14, 0},
             {"the Courant limit too", 0, 0, 1.02, 9.4, 0.94, 0},
             {"twice the step before", 4, 0, NONE, NONE, 2, 4, .last = 1},
             {"half of what is left, of twice the step before", 4, 0, NONE, 2.1, 1.05, 4, .last = 1},
             {"the level's step after a longer one", 0, 0, NONE, NONE, 1, 0, .last = 3}};

static void CheckSizes(PetscReal base) {
  for (size_t k = 0; k < sizeof(sizes) / sizeof(sizes[0]); k++) {
    StepPolicy policy = Policy(base);
    StepPlan plan = {.level = sizes[k].level, .before = NONE};
    policy.max_step = base * sizes[k].max_step;
    const PetscReal courant = sizes[k].courant < NONE ? base * sizes[k].courant : NONE;
    const PetscReal most = sizes[k].most < NONE ? base * sizes[k].most : NONE;
    const PetscReal dt = StepSize(&policy, &plan, base * sizes[k].last, courant, most);
    CHECK(PetscAbsReal(dt / (base * sizes[k].dt) - 1) < 1e-14 && plan.level == sizes[k].next,
          "base %g, %s: %g of the base, level %d", base, sizes[k].name, dt / base, (int)plan.level);
  }
}

/* Steps of one level up to an end: the last ten are equal, and none is shorter than 0.55 of a step or longer than 1.1.
 */
static void CheckEnd(PetscReal end) {
  const StepPolicy policy = Policy(0.1);
  StepPlan plan = {.level = 0, .before = NONE};
  PetscReal t = 0, last[10] = {0}, least = NONE, most = 0, off = 0;
  int steps = 0;
  for (; !StepFinished(&policy, t, end) && steps < 1000; steps++) {
    const PetscReal dt = last[steps % 10] = StepSize(&policy, &plan, 0, NONE, end - t);
    least = PetscMin(least, dt);
    most = PetscMax(most, dt);
    t = StepTime(&policy, t, dt, end);
  }
  for (int k = 0; k < PetscMin(steps, 10); k++) TestWorse(&off, last[k] - last[0]);
  CHECK(t == end && off < 1e-12 && least > 0.55 * policy.base && most < 1.1001 * policy.base,
        "%d steps to %g of %g to %g, the last ones %g", steps, end, least, most, last[0]);
}

/* Fixed steps of 0.1 to an end: whole ones, then one step or two equal ones that are shorter; sizes over the base. */
static const struct {
  const char *name;
  PetscReal t, most, dt;
} fixed[] = {{"far from the end", 0, 10, 1},
             {"no end", 3, NONE, 1},
             {"two steps from it", 1, 2, 1},
             {"a rounding less than two", 1, 2 - 1e-12, 1},
             {"a step from it", 1, 1, 1},
             {"a rounding more than a step", 1, 1 + 1e-12, 1},
             {"a rounding less", 1, 1 - 1e-12, 1},
             {"half of one and a half", 1, 1.5, 0.75},
             {"half of hardly more than a step", 1, 1.001, 0.5005},
             {"half of hardly less than two", 1, 1.999, 0.9995},
             {"what is left", 1, 0.4, 0.4},
             {"all of a short run", 0, 0.3, 0.3},
             {"a rounding of a million steps", 1e6, 1 - 1e-9, 1}};

/* n steps are taken to a multiple of the base, and each leads to the multiple's nearest decimal; n + part end in time.
 */
static void CheckFixedRun(PetscReal base, PetscInt n, PetscReal part) {
  const StepPolicy p = {.base = base};
  const PetscReal end = (n + part) * base;
  PetscReal t = 0, least = NONE, off = 0;
  PetscInt steps = 0;
  for (; !StepFinished(&p, t, end) && steps < 2 * n + 2; steps++) {
    const PetscReal dt = StepFixed(&p, t, end);
    least = PetscMin(least, dt);
    t = StepTime(&p, t, dt, end);
    if (t < end && dt == base) TestWorse(&off, t - StepDecimal((steps + 1) * base));
  }
  CHECK(steps == n + (part > 0) && t == end && off == 0 && (part > 0 ? !n || least >= 0.5 * base : least == base),
        "%g steps of %g: %d, t %.17g of %.17g, least %g", n + part, base, (int)steps, t, end, least);
}

static void CheckFixed(void) {
  const PetscReal bases[] = {0.1, 0.02, 1. / 3, 0.0125, 7};
  StepPolicy p = {.base = 0.1};
  for (size_t k = 0; k < sizeof(fixed) / sizeof(fixed[0]); k++) {
    const PetscReal t = fixed[k].t * p.base, until = fixed[k].most < NONE ? t + fixed[k].most * p.base : NONE;
    const PetscReal dt = StepFixed(&p, t, until);
    CheckBelow(dt / (p.base * fixed[k].dt) - 1, 1e-14, "%s: %g of a step", fixed[k].name, dt / p.base);
  }
  for (int b = 0; b < 5; b++)
    for (int e = 0; e < 6; e++) {
      PetscInt n = 1;
      for (int k = 0; k < e; k++) n *= 10;
      CheckFixedRun(bases[b], n, 0);
      CheckFixedRun(bases[b], n - 1, 1. / 3);
    }
}

/* Times of steps: decimals, whatever the sum is in binary; the end itself; of adaptive steps the sum. */
static void CheckTimes(void) {
  static const struct {
    PetscReal base, t, dt, until, want;
  } times[] = {{0.1, 0.2, 0.1, NONE, 0.3},          {0.01, 0.34, 0.01, NONE, 0.35}, {0.01, 2.99, 0.01, NONE, 3},
               {1e-3, 1.004, 1e-3, NONE, 1.005},    {0.03, 0.5, 0.03, NONE, 0.53},  {0.02, 0.095, 0.015, 0.11, 0.11},
               {1. / 3, 2. / 3, 1. / 3, NONE, 1},   {7e-5, 0.69993, 7e-5, 1, 0.7},  {0.1, 0.2, 0.1, 0.1 * 3, 0.1 * 3},
               {0.1, 123456.7, 0.1, NONE, 123456.8}};
  StepPolicy p = Policy(0.1);
  CHECK(StepTime(&p, 0.2, 0.1, NONE) == 0.2 + 0.1 && StepTime(&p, 0.2, 0.1, 0.3) == 0.3, "adaptive steps: the sum");
  p.adaptive = PETSC_FALSE;
  for (size_t k = 0; k < sizeof(times) / sizeof(times[0]); k++) {
    p.base = times[k].base;
    const PetscReal t = StepTime(&p, times[k].t, times[k].dt, times[k].until);
    CHECK(t == times[k].want, "%.17g after %g: %.17g", times[k].dt, times[k].t, t);
  }
}

/* When a time counts as the end: within rounding of it. */
static void CheckFinished(void) {
  StepPolicy p = Policy(0.1);
  CHECK(StepFinished(&p, 3, 3) && StepFinished(&p, 3.5, 3) && StepFinished(&p, 3 - 1e-11, 3), "the end");
  CHECK(!StepFinished(&p, 3 - 1e-9, 3) && !StepFinished(&p, 2.96, 3), "before the end");
  p.adaptive = PETSC_FALSE;
  CHECK(StepFinished(&p, 3 - 1e-11, 3) && !StepFinished(&p, 2.999, 3), "fixed steps");
  CHECK(StepFinished(&p, 1e5 - 1e-10, 1e5) && !StepFinished(&p, 1e5 - 1e-6, 1e5), "a million of them");
}

/* The policy of a scene; without vesicles there is no error to judge by. */
static void CheckPolicy(void) {
  StepPolicy p;
  Scene scene;
  TestScene(&scene, "-domain_cells 64,64 -scheme_type coupled -time_step 0.02");
  p = StepPolicyCreate(scene, scene->shape.vesicles);
  CHECK(!p.adaptive, "without -time_adapt error steps are fixed");
  CheckBelow(32 * SizeOf(1, StepFirstLevel()) - 1, 1e-14, "an adaptive run starts with a step of base/32");
  TestCall(SceneDestroy(&scene));
  TestScene(&scene, "-domain_cells 64,64 -scheme_type coupled -time_step 0.02 -time_adapt_tol 3e-4 "
                    "-time_adapt_max_move 2 -time_adapt_max_step 0.5 -time_adapt error");
  p = StepPolicyCreate(scene, scene->shape.vesicles);
  CHECK(p.adaptive && p.base == 0.02 && p.tolerance == 3e-4 && p.max_move == 2. / 32 && p.max_step == 0.5,
        "a policy has what its scene says: base %g, tolerance %g, move %g, step %g", p.base, p.tolerance, p.max_move,
        p.max_step);
  p = StepPolicyCreate(scene, 0);
  CHECK(!p.adaptive && p.base == 0.02, "without vesicles steps are fixed");
  TestCall(SceneDestroy(&scene));
}

void Facts(void) {
  static const PetscReal bases[] = {1, 0.25, 1024}; /* powers of 2: the same rounding */
  for (int b = 0; b < 3; b++) {
    for (size_t k = 0; k < sizeof(rows) / sizeof(rows[0]); k++) CheckRow(&rows[k], bases[b]);
    CheckSizes(bases[b]);
  }
  TestAbout("policies");
  CheckPolicies();
  for (int k = 1; k < 20; k++) CheckEnd(0.2 + 0.037 * k);
  CheckFixed();
  CheckTimes();
  CheckFinished();
  CheckPolicy();
}
