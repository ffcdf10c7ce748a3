#include "plane/plane.h"
#include "plane/gathered.h"
#include "scheme/fields.h"
#include "baselines/baselines.h"

static PetscErrorCode PlaneCreateCoupling(Scene scene, Plane p) {
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
  PetscCall(CouplingCreate(p->fluid, p->membrane, p->obstacles, &setting, &p->coupling));
  PetscCall(PetscFree(ratio));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which rank has which vesicles and obstacles. */
static PetscErrorCode PlaneCreateLayouts(MPI_Comm comm, Scene scene, Plane p) {
  const Shape *vesicles = &scene->shape, *solid = &scene->obstacles.outline;
  const PetscInt n = vesicles->vesicles, all = n + solid->vesicles;
  PetscInt *start;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(all + 1, &start));
  PetscCall(PetscArraycpy(start, vesicles->start, n + 1));
  for (PetscInt b = 1; b <= solid->vesicles; b++) start[n + b] = start[n] + solid->start[b];
  PetscCall(LayoutCreate(comm, all, start, NULL, &p->all));
  PetscCall(LayoutCreatePart(p->all, 0, n, &p->layout));
  PetscCall(PetscFree(start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PlaneStart(void *plane) {
  PetscFunctionBeginUser;
  PetscCall(SchemeStart(((Plane)plane)->scheme));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PlaneStep(void *plane, PetscReal until) {
  const Plane p = plane;
  PetscFunctionBeginUser;
  PetscCall(SchemeStep(p->scheme, until));
  if (!*p->scheme->report.failure) PetscCall(TracersMove(&p->tracers, p->scheme));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PlaneView(void *plane, PetscViewer viewer) {
  PetscFunctionBeginUser;
  PetscCall(SchemeView(((Plane)plane)->scheme, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PlaneOptions(void *plane, FILE *file) {
  PetscFunctionBeginUser;
  PetscCall(SchemeWriteOptions(((Plane)plane)->scheme, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The warning of the scene comes first. */
static const char *PlaneWarning(const void *plane, PetscInt i) {
  const Plane p = (Plane)plane;
  const Warnings *warnings = &p->scheme->warnings;
  if (*p->scene->warning && i-- == 0) return p->scene->warning;
  return i >= 0 && i < warnings->n ? warnings->text[i] : NULL;
}

static void PlaneSummary(const void *plane, FILE *f) {
  static const char *const models[] = {"unsteady", "none", "unsteady", "convective"}; /* of InertiaType */
  const Plane p = (Plane)plane;
  const Scene scene = p->scene;
  PetscReal low = PETSC_MAX_REAL, high = 0;
  fprintf(f,
          "  \"totals\": {\"steps\": %d, \"nsolve\": %d, \"tension_its\": %d, \"bending_its\": %d, "
          "\"coupled_its\": %d},\n",
          (int)p->scheme->state.step, (int)p->totals[TOTAL_SOLVES], (int)p->totals[TOTAL_TENSION],
          (int)p->totals[TOTAL_BENDING], (int)p->totals[TOTAL_COUPLED]);
  fprintf(f, "  \"markers\": %d,\n  \"cells\": [%d, %d],\n", (int)p->layout->M, (int)scene->fluid.cells[0],
          (int)scene->fluid.cells[1]);
  for (PetscInt v = 0; v < scene->shape.vesicles; v++) {
    low = PetscMin(low, SceneViscosityRatio(scene, v));
    high = PetscMax(high, SceneViscosityRatio(scene, v));
  }
  if (SceneHasContrast(scene)) fprintf(f, "  \"viscosity_ratio\": [%.6g, %.6g],\n", (double)low, (double)high);
  fprintf(f, "  \"inertia\": \"%s\",\n", models[scene->fluid.inertia]);
  /* null: not known; of the steps without convection the CFL number is 0 */
  fprintf(f, scene->reynolds >= 0 ? "  \"reynolds\": %.6g,\n" : "  \"reynolds\": null,\n", (double)scene->reynolds);
  fprintf(f, "  \"cfl_max\": %.6g,\n", (double)p->cfl_max);
}

/* The lines that only a run with vesicles has. */
static PetscErrorCode PlaneTableVesicles(Plane p, PetscReal steps, const PetscReal row[]) {
  const MPI_Comm comm = p->scene->comm;
  PetscFunctionBeginUser;
  PetscCall(PetvesSay(comm, "  energy, kinetic and bending   %.6e  %.6e\n", (double)row[COLUMN_KINETIC],
                      (double)row[COLUMN_BENDING]));
  PetscCall(PetvesSay(comm, "  area error, %s  %.3e  %.3e\n",
                      p->membrane->stretches ? "change of length" : "length error    ", (double)row[COLUMN_AREA_ERROR],
                      (double)row[COLUMN_LENGTH_ERROR]));
  PetscCall(PetvesSay(comm, "  inclination (radians)         %.6f\n", (double)row[COLUMN_INCLINATION]));
  if (!PetscIsNanReal(row[COLUMN_FREQUENCY]))
    PetscCall(PetvesSay(comm, "  tank-treading frequency       %.6f\n", (double)row[COLUMN_FREQUENCY]));
  PetscCall(PetvesSay(comm, "  iterations a step             "));
  if (p->totals[TOTAL_COUPLED])
    PetscCall(PetvesSay(comm, "coupled %.1f\n", (double)p->totals[TOTAL_COUPLED] / (double)steps));
  else
    PetscCall(PetvesSay(comm, "tension %.1f, bending %.1f\n", (double)p->totals[TOTAL_TENSION] / (double)steps,
                        (double)p->totals[TOTAL_BENDING] / (double)steps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PlaneTable(const void *plane, const PetscReal row[]) {
  const Plane p = (Plane)plane;
  const MPI_Comm comm = p->scene->comm;
  const PetscReal steps = PetscMax(1, row[COLUMN_STEP]);
  PetscFunctionBeginUser;
  if (p->layout->bodies) PetscCall(PlaneTableVesicles(p, steps, row));
  PetscCall(PetvesSay(comm, "  max |div u|                   %.3e\n", (double)row[COLUMN_DIV]));
  PetscCall(PetvesSay(comm, "  fast solves a step            %.1f\n", (double)p->totals[TOTAL_SOLVES] / (double)steps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PlaneGather(void *plane, ModelPart part, PetscReal numbers[]) {
  const StatePartName name[MODEL_PARTS] = {STATE_MARKERS, STATE_VELOCITY, STATE_TENSION};
  PetscFunctionBeginUser;
  PetscCall(StateShow(((Plane)plane)->scheme, name[part], numbers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PlaneObject(void *plane, const char name[], PetscObject *object) {
  const Plane p = plane;
  const Fluid f = p->fluid;
  const Coupling c = p->coupling;
  const PetscBool any = CouplingHasMembrane(c);
  PetscFunctionBeginUser;
  if (!strcmp(name, "velocity") || !strcmp(name, "pressure")) PetscCall(SchemeFields(p->scheme));
  const State *q = &p->scheme->state;
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
  *object = NULL;
  for (size_t i = 0; i < sizeof(all) / sizeof(all[0]); i++)
    if (!strcmp(name, all[i].name)) *object = (PetscObject)all[i].object;
  if (!*object) PetscCall(SchemeGetKSP(p->scheme, name, (KSP *)object));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PlaneDestroy(void *plane) {
  Plane p = plane;
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(p->cells[0], p->cells[1], p->cells[2], p->shown));
  PetscCall(PetscFree(p->extra));
  PetscCall(PetscFree(p->work));
  PetscCall(TracersDestroy(&p->tracers));
  PetscCall(SchemeDestroy(&p->scheme));
  PetscCall(CouplingDestroy(&p->coupling));
  PetscCall(MembraneDestroy(&p->membrane));
  PetscCall(ObstaclesDestroy(&p->obstacles));
  PetscCall(LayoutDestroy(&p->layout));
  PetscCall(LayoutDestroy(&p->all));
  PetscCall(FluidDestroy(&p->fluid));
  PetscCall(PetscFree(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const ModelOps PlaneOps = {.start = PlaneStart,
                                  .step = PlaneStep,
                                  .view = PlaneView,
                                  .destroy = PlaneDestroy,
                                  .row = PlaneRow,
                                  .measure = PlaneMeasure,
                                  .warning = PlaneWarning,
                                  .series = PlaneSeries,
                                  .describe = PlaneDescribe,
                                  .frame = PlaneFrame,
                                  .print = PlanePrint,
                                  .checkpoint = PlaneCheckpoint,
                                  .options = PlaneOptions,
                                  .summary = PlaneSummary,
                                  .table = PlaneTable,
                                  .gather = PlaneGather,
                                  .object = PlaneObject};

PetscErrorCode PlaneCreate(Scene scene, Model *model) {
  RecordSetting columns;
  Plane p;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&p));
  *model = (Model){.ops = PlaneOps, .context = p};
  p->scene = scene;
  PetscCall(SceneReport(scene));
  PetscCall(FluidCreate(&scene->fluid, &p->fluid));
  PetscCall(PlaneCreateLayouts(scene->comm, scene, p));
  PetscCall(ObstaclesCreate(scene, p->all, &p->obstacles));
  PetscCall(MembraneCreate(p->layout, scene->shape.X, &scene->membrane, &p->membrane));
  PetscCall(PlaneCreateCoupling(scene, p));
  PetscCall(BaselinesRegister());
  PetscCall(SchemeCreate(scene, p->coupling, scene->shape.X, &p->scheme));
  PetscCall(TracersCreate(scene, &p->tracers));
  PetscCall(PlaneColumns(p, &columns));
  const Scheme s = p->scheme;
  *model = (Model){.ops = PlaneOps,
                   .context = p,
                   .scene = scene,
                   .step = &s->state.step,
                   .t = &s->state.t,
                   .dt = &s->state.dt,
                   .failure = s->report.failure,
                   .policy = &s->policy,
                   .columns = columns,
                   .dim = 2,
                   .first = p->layout->start};
  PetscFunctionReturn(PETSC_SUCCESS);
}

Plane PlaneOf(const Model *model) {
  return model->ops.step == PlaneStep ? (Plane)model->context : NULL;
}
