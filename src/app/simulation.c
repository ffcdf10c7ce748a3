/* A whole run: build everything from the options, step, write. */
#include "app/simulation.h"
#include "baselines/baselines.h"
#include "options/typed.h"
#include "space/fromscene.h"
#include <stdlib.h>

static const char help[] = "petves: vesicles and capsules in viscous flow.\n"
                           "usage: mpirun -n RANKS petves run SCENE.opts [-option value ...]\n\n";

/* MPI is started here and not by PETSc: what the user typed is read and checked before PETSc sees it. */
static PetscBool began_mpi = PETSC_FALSE;

/* Into the options database that PETSc will start with. */
static int ReadTyped(int argc, char **argv) {
  Typed typed = {0};
  int rank, error;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (!rank) TypedCommand(&typed, argc - 1, argv + 1);
  error = TypedShare(&typed, MPI_COMM_WORLD);
  if (!error && *typed.error) {
    if (!rank) fprintf(stderr, "petves: error: %s\n", typed.error);
    error = PETSC_ERR_USER_INPUT;
  }
  if (!error) error = (int)TypedInsert(&typed, scene_alternatives, NULL);
  TypedDestroy(&typed);
  return error;
}

PetscErrorCode PetvesInitialize(int *argc, char ***argv) {
  static char skip[] = "-skip_petscrc";
  int running, provided, one = 2;
  if (MPI_Initialized(&running)) return PETSC_ERR_MPI;
  began_mpi = running ? PETSC_FALSE : PETSC_TRUE;
  /* newer PETSc leaves the level to decide (negative) until it starts MPI itself */
  const int level = PETSC_MPI_THREAD_REQUIRED < 0 ? MPI_THREAD_FUNNELED : (int)PETSC_MPI_THREAD_REQUIRED;
  if (began_mpi && MPI_Init_thread(argc, argv, level, &provided)) return PETSC_ERR_MPI;
  if (ReadTyped(*argc, *argv)) {
    if (began_mpi) MPI_Finalize();
    return PETSC_ERR_USER_INPUT;
  }
  StopClock();
  unsetenv("PETSC_OPTIONS"); /* ReadTyped has read it */
  char *words[] = {(*argv)[0], skip, NULL}, **given = words;
  PetscFunctionBeginUser;
  PetscCall(PetscPushErrorHandler(PetvesErrorHandler, NULL));
  PetscCall(PetvesSetupErrors(PETSC_TRUE));
  PetscCall(PetscInitialize(&one, &given, NULL, help));
  PetscCall(PetvesSetupErrors(PETSC_FALSE));
  PetscCall(PetscOptionsClearValue(NULL, skip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PetvesFinalize(void) {
  PetscErrorCode error;
  PetscBool given = PETSC_FALSE;
  /* unused options have been reported in one line; newer PETSc would list them again */
  if (!PetscOptionsHasName(NULL, NULL, "-options_left", &given) && !given)
    (void)PetscOptionsSetValue(NULL, "-options_left", "no");
  (void)PetvesLastErrors();
  error = PetscFinalize();
  if (error)
    PetvesEndTogether(MPI_COMM_WORLD, NULL);
  else
    (void)PetscPopErrorHandler();
  if (began_mpi && MPI_Finalize()) return PETSC_ERR_MPI;
  return error;
}

PetscErrorCode PetvesReadOptions(MPI_Comm comm, PetscOptions options, const char path[], PetscInt n,
                                 const char *const word[]) {
  Typed typed = {0};
  PetscMPIInt rank;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) TypedCall(&typed, path, n, word);
  PetscCallMPI(TypedShare(&typed, comm));
  if (!*typed.error) PetscCall(TypedInsert(&typed, scene_alternatives, options));
  TypedDestroy(&typed);
  PetscCheck(!*typed.error, comm, PETSC_ERR_USER_INPUT, "%s", typed.error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateCoupling(Scene scene, Simulation s) {
  const PetscInt vesicles = scene->shape.vesicles;
  CouplingSetting setting = {.mobility = {.kernel = scene->coupling.kernel,
                                          .near = (NearFieldType)scene->coupling.near_field,
                                          .spec = &scene->fluid,
                                          .box_part = SceneHasBoxPart(scene),
                                          .lag = scene->fluid.inertia == INERTIA_UNSTEADY,
                                          .solver = !SceneIsProjection(scene)},
                             .area_target = SceneHasAreaTarget(scene),
                             .scene = scene};
  PetscReal *ratio;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(vesicles, &ratio));
  if (SceneHasContrast(scene)) setting.mobility.ratio = ratio;
  for (PetscInt v = 0; v < vesicles && setting.mobility.ratio; v++) ratio[v] = SceneViscosityRatio(scene, v);
  PetscCall(CouplingCreate(s->fluid, s->membrane, s->obstacles, &setting, &s->coupling));
  PetscCall(PetscFree(ratio));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which rank has which vesicles and obstacles. */
static PetscErrorCode CreateLayouts(MPI_Comm comm, Scene scene, Simulation s) {
  const Shape *vesicles = &scene->shape, *solid = &scene->obstacles.outline;
  const PetscInt n = vesicles->vesicles, all = n + solid->vesicles;
  PetscInt *start;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(all + 1, &start));
  PetscCall(PetscArraycpy(start, vesicles->start, n + 1));
  for (PetscInt b = 1; b <= solid->vesicles; b++) start[n + b] = start[n] + solid->start[b];
  PetscCall(LayoutCreate(comm, all, start, NULL, &s->all));
  PetscCall(LayoutCreatePart(s->all, 0, n, &s->layout));
  PetscCall(PetscFree(start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Build(MPI_Comm comm, PetvesFlow flow, void *ctx, Simulation s) {
  Scene scene;
  PetscFunctionBeginUser;
  PetscCall(PetvesWarmUpBlas(comm));
  PetscCall(SceneCreate(comm, flow, ctx, &s->scene));
  scene = s->scene;
  PetscCall(SceneCheckUsed(scene));
  if (scene->dim == DIM_SPACE) {
    PetscCall(SpaceFromScene(scene, &s->space));
    PetscCall(SceneCheckUnused(scene));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SceneReport(scene));
  PetscCall(FluidCreate(&scene->fluid, &s->fluid));
  PetscCall(CreateLayouts(comm, scene, s));
  PetscCall(ObstaclesCreate(scene, s->all, &s->obstacles));
  PetscCall(MembraneCreate(s->layout, scene->shape.X, &scene->membrane, &s->membrane));
  PetscCall(CreateCoupling(scene, s));
  PetscCall(BaselinesRegister());
  PetscCall(SchemeCreate(scene, s->coupling, scene->shape.X, &s->scheme));
  PetscCall(SceneCheckUnused(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationCreate(MPI_Comm comm, Simulation *out) {
  PetscFunctionBeginUser;
  PetscCall(SimulationCreateWithFlow(comm, NULL, NULL, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationCreateWithFlow(MPI_Comm comm, PetvesFlow flow, void *ctx, Simulation *out) {
  Simulation s;
  PetscBool only_help;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  StopClock(); /* where others have started PETSc: Python */
  PetscCall(PhaseBegin(PHASE_SETUP));
  PetscCall(PetvesSetupErrors(PETSC_TRUE));
  PetscCall(Build(comm, flow, ctx, s));
  if (s->scene->view) PetscCall(SimulationView(s, PETSC_VIEWER_STDOUT_(comm)));
  PetscCall(PetscOptionsHasHelp(NULL, &only_help));
  if (!only_help && s->space) PetscCall(SpaceOutputCreate(s->scene, s->space, &s->space_output));
  if (!only_help && !s->space) PetscCall(OutputCreate(s->scene, s->scheme, &s->output)); /* -help leaves no files */
  PetscCall(PetvesSetupErrors(PETSC_FALSE));
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationDestroy(Simulation *simulation) {
  Simulation s = *simulation;
  PetscErrorCode error;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  *simulation = NULL; /* the simulation is destroyed also when a file cannot be closed */
  error = s->space ? SpaceOutputDestroy(&s->space_output)
                   : OutputDestroy(&s->output); /* reported when all else is freed */
  PetscCall(SpaceDestroy(&s->space));
  for (int k = 0; k < 3; k++) PetscCall(PetscFree(s->gathered[k]));
  PetscCall(SchemeDestroy(&s->scheme));
  PetscCall(CouplingDestroy(&s->coupling));
  PetscCall(MembraneDestroy(&s->membrane));
  PetscCall(ObstaclesDestroy(&s->obstacles));
  PetscCall(LayoutDestroy(&s->layout));
  PetscCall(LayoutDestroy(&s->all));
  PetscCall(FluidDestroy(&s->fluid));
  PetscCall(SceneDestroy(&s->scene));
  PetscCall(PetscFree(s));
  PetscCall(error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationView(Simulation s, PetscViewer viewer) {
  PetscFunctionBeginUser;
  PetscCall(SceneView(s->scene, viewer));
  PetscCall(s->space ? KSPView(s->space->ksp, viewer) : SchemeView(s->scheme, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The time, and how steps are chosen. */
static PetscReal SimulationTime(Simulation s) {
  return s->space ? s->space->state.t : s->scheme->state.t;
}

static const StepPolicy *SimulationPolicy(Simulation s) {
  return s->space ? &s->space->setting.policy : &s->scheme->policy;
}

/* One step, to the time `until` at most, its row of series.csv and the files that are due; still: the largest normal
   speed of a vesicle, by the last row of the record, which every rank has. Adaptive steps end at the times of frames.
 */
static PetscErrorCode StepInPlane(Simulation s, PetscReal until, const char **failure, PetscReal *still) {
  const StepReport *report = &s->scheme->report;
  const Record *r = &s->output->record;
  PetscFunctionBeginUser;
  PetscCall(SchemeStep(s->scheme, s->scheme->policy.adaptive ? PetscMin(until, s->output->next) : until));
  *failure = *report->failure ? report->failure : NULL;
  if (!*failure) PetscCall(OutputStep(s->output));
  for (PetscInt v = 0; v < r->vesicles; v++) *still = PetscMax(*still, r->each[v * COLUMN_COUNT + COLUMN_NORMAL_SPEED]);
  if (!r->vesicles) *still = PETSC_MAX_REAL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StepInSpace(Simulation s, PetscReal until, const char **failure, PetscReal *still) {
  PetscFunctionBeginUser;
  PetscCall(SpaceStep(s->space, until));
  *failure = *s->space->report.failure ? s->space->report.failure : NULL;
  if (!*failure) PetscCall(SpaceOutputStep(s->space_output));
  *still = s->space_output->record.last[SPACE_NORMAL_SPEED];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TakeStep(Simulation s, PetscReal until, const char **failure) {
  PetscLogDouble start, end;
  PetscReal still = 0;
  PetscFunctionBeginUser;
  PetscCall(SimulationBegin(s));
  PetscCall(PetscTime(&start));
  PetscCall((s->space ? StepInSpace : StepInPlane)(s, until, failure, &still));
  s->steady = !*failure && still < s->scene->time.steady_tol;
  PetscCall(PetscTime(&end));
  s->longest_step = PetscMax(s->longest_step, end - start);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationBegin(Simulation s) {
  PetscFunctionBeginUser;
  if (s->begun) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(s->space ? SpaceStart(s->space) : SchemeStart(s->scheme));
  s->begun = PETSC_TRUE;
  s->reason = "finished";
  PetscCall(s->space ? SpaceOutputBegin(s->space_output) : OutputBegin(s->output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationStep(Simulation s, const char **failure) {
  const PetscReal end = s->scene->time.end;
  PetscFunctionBeginUser;
  PetscCall(TakeStep(s, StepFinished(SimulationPolicy(s), SimulationTime(s), end) ? PETSC_MAX_REAL : end, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationAdvance(Simulation s, PetscReal until, PetscBool *stepped, const char **failure) {
  const char *why = NULL;
  PetscFunctionBeginUser;
  *failure = NULL;
  *stepped = PETSC_FALSE;
  PetscCall(SimulationBegin(s));
  const PetscReal reserve = 1 + 1.5 * (s->space ? s->space_output->checkpoint_seconds : s->output->checkpoint_seconds);
  s->reason = s->steady ? "steady" : "finished";
  if (s->steady || StepFinished(SimulationPolicy(s), SimulationTime(s), until)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StopRequested(s->scene->comm, s->scene->time.wall_limit, reserve + 1.5 * s->longest_step, &why));
  if (why) {
    s->reason = "stopped";
    PetscCall(PetvesSay(s->scene->comm, "petves: stopping after step %" PetscInt_FMT ": %s\n",
                        s->space ? s->space->state.step : s->scheme->state.step, why));
  } else {
    PetscCall(TakeStep(s, until, failure));
    *stepped = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationEnd(Simulation s, const char *failure) {
  PetscFunctionBeginUser;
  PetscCall(SimulationBegin(s));
  PetscCall(s->space ? SpaceOutputEnd(s->space_output, s->reason, failure) : OutputEnd(s->output, s->reason, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationRun(Simulation s, PetscBool *good) {
  const char *failure = NULL;
  PetscBool stepped = PETSC_TRUE;
  PetscFunctionBeginUser;
  PetscCall(SimulationBegin(s));
  PetscCall(SceneSayModel(s->scene));
  while (stepped && !failure) PetscCall(SimulationAdvance(s, s->scene->time.end, &stepped, &failure));
  PetscCall(SimulationEnd(s, failure));
  *good = failure ? PETSC_FALSE : PETSC_TRUE;
  const Folder *folder = s->space ? &s->space_output->folder : &s->output->folder;
  if (failure && !folder->rank)
    fprintf(stderr, "petves: error: %s; the last good state is in %s/checkpoint.h5\n", failure, folder->path);
  PetscFunctionReturn(PETSC_SUCCESS);
}
