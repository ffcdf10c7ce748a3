/* Time steps of a scene, one by one, after a warm-up; no output files.
     bench_step -bench_warmup W -bench_steps N [options of petves]     one JSON object: seconds of each step, of its
   fast solves and of the rest, iterations, scalar solves; seconds of the set-up and of the first step; peak memory. */
#include "bench.h"
#include <sys/resource.h>

#define MOST_STEPS 4096
enum { WALL, FAST, REST, SOLVES, COUPLED, TENSION, BENDING, LISTS };
static const char *const names[LISTS] = {"step", "fast", "rest", "nsolve", "coupled_its", "tension_its", "bending_its"};

static void Create(TestWorld *w) {
  TestCall(SceneCreate(PETSC_COMM_WORLD, NULL, NULL, &w->scene));
  const SceneCoupling *c = &w->scene->coupling;
  const CouplingSetting setting = {.mobility = {.kernel = c->kernel,
                                                .near = (NearFieldType)c->near_field,
                                                .spec = &w->scene->fluid,
                                                .box_part = SceneHasBoxPart(w->scene),
                                                .solver = !SceneIsProjection(w->scene)},
                                   .area_target = SceneHasAreaTarget(w->scene)};
  TestWorldBuildFor(&setting, w);
  TestWorldScheme(w);
  TestCall(SceneCheckUnused(w->scene));
}

/* Peak memory of all ranks (bytes). */
static void PeakMemory(PetscReal *bytes) {
  struct rusage usage;
  (void)getrusage(RUSAGE_SELF, &usage);
  *bytes = 1024. * (PetscReal)usage.ru_maxrss;
  TestCall(MPI_Allreduce(MPI_IN_PLACE, bytes, 1, MPIU_REAL, MPI_SUM, PETSC_COMM_WORLD));
}

static void Step(TestWorld *w, PetscReal at[LISTS]) {
  const PetscReal fast = PhaseSeconds(PHASE_FAST_SOLVE), rest = PhaseSeconds(PHASE_STEP);
  const StepReport *report = &w->scheme->report;
  PetscLogDouble start = 0;
  Begin(&start);
  TestCall(SchemeStep(w->scheme, PETSC_MAX_REAL));
  Elapsed(start, &at[WALL]);
  PetscCheckAbort(!*report->failure, PETSC_COMM_WORLD, PETSC_ERR_USER_INPUT, "%s", report->failure);
  at[FAST] = PhaseSeconds(PHASE_FAST_SOLVE) - fast;
  at[REST] = PhaseSeconds(PHASE_STEP) - rest;
  at[SOLVES] = report->solves;
  at[COUPLED] = report->coupled_its;
  at[TENSION] = report->tension_its;
  at[BENDING] = report->bending_its;
}

static void Print(const TestWorld *w, PetscReal setup, PetscReal first, PetscReal memory, PetscInt steps,
                  const PetscReal *lists) {
  printf("{\"cells\": %d, \"markers\": %d, \"ranks\": %d, \"setup\": %.6g, \"first\": %.6g, \"memory\": %.0f",
         (int)w->scene->fluid.cells[0], (int)w->layout->M, w->fluid->grid->size, (double)setup, (double)first,
         (double)memory);
  for (int k = 0; k < LISTS; k++) {
    printf(", ");
    PrintList(names[k], steps, lists + k * steps);
  }
  printf("}\n");
}

static void Bench(void) {
  PetscInt warmup = 20, steps = 10;
  PetscReal setup, first = 0, memory, at[LISTS], *lists;
  PetscLogDouble start = 0;
  TestWorld w = {0};
  TestCall(PetscOptionsGetInt(NULL, NULL, "-bench_warmup", &warmup, NULL));
  TestCall(PetscOptionsGetInt(NULL, NULL, "-bench_steps", &steps, NULL));
  PetscCheckAbort(warmup > 0 && steps > 0 && steps <= MOST_STEPS, PETSC_COMM_WORLD, PETSC_ERR_USER_INPUT,
                  "-bench_warmup %" PetscInt_FMT ", -bench_steps %" PetscInt_FMT
                  ": allowed: at least 1, at most %d steps",
                  warmup, steps, MOST_STEPS);
  TestCall(PetscMalloc1(LISTS * steps, &lists));
  Begin(&start);
  Create(&w);
  Elapsed(start, &setup);
  for (PetscInt i = 0; i < warmup + steps; i++) {
    Step(&w, at);
    if (!i) first = at[WALL];
    for (int k = 0; k < LISTS && i >= warmup; k++) lists[k * steps + i - warmup] = at[k];
  }
  PeakMemory(&memory);
  if (!w.fluid->grid->rank) Print(&w, setup, first, memory, steps, lists);
  TestCall(PetscFree(lists));
  TestWorldDestroy(&w);
}

int main(int argc, char **argv) {
  return CheckMain(argc, argv, Bench);
}
