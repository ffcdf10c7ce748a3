/* Questions about a simulation, and calls from programs that handle errors themselves (Python). */
#include "app/simulation.h"
#include "plane/cells.h"
#include "plane/gathered.h"
#include "scheme/fields.h"
#include <locale.h>
#include <stdlib.h>
#include <unistd.h>

/* The plane, of which alone some questions are; stops in another kind of simulation. */
static PetscErrorCode AskPlane(Simulation s, Plane *plane) {
  PetscFunctionBeginUser;
  *plane = PlaneOf(&s->model);
  PetvesCheck(*plane, s->scene->comm, "-dim 3: not from Python or C; allowed: 2, or petves run");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetTime(Simulation s, PetscInt *step, PetscReal *time) {
  PetscFunctionBeginUser;
  if (step) *step = *s->model.step;
  if (time) *time = *s->model.t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetState(Simulation s, Vec *w, Vec *p, Vec *sigma, Vec *X, Vec *U) {
  Plane plane;
  PetscFunctionBeginUser;
  PetscCall(AskPlane(s, &plane));
  if (w || p) PetscCall(SchemeFields(plane->scheme));
  if (w) *w = plane->scheme->state.w;
  if (p) *p = plane->scheme->state.p;
  if (sigma) *sigma = plane->scheme->state.sigma;
  if (X) *X = plane->scheme->state.X;
  if (U) *U = plane->scheme->state.U;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGatherMarkers(Simulation s, const PetscReal **markers, const PetscReal **velocity,
                                       const PetscReal **tension) {
  const PetscReal **const wanted[] = {markers, velocity, tension}; /* STATE_MARKERS, STATE_VELOCITY, STATE_TENSION */
  Plane plane;
  PetscFunctionBeginUser;
  PetscCall(AskPlane(s, &plane));
  for (int k = 0; k < 3; k++) {
    const StatePart part = StatePartOf(plane->scheme, &plane->scheme->state, (StatePartName)k);
    if (!wanted[k]) continue;
    if (!s->gathered[k]) PetscCall(PetscMalloc1(part.n * part.each, &s->gathered[k]));
    PetscCall(StateShow(plane->scheme, (StatePartName)k, s->gathered[k]));
    *wanted[k] = s->gathered[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc objects by name. A name that this simulation has no object for gives NULL. */
static PetscObject FindObject(Plane plane, const char name[]) {
  const State *q = &plane->scheme->state;
  const Fluid f = plane->fluid;
  const Coupling c = plane->coupling;
  const PetscBool any = CouplingHasMembrane(c);
  const struct {
    const char *name;
    void *object;
  } all[] = {{"velocity", q->w},
             {"pressure", q->p},
             {"tension", q->sigma},
             {"markers", q->X},
             {"marker_velocity", q->U},
             {"dm_velocity", f->grid->velocity},
             {"dm_u", f->grid->da[FIELD_U]},
             {"dm_v", f->grid->da[FIELD_V]},
             {"dm_pressure", f->grid->da[FIELD_P]},
             {"pc_helmholtz", f->Hinv},
             {"pc_poisson", f->Linv},
             {"mat_G", f->G},
             {"mat_D", f->D},
             {"mat_L", f->L},
             {"mat_H", f->H},
             {"mat_E", any ? c->markers->E : NULL},
             {"mat_S", any ? c->S : NULL},
             {"mat_B", any ? c->B : NULL}};
  for (size_t i = 0; i < sizeof(all) / sizeof(all[0]); i++)
    if (!strcmp(name, all[i].name)) return (PetscObject)all[i].object;
  return NULL;
}

PetscErrorCode SimulationGetObject(Simulation s, const char name[], PetscObject *object) {
  Plane plane;
  PetscFunctionBeginUser;
  PetscCall(AskPlane(s, &plane));
  if (!strcmp(name, "velocity") || !strcmp(name, "pressure")) PetscCall(SchemeFields(plane->scheme));
  *object = FindObject(plane, name);
  if (!*object) PetscCall(SchemeGetKSP(plane->scheme, name, (KSP *)object));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetSizes(Simulation s, PetscInt *vesicles, PetscInt start[], PetscInt sizes[7]) {
  Plane plane;
  PetscFunctionBeginUser;
  PetscCall(AskPlane(s, &plane));
  const Grid g = plane->fluid->grid;
  *vesicles = plane->layout->bodies;
  for (PetscInt v = 0; start && v <= plane->layout->bodies; v++) start[v] = plane->layout->start[v];
  sizes[0] = g->first;
  for (int f = FIELD_U; f <= FIELD_P; f++) {
    sizes[1 + 2 * f] = g->rows[f];
    sizes[2 + 2 * f] = g->columns[f];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetObstacles(Simulation s, PetscInt *obstacles, PetscInt start[], PetscReal markers[]) {
  Plane plane;
  PetscFunctionBeginUser;
  PetscCall(AskPlane(s, &plane));
  const Obstacles o = plane->coupling->bodies->obstacles;
  *obstacles = o ? o->layout->bodies : 0;
  for (PetscInt v = 0; start && v <= *obstacles; v++) start[v] = o ? o->layout->start[v] : 0;
  if (o && markers) ObstaclesCurves(o, StateInstant(&plane->scheme->state), markers);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetOption(Simulation s, PetscInt i, const char **name, char value[], size_t length) {
  const OptionRow *row = SceneOptionRow(i);
  PetscFunctionBeginUser;
  *name = row ? row->name : NULL;
  if (*name) PetscCall(OptionValue(&s->scene->options, s->scene, i, value, length));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetColumn(Simulation s, PetscInt i, const char **name) {
  PetscFunctionBeginUser;
  *name = i >= 0 && i < s->model.columns.columns ? s->model.columns.column[i].name : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetRow(Simulation s, PetscInt vesicle, PetscReal row[]) {
  const Record *record = &s->output->record;
  const PetscInt columns = record->setting.columns, vesicles = record->setting.vesicles;
  PetscFunctionBeginUser;
  PetscCheck(vesicle >= -1 && vesicle < vesicles, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "vesicle %" PetscInt_FMT ": out of range; allowed: 0 to %" PetscInt_FMT, vesicle, vesicles - 1);
  PetscCall(PetscArraycpy(row, vesicle < 0 ? record->last : record->each + vesicle * columns, columns));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetCellVelocity(Simulation s, PetscReal u[], PetscReal v[]) {
  Plane plane;
  PetscFunctionBeginUser;
  PetscCall(AskPlane(s, &plane));
  PetscCall(CellFields(plane->scheme, u, v, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetCellPressure(Simulation s, PetscReal p[]) {
  Plane plane;
  PetscFunctionBeginUser;
  PetscCall(AskPlane(s, &plane));
  PetscCall(CellFields(plane->scheme, NULL, NULL, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetReason(Simulation s, const char **reason) {
  PetscFunctionBeginUser;
  *reason = s->reason;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationCheckpoint(Simulation s) {
  PetscFunctionBeginUser;
  PetscCall(OutputCheckpoint(s->output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetWarning(Simulation s, PetscInt i, const char **text) {
  PetscFunctionBeginUser;
  *text = s->model.ops.warning(s->model.context, i);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PetvesAgree(MPI_Comm comm, PetscInt mine, PetscInt *largest) {
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(&mine, largest, 1, MPIU_INT, MPI_MAX, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PetvesTemporaryFolder(MPI_Comm comm, char path[]) {
  const char *base = getenv("TMPDIR");
  PetscMPIInt rank, failed = 0;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscSNPrintf(path, PETSC_MAX_PATH_LEN, "%s/petves-XXXXXX", base && *base ? base : "/tmp"));
  if (!rank) failed = !mkdtemp(path);
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(path, PETSC_MAX_PATH_LEN, MPI_CHAR, 0, comm));
  PetscCheck(!failed, comm, PETSC_ERR_USER_INPUT,
             "%s: cannot be made; allowed: a TMPDIR that can be written, or an -output_dir", path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* This thread's locale outside PetvesEnter, and the number of PetvesEnter that are open on this thread. */
static _Thread_local locale_t callers;
static _Thread_local int entered;

PetscErrorCode PetvesEnter(PetscOptions options, char message[], PetscInt *depth) {
  PetscFunctionBeginUser;
  message[0] = 0;
  *depth = PhaseDepth();
  const locale_t before = uselocale(newlocale(LC_ALL_MASK, "C", (locale_t)0)); /* no decimal commas */
  if (!entered++) callers = before;
  PetscCall(PetscOptionsPush(options));
  PetscCall(PetscPushErrorHandler(PetvesErrorHandler, message));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PetvesLeave(PetscInt depth) {
  PetscFunctionBeginUser;
  PetscCall(PetscPopErrorHandler());
  PetscCall(PetscOptionsPop());
  PetscCall(PetvesSetupErrors(PETSC_FALSE));
  while (PhaseDepth() > depth) PetscCall(PhaseEnd());
  if (!--entered) (void)uselocale(callers);
  PetscFunctionReturn(PETSC_SUCCESS);
}
