/* Questions about a simulation, and calls from programs that handle errors themselves (Python). */
#include "app/simulation.h"
#include "output/cells.h"
#include "scheme/fields.h"
#include <locale.h>
#include <stdlib.h>
#include <unistd.h>

/* Stop where a question is one of the plane alone. */
static PetscErrorCode CheckPlane(Simulation s) {
  PetscFunctionBeginUser;
  PetvesCheck(!s->space, s->scene->comm, "-dim 3: not from Python or C; allowed: 2, or petves run");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetTime(Simulation s, PetscInt *step, PetscReal *time) {
  PetscFunctionBeginUser;
  if (step) *step = s->space ? s->space->state.step : s->scheme->state.step;
  if (time) *time = s->space ? s->space->state.t : s->scheme->state.t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetState(Simulation s, Vec *w, Vec *p, Vec *sigma, Vec *X, Vec *U) {
  PetscFunctionBeginUser;
  PetscCall(CheckPlane(s));
  if (w || p) PetscCall(SchemeFields(s->scheme));
  if (w) *w = s->scheme->state.w;
  if (p) *p = s->scheme->state.p;
  if (sigma) *sigma = s->scheme->state.sigma;
  if (X) *X = s->scheme->state.X;
  if (U) *U = s->scheme->state.U;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGatherMarkers(Simulation s, const PetscReal **markers, const PetscReal **velocity,
                                       const PetscReal **tension) {
  const PetscReal **const wanted[] = {markers, velocity, tension}; /* STATE_MARKERS, STATE_VELOCITY, STATE_TENSION */
  PetscFunctionBeginUser;
  PetscCall(CheckPlane(s));
  for (int k = 0; k < 3; k++) {
    const StatePart part = StatePartOf(s->scheme, &s->scheme->state, (StatePartName)k);
    if (!wanted[k]) continue;
    if (!s->gathered[k]) PetscCall(PetscMalloc1(part.n * part.each, &s->gathered[k]));
    PetscCall(StateShow(s->scheme, (StatePartName)k, s->gathered[k]));
    *wanted[k] = s->gathered[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc objects by name. A name that this simulation has no object for gives NULL. */
static PetscObject FindObject(Simulation s, const char name[]) {
  const State *q = &s->scheme->state;
  const Fluid f = s->fluid;
  const Coupling c = s->coupling;
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
  PetscFunctionBeginUser;
  PetscCall(CheckPlane(s));
  if (!strcmp(name, "velocity") || !strcmp(name, "pressure")) PetscCall(SchemeFields(s->scheme));
  *object = FindObject(s, name);
  if (!*object) PetscCall(SchemeGetKSP(s->scheme, name, (KSP *)object));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetSizes(Simulation s, PetscInt *vesicles, PetscInt start[], PetscInt sizes[7]) {
  PetscFunctionBeginUser;
  PetscCall(CheckPlane(s));
  const Grid g = s->fluid->grid;
  *vesicles = s->layout->bodies;
  for (PetscInt v = 0; start && v <= s->layout->bodies; v++) start[v] = s->layout->start[v];
  sizes[0] = g->first;
  for (int f = FIELD_U; f <= FIELD_P; f++) {
    sizes[1 + 2 * f] = g->rows[f];
    sizes[2 + 2 * f] = g->columns[f];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetObstacles(Simulation s, PetscInt *obstacles, PetscInt start[], PetscReal markers[]) {
  PetscFunctionBeginUser;
  PetscCall(CheckPlane(s));
  const Obstacles o = s->coupling->bodies->obstacles;
  *obstacles = o ? o->layout->bodies : 0;
  for (PetscInt v = 0; start && v <= *obstacles; v++) start[v] = o ? o->layout->start[v] : 0;
  if (o && markers) ObstaclesCurves(o, StateInstant(&s->scheme->state), markers);
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
  *name = i >= 0 && i < COLUMN_COUNT ? SeriesColumns[i] : NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetRow(Simulation s, PetscInt vesicle, PetscReal row[]) {
  PetscFunctionBeginUser;
  PetscCall(CheckPlane(s));
  const Record *record = &s->output->record;
  PetscCheck(vesicle >= -1 && vesicle < s->layout->bodies, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "vesicle %" PetscInt_FMT ": out of range; allowed: 0 to %" PetscInt_FMT, vesicle, s->layout->bodies - 1);
  PetscCall(PetscArraycpy(row, vesicle < 0 ? record->last : record->each + vesicle * COLUMN_COUNT, COLUMN_COUNT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetCellVelocity(Simulation s, PetscReal u[], PetscReal v[]) {
  PetscFunctionBeginUser;
  PetscCall(CheckPlane(s));
  PetscCall(CellFields(s->scheme, u, v, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetCellPressure(Simulation s, PetscReal p[]) {
  PetscFunctionBeginUser;
  PetscCall(CheckPlane(s));
  PetscCall(CellFields(s->scheme, NULL, NULL, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetReason(Simulation s, const char **reason) {
  PetscFunctionBeginUser;
  *reason = s->reason;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationCheckpoint(Simulation s) {
  PetscFunctionBeginUser;
  PetscCall(s->space ? SpaceCheckpoint(s->space_output) : OutputCheckpoint(s->output));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SimulationGetWarning(Simulation s, PetscInt i, const char **text) {
  const PetscInt own = *s->scene->warning ? 1 : 0;
  PetscFunctionBeginUser;
  *text = NULL;
  if (s->space) PetscFunctionReturn(PETSC_SUCCESS);
  const Warnings *warnings = &s->scheme->warnings;
  if (i >= 0 && i < own)
    *text = s->scene->warning;
  else if (i >= own && i < own + warnings->n)
    *text = warnings->text[i - own];
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
