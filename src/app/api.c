/* Questions about a simulation, and calls from programs that handle errors themselves (Python). */
#include "app/simulation.h"
#include "plane/cells.h"
#include "scheme/fields.h"
#include <locale.h>
#include <stdlib.h>
#include <unistd.h>

/* The plane, which alone has a grid; stops in another kind of simulation. */
static PetscErrorCode AskPlane(Simulation s, Plane *plane) {
  PetscFunctionBeginUser;
  *plane = PlaneOf(&s->model);
  PetvesCheck(*plane, s->scene->comm, "-dim 3: no grid to ask for; allowed: -dim 2");
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
  const PetscReal **const wanted[MODEL_PARTS] = {markers, velocity, tension};
  const PetscInt points = s->model.first[s->model.columns.vesicles];
  PetscFunctionBeginUser;
  for (int k = 0; k < MODEL_PARTS; k++) {
    if (!wanted[k]) continue;
    if (!s->gathered[k]) PetscCall(PetscMalloc1(points * (k == MODEL_TENSION ? 1 : s->model.dim), &s->gathered[k]));
    PetscCall(s->model.ops.gather(s->model.context, (ModelPart)k, s->gathered[k]));
    *wanted[k] = s->gathered[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetObject(Simulation s, const char name[], PetscObject *object) {
  PetscFunctionBeginUser;
  PetscCall(s->model.ops.object(s->model.context, name, object));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetSizes(Simulation s, PetscInt *vesicles, PetscInt start[], PetscInt sizes[7]) {
  const Plane plane = PlaneOf(&s->model);
  PetscFunctionBeginUser;
  *vesicles = s->model.columns.vesicles;
  for (PetscInt v = 0; start && v <= *vesicles; v++) start[v] = s->model.first[v];
  PetscCall(PetscArrayzero(sizes, 7));
  if (!plane) PetscFunctionReturn(PETSC_SUCCESS);
  const Grid g = plane->fluid->grid;
  sizes[0] = g->first;
  for (int f = FIELD_U; f <= FIELD_P; f++) {
    sizes[1 + 2 * f] = g->rows[f];
    sizes[2 + 2 * f] = g->columns[f];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetObstacles(Simulation s, PetscInt *obstacles, PetscInt start[], PetscReal markers[]) {
  const Plane plane = PlaneOf(&s->model);
  PetscFunctionBeginUser;
  const Obstacles o = plane ? plane->coupling->bodies->obstacles : NULL;
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
