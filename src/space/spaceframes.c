/* Surfaces at the saved times, in run.h5 and run.xmf. */
#include "base/version.h"
#include "numerics/blas.h"
#include "output/xdmf.h"
#include "space/spacemodel.h"

/* Harmonics at the points of a vesicle: the grid of degree p, then both poles. */
PetscErrorCode SpaceFramesPoints(SpaceModel m) {
  const PetscInt p = m->space->sphere->p, count = HarmonicsCount(p);
  const PetscReal pole[2] = {0, PETSC_PI}, zero = 0;
  SphereGrid g;
  PetscFunctionBeginUser;
  PetscCall(SphereGridCreate(p, GRID_WHOLE, &g));
  m->points = g.n + 2;
  PetscCall(PetscMalloc2(count * m->points, &m->Y, m->space->share.vesicles + 1, &m->first));
  for (PetscInt v = 0; v <= m->space->share.vesicles; v++) m->first[v] = v * m->points;
  for (PetscInt i = 0; i < m->points; i++)
    PetscCall(
        HarmonicsAt(p, p, 1, i < g.n ? &g.theta[i] : &pole[i - g.n], i < g.n ? &g.phi[i] : &zero, 1, m->Y + i * count));
  PetscCall(SphereGridDestroy(&g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Triangles between neighbouring latitudes, and of the caps about the poles: 4 (p + 1)^2 a vesicle. */
static PetscInt SpaceFramesTriangles(SpaceModel m) {
  return 2 * (m->points - 2);
}

static void SpaceFramesList(SpaceModel m, PetscInt list[]) {
  const PetscInt p = m->space->sphere->p, around = 2 * p + 2, grid = m->points - 2;
  PetscInt n = 0;
  for (PetscInt v = 0; v < m->space->share.vesicles; v++)
    for (PetscInt i = 0; i <= p + 1; i++) /* between the latitudes i - 1 and i; the poles are those beyond */
      for (PetscInt j = 0; j < around; j++) {
        const PetscInt next = (j + 1) % around, first = v * m->points;
        const PetscInt above[2] = {i ? (i - 1) * around + j : grid, i ? (i - 1) * around + next : grid},
                       below[2] = {i <= p ? i * around + j : grid + 1, i <= p ? i * around + next : grid + 1};
        const PetscInt triangles[2][3] = {{above[0], below[0], below[1]}, {above[0], below[1], above[1]}};
        for (int half = i > p; half < (i ? 2 : 1); half++)
          for (int corner = 0; corner < 3; corner++) list[n++] = first + triangles[half][corner];
      }
}

PetscErrorCode SpaceDescribe(const void *model, H5File *f) {
  const SpaceModel m = (SpaceModel)model;
  const PetscInt triangles = SpaceFramesTriangles(m) * m->space->share.vesicles, dim = 3;
  PetscInt *list;
  PetscReal *each;
  PetscFunctionBeginUser;
  H5Put(f, "dim", H5_INT, 1, &dim);
  H5Put(f, "degree", H5_INT, 1, &m->space->sphere->p);
  H5Put(f, "vesicles", H5_INT, 1, &m->space->share.vesicles);
  H5Put(f, "nu", H5_REAL, 1, &m->scene->fluid.nu);
  PetscCall(PetscMalloc1(m->space->share.vesicles, &each));
  for (PetscInt v = 0; v < m->space->share.vesicles; v++) each[v] = ListEntry(&m->scene->membrane.stiffness, 1, v, 0);
  H5Put(f, "vesicle_bending", H5_REAL, m->space->share.vesicles, each);
  PetscCall(PetscFree(each));
  PetscCall(PetscMalloc1(3 * triangles, &list));
  SpaceFramesList(m, list);
  H5PutRows(f, "/vesicle/triangles", H5_INT, triangles, 3, list);
  for (PetscInt k = 0; k < triangles; k++) list[k] = 1 + k / SpaceFramesTriangles(m);
  H5PutRows(f, "/vesicle/number", H5_INT, triangles, 0, list);
  PetscCall(PetscFree(list));
  H5PutText(f, "version", PETVES_VERSION);
  H5PutText(f, "git_commit", PetvesCommit());
  H5PutText(f, "about", "points of all vesicles, velocity and tension there; coefficients of real spherical harmonics");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceSeries(void *model, AppendedKind *kind) {
  const SpaceModel m = model;
  const PetscInt vesicles = m->space->share.vesicles, all = vesicles * m->points;
  PetscFunctionBeginUser;
  AppendedAddSeries(kind, (AppendedSeries){"/vesicle/points", all, 3, .unit = "length"});
  AppendedAddSeries(kind, (AppendedSeries){"/vesicle/velocity", all, 3, .unit = "length/time"});
  AppendedAddSeries(kind, (AppendedSeries){"/vesicle/tension", all, 1, .unit = "length^3/time^2"});
  AppendedAddSeries(kind, (AppendedSeries){"/vesicle/coefficients", 3 * vesicles, HarmonicsCount(m->space->sphere->p),
                                           .unit = "length"});
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* whole[vesicles][fields][HarmonicsCount(p)]: coefficients on whole spheres, on every rank. */
static PetscErrorCode SpaceGatherWhole(Space s, ModelPart part, PetscReal whole[]) {
  const PetscReal *const own[MODEL_PARTS] = {s->state.X, s->state.U, s->state.sigma};
  const PetscInt each = part == MODEL_TENSION ? s->count : s->size;
  const int components = part == MODEL_TENSION ? 1 : 3;
  PetscReal *all;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->share.vesicles * each, &all));
  PetscCall(ShareGather(&s->share, each, own[part], all));
  for (PetscInt v = 0; v < s->share.vesicles; v++)
    SphereUnfold(s->sphere, components, all + v * each, whole + v * components * HarmonicsCount(s->sphere->p));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceGather(void *model, ModelPart part, PetscReal y[]) {
  const SpaceModel m = model;
  const Space s = m->space;
  const PetscInt fields = part == MODEL_TENSION ? 1 : 3, count = HarmonicsCount(s->sphere->p);
  PetscReal *c;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->share.vesicles * fields * count, &c));
  PetscCall(SpaceGatherWhole(s, part, c));
  for (PetscInt v = 0; v < s->share.vesicles; v++)
    PetscCall(
        DenseProduct(PETSC_TRUE, fields, m->points, count, c + v * fields * count, m->Y, y + v * m->points * fields));
  PetscCall(PetscFree(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceFrame(void *model, AppendedFile *file) {
  const SpaceModel m = model;
  const Space s = m->space;
  PetscReal *all;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->share.vesicles * 3 * PetscMax(m->points, HarmonicsCount(s->sphere->p)), &all));
  for (int part = 0; part < MODEL_PARTS; part++) {
    PetscCall(SpaceGather(m, (ModelPart)part, all));
    AppendedSet(file, part, all);
  }
  PetscCall(SpaceGatherWhole(s, MODEL_POINTS, all));
  AppendedSet(file, MODEL_PARTS, all);
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SpacePrint(const void *model, FILE *f, PetscInt t, PetscReal time) {
  const SpaceModel m = (SpaceModel)model;
  const PetscInt points = m->points * m->space->share.vesicles,
                 triangles = SpaceFramesTriangles(m) * m->space->share.vesicles;
  const XdmfSlab place = {"/vesicle/points", 8, t, points, 0, 3, 3},
                 velocity = {"/vesicle/velocity", 8, t, points, 0, 3, 3},
                 tension = {"/vesicle/tension", 8, t, points, 0, 1, 0};
  fprintf(f, "<Grid Name=\"frame %d\" GridType=\"Uniform\"><Time Value=\"%.17g\"/>\n", (int)t, (double)time);
  fprintf(f, "<Topology TopologyType=\"Triangle\" NumberOfElements=\"%d\">", (int)triangles);
  XdmfPrintWhole(f, triangles, 3, "vesicle", "triangles");
  fprintf(f, "</Topology>\n<Attribute Name=\"vesicle\" AttributeType=\"Scalar\" Center=\"Cell\">");
  XdmfPrintWhole(f, triangles, 1, "vesicle", "number");
  fprintf(f, "</Attribute>\n<Geometry GeometryType=\"XYZ\">\n");
  XdmfPrintSlab(f, "", &place);
  fprintf(f, "</Geometry>\n");
  XdmfPrintAttribute(f, "tension", "Scalar", "", &tension);
  fprintf(f, "\n");
  XdmfPrintAttribute(f, "velocity", "Vector", "", &velocity);
  fprintf(f, "</Grid>\n");
}
