/* Surfaces at the saved times, in run.h5 and run.xmf. */
#include "base/version.h"
#include "output/spaceoutput.h"

/* Harmonics at the points of a vesicle: the grid of degree p, then both poles. */
static PetscErrorCode SpaceFramesPoints(SpaceOutput o) {
  const SphereGrid *g = &o->space->sphere->shape.grid;
  PetscReal *theta, *phi;
  PetscFunctionBeginUser;
  o->points = g->n + 2;
  PetscCall(PetscMalloc1(o->space->count * o->points, &o->Y));
  PetscCall(PetscMalloc2(o->points, &theta, o->points, &phi));
  PetscCall(PetscArraycpy(theta, g->theta, g->n));
  PetscCall(PetscArraycpy(phi, g->phi, g->n));
  theta[g->n] = phi[g->n] = phi[g->n + 1] = 0;
  theta[g->n + 1] = PETSC_PI;
  PetscCall(HarmonicsAt(o->space->sphere->p, o->points, theta, phi, 1, o->Y));
  PetscCall(PetscFree2(theta, phi));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Triangles between neighbouring latitudes, and of the caps about the poles: 4 (p + 1)^2 a vesicle. */
static PetscInt SpaceFramesTriangles(SpaceOutput o) {
  return 2 * (o->points - 2);
}

static void SpaceFramesList(SpaceOutput o, PetscInt list[]) {
  const PetscInt p = o->space->sphere->p, around = 2 * p + 2, grid = o->points - 2;
  PetscInt n = 0;
  for (PetscInt v = 0; v < o->space->share.vesicles; v++)
    for (PetscInt i = 0; i <= p + 1; i++) /* between the latitudes i - 1 and i; the poles are those beyond */
      for (PetscInt j = 0; j < around; j++) {
        const PetscInt next = (j + 1) % around, first = v * o->points;
        const PetscInt above[2] = {i ? (i - 1) * around + j : grid, i ? (i - 1) * around + next : grid},
                       below[2] = {i <= p ? i * around + j : grid + 1, i <= p ? i * around + next : grid + 1};
        const PetscInt triangles[2][3] = {{above[0], below[0], below[1]}, {above[0], below[1], above[1]}};
        for (int half = i > p; half < (i ? 2 : 1); half++)
          for (int corner = 0; corner < 3; corner++) list[n++] = first + triangles[half][corner];
      }
}

static PetscErrorCode SpaceFramesDescribe(const void *context, H5File *f) {
  const SpaceOutput o = (SpaceOutput)context;
  const PetscInt triangles = SpaceFramesTriangles(o) * o->space->share.vesicles, dim = 3;
  PetscInt *list;
  PetscReal *each;
  PetscFunctionBeginUser;
  H5Put(f, "dim", H5_INT, 1, &dim);
  H5Put(f, "degree", H5_INT, 1, &o->space->sphere->p);
  H5Put(f, "vesicles", H5_INT, 1, &o->space->share.vesicles);
  H5Put(f, "nu", H5_REAL, 1, &o->scene->fluid.nu);
  PetscCall(PetscMalloc1(o->space->share.vesicles, &each));
  for (PetscInt v = 0; v < o->space->share.vesicles; v++) each[v] = ListEntry(&o->scene->membrane.stiffness, 1, v, 0);
  H5Put(f, "vesicle_bending", H5_REAL, o->space->share.vesicles, each);
  PetscCall(PetscFree(each));
  PetscCall(PetscMalloc1(3 * triangles, &list));
  SpaceFramesList(o, list);
  H5PutRows(f, "/vesicle/triangles", H5_INT, triangles, 3, list);
  for (PetscInt k = 0; k < triangles; k++) list[k] = 1 + k / SpaceFramesTriangles(o);
  H5PutRows(f, "/vesicle/number", H5_INT, triangles, 0, list);
  PetscCall(PetscFree(list));
  H5PutText(f, "version", PETVES_VERSION);
  H5PutText(f, "git_commit", PetvesCommit());
  H5PutText(f, "about", "points of all vesicles, velocity and tension there; coefficients of real spherical harmonics");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceFramesOpen(SpaceOutput o) {
  const Space s = o->space;
  AppendedKind kind = {
      .name = "run.h5", .entries = "frames", .now = s->state.t, .context = o, .describe = SpaceFramesDescribe, .n = 4};
  PetscFunctionBeginUser;
  PetscCall(SpaceFramesPoints(o));
  const PetscInt all = s->share.vesicles * o->points;
  kind.series[0] = (AppendedSeries){"/vesicle/points", all, 3, .unit = "length"};
  kind.series[1] = (AppendedSeries){"/vesicle/velocity", all, 3, .unit = "length/time"};
  kind.series[2] = (AppendedSeries){"/vesicle/tension", all, 1, .unit = "length^3/time^2"};
  kind.series[3] = (AppendedSeries){"/vesicle/coefficients", 3 * s->share.vesicles, s->count, .unit = "length"};
  PetscCall(
      AppendedOpen(&o->frames, &o->folder, &kind, o->go_on ? o->scheduled : APPENDED_NEW, o->scene->output.restart));
  o->scheduled = o->frames.count;
  if (o->scheduled) o->shown = o->frames.time[o->scheduled - 1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The next entry of a series: fields with coefficients own[own][fields][count], at all points [vesicles
 * points][fields]. */
static PetscErrorCode SpaceFramesSet(SpaceOutput o, PetscInt series, PetscInt fields, const PetscReal own[]) {
  const Space s = o->space;
  PetscReal *c, *y;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(s->share.vesicles * fields * s->count, &c, s->share.vesicles * fields * o->points, &y));
  PetscCall(ShareGather(&s->share, fields * s->count, own, c));
  PetscCall(PetscArrayzero(y, s->share.vesicles * fields * o->points));
  for (PetscInt v = 0; v < s->share.vesicles && !o->folder.rank; v++)
    for (PetscInt f = 0; f < fields; f++)
      for (PetscInt k = 0; k < s->count; k++)
        for (PetscInt i = 0; i < o->points; i++)
          y[(v * o->points + i) * fields + f] += c[(v * fields + f) * s->count + k] * o->Y[k * o->points + i];
  AppendedSet(&o->frames, series, y);
  PetscCall(PetscFree2(c, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceFramesWrite(SpaceOutput o, PetscBool scheduled) {
  const Space s = o->space;
  PetscReal *all;
  PetscFunctionBeginUser;
  o->frames.count = o->scheduled; /* a frame that is not scheduled is replaced */
  PetscCall(SpaceFramesSet(o, 0, 3, s->state.X));
  PetscCall(SpaceFramesSet(o, 1, 3, s->state.U));
  PetscCall(SpaceFramesSet(o, 2, 1, s->state.sigma));
  PetscCall(PetscMalloc1(s->share.vesicles * s->size, &all));
  PetscCall(ShareGather(&s->share, s->size, s->state.X, all));
  AppendedSet(&o->frames, 3, all);
  PetscCall(PetscFree(all));
  PetscCall(AppendedFlush(&o->frames, PETSC_FALSE)); /* values before the time by which readers count them */
  PetscCall(AppendedAdd(&o->frames, s->state.t));
  PetscCall(AppendedFlush(&o->frames, PETSC_FALSE));
  if (scheduled) o->scheduled = o->frames.count;
  o->shown = s->state.t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SpaceFramesPrint(const void *output, FILE *f, PetscInt t, PetscReal time) {
  const SpaceOutput o = (SpaceOutput)output;
  const PetscInt points = o->points * o->space->share.vesicles,
                 triangles = SpaceFramesTriangles(o) * o->space->share.vesicles;
  const XdmfSlab place = {"/vesicle/points", 8, t, points, 0, 3, 3},
                 velocity = {"/vesicle/velocity", 8, t, points, 0, 3, 3},
                 tension = {"/vesicle/tension", 8, t, points, 0, 1, 0};
  fprintf(f, "<Grid Name=\"frame %d\" GridType=\"Uniform\"><Time Value=\"%.17g\"/>\n", (int)t, (double)time);
  fprintf(f, "<Topology TopologyType=\"Triangle\" NumberOfElements=\"%d\">", (int)triangles);
  fprintf(f,
          "<DataItem Dimensions=\"%d 3\" NumberType=\"Int\" Precision=\"%d\" "
          "Format=\"HDF\">run.h5:/vesicle/triangles</DataItem></Topology>\n",
          (int)triangles, (int)sizeof(PetscInt));
  fprintf(f,
          "<Attribute Name=\"vesicle\" AttributeType=\"Scalar\" Center=\"Cell\"><DataItem Dimensions=\"%d\" "
          "NumberType=\"Int\" Precision=\"%d\" Format=\"HDF\">run.h5:/vesicle/number</DataItem></Attribute>\n",
          (int)triangles, (int)sizeof(PetscInt));
  fprintf(f, "<Geometry GeometryType=\"XYZ\">\n");
  XdmfPrintSlab(f, "", &place);
  fprintf(f, "</Geometry>\n<Attribute Name=\"tension\" AttributeType=\"Scalar\" Center=\"Node\">\n");
  XdmfPrintSlab(f, "", &tension);
  fprintf(f, "</Attribute>\n<Attribute Name=\"velocity\" AttributeType=\"Vector\" Center=\"Node\">\n");
  XdmfPrintSlab(f, "", &velocity);
  fprintf(f, "</Attribute></Grid>\n");
}
