/* A whole run: build everything from the options, step, write. */
#include "app/simulation.h"
#include "options/typed.h"
#include "space/spacemodel.h"
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

PetscErrorCode SimulationCreate(MPI_Comm comm, Simulation *out) {
  PetscFunctionBeginUser;
  PetscCall(SimulationCreateWithFlow(comm, NULL, NULL, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationCreateWithFlow(MPI_Comm comm, PetvesFlow flow, void *ctx, Simulation *out) {
  PetscErrorCode (*const create[])(Scene, Model *) = {
      [DIM_PLANE] = PlaneCreate, [DIM_SPACE] = SpaceModelCreate, [DIM_AXIAL] = SpaceModelCreate};
  Simulation s;
  PetscBool only_help;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  StopClock(); /* where others have started PETSc: Python */
  PetscCall(PhaseBegin(PHASE_SETUP));
  PetscCall(PetvesSetupErrors(PETSC_TRUE));
  PetscCall(PetvesWarmUpBlas(comm));
  PetscCall(SceneCreate(comm, flow, ctx, &s->scene));
  PetscCall(SceneCheckUsed(s->scene));
  PetscCall(create[s->scene->dim](s->scene, &s->model));
  PetscCall(SceneCheckUnused(s->scene));
  if (s->scene->view) PetscCall(SimulationView(s, PETSC_VIEWER_STDOUT_(comm)));
  PetscCall(PetscOptionsHasHelp(NULL, &only_help));
  if (!only_help) PetscCall(OutputCreate(&s->model, &s->output)); /* -help leaves no files */
  PetscCall(PetvesSetupErrors(PETSC_FALSE));
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationDestroy(Simulation *simulation) {
  Simulation s = *simulation;
  PetscErrorCode error;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  *simulation = NULL;                /* the simulation is destroyed also when a file cannot be closed */
  error = OutputDestroy(&s->output); /* reported when all else is freed */
  for (int k = 0; k < 3; k++) PetscCall(PetscFree(s->gathered[k]));
  if (s->model.context) PetscCall(s->model.ops.destroy(s->model.context));
  PetscCall(SceneDestroy(&s->scene));
  PetscCall(PetscFree(s));
  PetscCall(error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationView(Simulation s, PetscViewer viewer) {
  PetscFunctionBeginUser;
  PetscCall(SceneView(s->scene, viewer));
  PetscCall(s->model.ops.view(s->model.context, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One step, to the time `until` at most, its row of series.csv and the files that are due. Adaptive steps end at the
   times of frames. The state is steady by the last row of the record, which every rank has. */
static PetscErrorCode TakeStep(Simulation s, PetscReal until, const char **failure) {
  const Model *m = &s->model;
  PetscLogDouble start, end;
  PetscFunctionBeginUser;
  PetscCall(SimulationBegin(s));
  PetscCall(PetscTime(&start));
  PetscCall(m->ops.step(m->context, m->policy->adaptive ? PetscMin(until, s->output->next) : until));
  *failure = *m->failure ? m->failure : NULL;
  if (!*failure) PetscCall(OutputStep(s->output));
  s->steady = !*failure && m->columns.vesicles &&
              RecordNumber(&s->output->record, "normal_speed") < s->scene->time.steady_tol;
  PetscCall(PetscTime(&end));
  s->longest_step = PetscMax(s->longest_step, end - start);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationBegin(Simulation s) {
  PetscFunctionBeginUser;
  if (s->begun) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(s->model.ops.start(s->model.context));
  s->begun = PETSC_TRUE;
  s->reason = "finished";
  PetscCall(OutputBegin(s->output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationStep(Simulation s, const char **failure) {
  const Model *m = &s->model;
  const PetscReal end = s->scene->time.end;
  PetscFunctionBeginUser;
  PetscCall(TakeStep(s, StepFinished(m->policy, *m->t, end) ? PETSC_MAX_REAL : end, failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationAdvance(Simulation s, PetscReal until, PetscBool *stepped, const char **failure) {
  const Model *m = &s->model;
  const char *why = NULL;
  PetscFunctionBeginUser;
  *failure = NULL;
  *stepped = PETSC_FALSE;
  PetscCall(SimulationBegin(s));
  const PetscReal reserve = 1 + 1.5 * s->output->checkpoint_seconds;
  s->reason = s->steady ? "steady" : "finished";
  if (s->steady || StepFinished(m->policy, *m->t, until)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StopRequested(s->scene->comm, s->scene->time.wall_limit, reserve + 1.5 * s->longest_step, &why));
  if (why) {
    s->reason = "stopped";
    PetscCall(PetvesSay(s->scene->comm, "petves: stopping after step %" PetscInt_FMT ": %s\n", *m->step, why));
  } else {
    PetscCall(TakeStep(s, until, failure));
    *stepped = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationEnd(Simulation s, const char *failure) {
  PetscFunctionBeginUser;
  PetscCall(SimulationBegin(s));
  PetscCall(OutputEnd(s->output, s->reason, failure));
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
  if (failure && !s->output->folder.rank)
    fprintf(stderr, "petves: error: %s; the last good state is in %s/checkpoint.h5\n", failure, s->output->folder.path);
  PetscFunctionReturn(PETSC_SUCCESS);
}
