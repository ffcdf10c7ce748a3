/* A whole run: build everything from the options, step, write. */
#include "fluid/wisdom.h"
#include "output/output.h"
#include "petves.h"
#include <errno.h>
#include <unistd.h>

struct _p_Simulation {
  Scene scene;
  Shape shape;
  Fluid fluid;
  Membrane membrane;
  Coupling coupling;
  Scheme scheme;
  Output output;
  PetscReal next_output;
  PetscReal longest_step; /* wall seconds, with its output */
};

static const char help[] = "petves: inextensible vesicles in two-dimensional viscous flow.\n"
                           "usage: mpirun -n RANKS petves -options_file scene.opts [-option value ...]\n\n";

/* MPI is started here and not by PETSc, so that a missing -options_file gets its one line: PETSc reads it while it
   starts and would print a traceback. */
static PetscBool began_mpi = PETSC_FALSE;

static const char *MissingOptionsFile(int argc, char **argv) {
  for (int i = 1; i + 1 < argc; i++)
    if (!strcmp(argv[i], "-options_file") && access(argv[i + 1], R_OK)) return argv[i + 1];
  return NULL;
}

PetscErrorCode PetvesInitialize(int *argc, char ***argv) {
  int running, provided, missing = 0, rank;
  if (MPI_Initialized(&running)) return PETSC_ERR_MPI;
  began_mpi = running ? PETSC_FALSE : PETSC_TRUE;
  /* newer PETSc leaves the level to decide (negative) until it starts MPI itself */
  const int level = PETSC_MPI_THREAD_REQUIRED < 0 ? MPI_THREAD_FUNNELED : (int)PETSC_MPI_THREAD_REQUIRED;
  if (began_mpi && MPI_Init_thread(argc, argv, level, &provided)) return PETSC_ERR_MPI;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (!rank && MissingOptionsFile(*argc, *argv)) {
    fprintf(stderr, "petves: error: -options_file %s: cannot be opened (%s); allowed: a readable file of options\n",
            MissingOptionsFile(*argc, *argv), strerror(errno));
    missing = 1;
  }
  if (MPI_Bcast(&missing, 1, MPI_INT, 0, MPI_COMM_WORLD)) return PETSC_ERR_MPI;
  if (missing) {
    if (began_mpi) MPI_Finalize();
    return PETSC_ERR_FILE_OPEN;
  }
  StopClock();
  PetscFunctionBeginUser;
  PetscCall(PetscInitialize(argc, argv, NULL, help));
  PetscCall(PetscPushErrorHandler(PetvesErrorHandler, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PetvesFinalize(void) {
  PetscErrorCode error = PetscPopErrorHandler();
  PetscBool given = PETSC_FALSE;
  /* unused options have been reported in one line; newer PETSc would list them again */
  if (!PetscOptionsHasName(NULL, NULL, "-options_left", &given) && !given)
    (void)PetscOptionsSetValue(NULL, "-options_left", "no");
  if (!error) error = PetscFinalize();
  if (began_mpi && MPI_Finalize()) return PETSC_ERR_MPI;
  return error;
}

static PetscErrorCode Build(MPI_Comm comm, Simulation s) {
  const Kernel *kernel;
  PetscFunctionBeginUser;
  PetscCall(SceneCreate(comm, &s->scene));
  kernel = KernelFind(s->scene->delta);
  PetscCall(ShapeCreate(s->scene, kernel->default_spacing, kernel->least_spacing, &s->shape));
  PetscCall(WisdomRead(s->scene));
  PetscCall(SceneSetInertia(s->scene, &s->shape));
  if (*s->scene->warning) PetscCall(PetscPrintf(comm, "petves: warning: %s\n", s->scene->warning));
  PetscCall(FluidCreate(s->scene, &s->fluid));
  PetscCall(MembraneCreate(&s->shape, s->scene->bending, (DerivativeType)s->scene->derivative, &s->membrane));
  if (s->shape.vesicles) PetscCall(CouplingCreate(s->fluid->grid, s->membrane, s->scene->delta, &s->coupling));
  PetscCall(SchemeCreate(s->scene, s->fluid, s->membrane, s->coupling, s->shape.X, &s->scheme));
  PetscCall(SceneCheckUnused(s->scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationCreate(MPI_Comm comm, Simulation *out) {
  Simulation s;
  PetscBool only_help;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  PetscCall(PhaseBegin(PHASE_SETUP));
  PetscCall(PetvesSetupErrors(PETSC_TRUE));
  PetscCall(Build(comm, s));
  if (s->scene->view) PetscCall(SimulationView(s, PETSC_VIEWER_STDOUT_(comm)));
  PetscCall(PetscOptionsHasHelp(NULL, &only_help));
  if (!only_help) { /* -help leaves no files */
    PetscCall(WisdomWrite(s->scene));
    PetscCall(OutputCreate(s->scene, s->scheme, &s->output));
  }
  PetscCall(PetvesSetupErrors(PETSC_FALSE));
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationDestroy(Simulation *simulation) {
  Simulation s = *simulation;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(OutputDestroy(&s->output));
  PetscCall(SchemeDestroy(&s->scheme));
  PetscCall(CouplingDestroy(&s->coupling));
  PetscCall(MembraneDestroy(&s->membrane));
  PetscCall(FluidDestroy(&s->fluid));
  PetscCall(ShapeDestroy(&s->shape));
  PetscCall(SceneDestroy(&s->scene));
  PetscCall(PetscFree(*simulation));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationView(Simulation s, PetscViewer viewer) {
  PetscFunctionBeginUser;
  PetscCall(SceneView(s->scene, &s->shape, viewer));
  PetscCall(SchemeView(s->scheme, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetTime(Simulation s, PetscInt *step, PetscReal *time) {
  PetscFunctionBeginUser;
  if (step) *step = s->scheme->state.step;
  if (time) *time = s->scheme->state.t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetState(Simulation s, Vec *w, Vec *p, Vec *sigma, Vec *X, Vec *U) {
  PetscFunctionBeginUser;
  if (w) *w = s->scheme->state.w;
  if (p) *p = s->scheme->state.p;
  if (sigma) *sigma = s->scheme->state.sigma;
  if (X) *X = s->scheme->state.X;
  if (U) *U = s->scheme->state.U;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationStep(Simulation s, const char **failure) {
  const StepReport *report = &s->scheme->report;
  PetscFunctionBeginUser;
  PetscCall(SchemeStep(s->scheme, s->scene->adapt ? s->scene->t_end - s->scheme->state.t : s->scene->dt));
  *failure = *report->failure ? report->failure : NULL;
  if (!*failure) PetscCall(OutputSeries(s->output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Files that are due after a good step. */
static PetscErrorCode WriteDue(Simulation s) {
  const State *q = &s->scheme->state;
  const PetscInt every = s->scene->checkpoint_every;
  PetscFunctionBeginUser;
  if (q->t >= s->next_output - 1e-9 * q->dt) {
    PetscCall(OutputFields(s->output, PETSC_TRUE));
    s->next_output = OutputNextTime(s->output);
  }
  if (every && q->step % every == 0) PetscCall(OutputCheckpoint(s->output));
  PetscCall(OutputProgress(s->output, PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode IsSteady(Simulation s, PetscBool *steady) {
  const State *q = &s->scheme->state;
  const PetscScalar *X, *U;
  PetscFunctionBeginUser;
  *steady = PETSC_FALSE;
  if (s->scene->steady_tol <= 0 || !s->membrane->vesicles) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(q->X, &X));
  PetscCall(VecGetArrayRead(q->U, &U));
  *steady = MembraneNormalSpeed(s->membrane, X, U) < s->scene->steady_tol ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(VecRestoreArrayRead(q->U, &U));
  PetscCall(VecRestoreArrayRead(q->X, &X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first row and frame; those of a checkpoint are there already, or (in a new folder) its row is. */
static PetscErrorCode WriteFirst(Simulation s) {
  PetscFunctionBeginUser;
  if (!*s->scene->restart) PetscCall(OutputSeries(s->output));
  if (!s->output->go_on) PetscCall(OutputFields(s->output, PETSC_TRUE));
  s->next_output = OutputNextTime(s->output);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps and their files, until something ends the run: its reason, and the failure if it is one. */
static PetscErrorCode StepToEnd(Simulation s, const char **reason, const char **failure) {
  const State *q = &s->scheme->state;
  const char *why = NULL;
  PetscBool steady = PETSC_FALSE;
  PetscFunctionBeginUser;
  *failure = NULL;
  while (!steady && q->t < s->scene->t_end - (s->scene->adapt ? 1e-9 : 0.5) * s->scene->dt) {
    PetscLogDouble start, end;
    const PetscReal reserve = 1 + 1.5 * (s->longest_step + s->output->checkpoint_seconds);
    PetscCall(StopRequested(s->scene->comm, s->scene->wall_limit, reserve, &why));
    if (why) {
      PetscCall(PetscPrintf(s->scene->comm, "petves: stopping after step %" PetscInt_FMT ": %s\n", q->step, why));
      *reason = "stopped";
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    PetscCall(PetscTime(&start));
    PetscCall(SimulationStep(s, failure));
    if (*failure) {
      *reason = *failure;
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    PetscCall(WriteDue(s));
    PetscCall(IsSteady(s, &steady));
    PetscCall(PetscTime(&end));
    s->longest_step = PetscMax(s->longest_step, end - start);
  }
  *reason = steady ? "steady" : "finished";
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationRun(Simulation s, PetscBool *good) {
  const char *failure = NULL, *reason = NULL;
  PetscFunctionBeginUser;
  PetscCall(WriteFirst(s));
  PetscCall(StepToEnd(s, &reason, &failure));
  if (s->scheme->state.t > s->output->times[s->output->frames - 1])
    PetscCall(OutputFields(s->output, PETSC_FALSE)); /* the end state, when no saved time fell on it */
  PetscCall(OutputCheckpoint(s->output));
  PetscCall(OutputSummary(s->output, reason));
  PetscCall(OutputProgress(s->output, PETSC_TRUE));
  PetscCall(OutputFinalTable(s->output, failure ? "stopped" : reason));
  *good = failure ? PETSC_FALSE : PETSC_TRUE;
  if (failure && !s->fluid->grid->rank)
    fprintf(stderr, "petves: error: %s; the last good state is in %s/checkpoint.h5\n", failure, s->output->folder);
  PetscFunctionReturn(PETSC_SUCCESS);
}
