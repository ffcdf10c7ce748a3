/* run.h5 and run.xmf: fields at cell centres and markers, per saved time. */
#include "output/output.h"

static const char *const fluid_names[3] = {"/fluid/u", "/fluid/v", "/fluid/p"};

PetscErrorCode FieldsCreate(Output o) {
  char path[PETSC_MAX_PATH_LEN];
  const Grid g = o->scheme->fluid->grid;
  const Scene scene = o->scene;
  const PetscInt cells[2] = {g->n[1], g->n[0]}, markers[2] = {o->scheme->membrane->M, 2};
  PetscFunctionBeginUser;
  PetscCall(OutputPath(o, "run.h5", path));
  PetscCall(H5Create(o->comm, path, &o->fields));
  PetscCall(H5PutReals(o->fields, "box", 4, scene->box.v));
  PetscCall(H5PutInts(o->fields, "cells", 2, g->n));
  PetscCall(H5PutReals(o->fields, "h", 1, &g->h));
  PetscCall(H5PutReals(o->fields, "nu", 1, &scene->viscosity));
  PetscCall(H5PutReals(o->fields, "c_b", 1, &scene->bending));
  PetscCall(H5PutInts(o->fields, "vesicle_start", o->scheme->membrane->vesicles + 1, o->scheme->membrane->start));
  PetscCall(H5PutString(o->fields, "about",
                        "u, v: velocity (background included) at cell centres; p: pressure at cell centres, of the "
                        "disturbance unless -flow_form total; tension k on the edge from marker k-1 to marker k"));
  PetscCall(H5CreateSeries(o->fields, "/time", 0, NULL, 0));
  for (int f = 0; f < 3; f++) PetscCall(H5CreateSeries(o->fields, fluid_names[f], 2, cells, g->block));
  if (markers[0]) {
    PetscCall(H5CreateSeries(o->fields, "/vesicle/markers", 2, markers, 0));
    PetscCall(H5CreateSeries(o->fields, "/vesicle/velocity", 2, markers, 0));
    PetscCall(H5CreateSeries(o->fields, "/vesicle/tension", 1, markers, 0));
  }
  PetscCall(PetscMalloc1(g->n[0] * g->rows[FIELD_P], &o->cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Value of a velocity component on a wall: the background's in the total form, else zero. */
static PetscScalar WallValue(Output o, int c, PetscInt i, PetscInt j, PetscReal wall) {
  PetscReal X[2], u[2];
  if (!o->scheme->fluid->total) return 0;
  GridPosition(o->scheme->fluid->grid, FIELD_P, i, j, X);
  X[c] = wall;
  FlowVelocity(&o->scene->flow, X[0], X[1], u);
  return u[c];
}

PetscErrorCode OutputVelocityAtCells(Output o, int c, const PetscScalar w[], PetscScalar cells[]) {
  const Grid g = o->scheme->fluid->grid;
  const PetscInt columns = g->columns[c], nx = g->n[0];
  const PetscScalar *a = w + (c ? GridLocalU(g) : 0);
  Rows rows;
  PetscReal *X, *u;
  PetscFunctionBeginUser;
  PetscCall(GridRows(g, (Field)c, a, &rows));
  PetscCall(PetscCalloc2(2 * nx, &X, 2 * nx, &u));
  for (PetscInt j = 0; j < g->rows[FIELD_P]; j++) {
    for (PetscInt i = 0; i < nx; i++) GridPosition(g, FIELD_P, i, j + g->first, X + 2 * i);
    if (!o->scheme->fluid->total) PetscCall(FlowVelocities(&o->scene->flow, nx, X, u));
    for (PetscInt i = 0; i < nx; i++) {
      const PetscInt index[2] = {i, j + g->first};
      PetscScalar face[2];
      for (int side = 0; side < 2; side++) {
        const PetscInt k = index[c] - 1 + side, n = g->n[c];
        if (g->wall[c] && (k < 0 || k == n - 1))
          face[side] = WallValue(o, c, i, index[1], side ? g->hi[c] : g->lo[c]);
        else if (c == 0)
          face[side] = RowAt(&rows, j)[(k + columns) % columns];
        else
          face[side] = RowAt(&rows, j - 1 + side)[i];
      }
      cells[j * nx + i] = 0.5 * (face[0] + face[1]) + u[2 * i + c];
    }
  }
  PetscCall(PetscFree2(X, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteMarkers(Output o, const char name[], Vec x) {
  const PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(x, &a));
  PetscCall(H5AppendArray(o->comm, o->fields, name, o->frames, a));
  PetscCall(VecRestoreArrayRead(x, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputFields(Output o) {
  const State *q = &o->scheme->state;
  const Grid g = o->scheme->fluid->grid;
  const PetscScalar *a;
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  PetscCall(OutputPath(o, "run.h5", path));
  PetscCall(H5AppendArray(o->comm, o->fields, "/time", o->frames, &q->t));
  o->scene->flow.time = q->t;
  PetscCall(VecGetArrayRead(q->w, &a));
  for (int c = 0; c < 2; c++) {
    PetscCall(OutputVelocityAtCells(o, c, a, o->cells));
    PetscCall(H5AppendRows(o->fields, fluid_names[c], o->frames, g->first, g->rows[FIELD_P], o->cells));
  }
  PetscCall(VecRestoreArrayRead(q->w, &a));
  PetscCall(VecGetArrayRead(q->p, &a));
  PetscCall(H5AppendRows(o->fields, fluid_names[2], o->frames, g->first, g->rows[FIELD_P], a));
  PetscCall(VecRestoreArrayRead(q->p, &a));
  if (o->scheme->membrane->M) {
    PetscCall(WriteMarkers(o, "/vesicle/markers", q->X));
    PetscCall(WriteMarkers(o, "/vesicle/velocity", q->U));
    PetscCall(WriteMarkers(o, "/vesicle/tension", q->sigma));
  }
  H5Check(H5Fflush(o->fields, H5F_SCOPE_GLOBAL), o->comm, path);
  o->frames++;
  if (!o->rank) {
    PetscCall(PetscRealloc((size_t)o->frames * sizeof(PetscReal), &o->times));
    o->times[o->frames - 1] = q->t;
    if (o->series) fflush(o->series);
  }
  PetscCall(OutputXdmf(o));
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows first .. first + n - 1 of entry t of a series [frames,all,m] as an XDMF item of dimensions before,n,m. */
static void HyperSlab(FILE *f, PetscInt t, PetscInt frames, const char name[], PetscInt first, PetscInt n, PetscInt all,
                      PetscInt m, const char before[]) {
  fprintf(f, "<DataItem ItemType=\"HyperSlab\" Dimensions=\"%s%d %d\"><DataItem Dimensions=\"3 3\" Format=\"XML\">",
          before, (int)n, (int)m);
  fprintf(f, "%d %d 0 1 1 1 1 %d %d</DataItem>", (int)t, (int)first, (int)n, (int)m);
  fprintf(f,
          "<DataItem Dimensions=\"%d %d %d\" NumberType=\"Float\" Precision=\"8\" "
          "Format=\"HDF\">run.h5:%s</DataItem></DataItem>\n",
          (int)frames, (int)all, (int)m, name);
}

/* Values at cell centres are the nodes of a grid of one layer: readers put a two-dimensional grid into the y-z plane.
 */
static void XdmfFluid(Output o, FILE *f, PetscInt t) {
  const Grid g = o->scheme->fluid->grid;
  const int nx = (int)g->n[0], ny = (int)g->n[1];
  fprintf(
      f, "<Grid Name=\"fluid\" GridType=\"Uniform\"><Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"1 %d %d\"/>\n",
      ny, nx);
  fprintf(f, "<Geometry GeometryType=\"ORIGIN_DXDYDZ\"><DataItem Dimensions=\"3\">0 %.17g %.17g</DataItem>",
          (double)(g->lo[1] + g->h / 2), (double)(g->lo[0] + g->h / 2));
  fprintf(f, "<DataItem Dimensions=\"3\">%.17g %.17g %.17g</DataItem></Geometry>\n", (double)g->h, (double)g->h,
          (double)g->h);
  fprintf(f, "<Attribute Name=\"pressure\" AttributeType=\"Scalar\" Center=\"Node\">\n");
  HyperSlab(f, t, o->frames, "/fluid/p", 0, ny, ny, nx, "1 ");
  fprintf(f, "</Attribute>\n<Attribute Name=\"velocity\" AttributeType=\"Vector\" Center=\"Node\">\n");
  fprintf(f, "<DataItem ItemType=\"Function\" Function=\"JOIN($0, $1, 0*$0)\" Dimensions=\"1 %d %d 3\">\n", ny, nx);
  HyperSlab(f, t, o->frames, "/fluid/u", 0, ny, ny, nx, "1 ");
  HyperSlab(f, t, o->frames, "/fluid/v", 0, ny, ny, nx, "1 ");
  fprintf(f, "</DataItem></Attribute></Grid>\n");
}

static void XdmfVesicle(Output o, FILE *f, PetscInt t, PetscInt v) {
  const Membrane m = o->scheme->membrane;
  const PetscInt first = m->start[v], n = m->start[v + 1] - first;
  fprintf(f, "<Grid Name=\"vesicle %d\" GridType=\"Uniform\">", (int)v + 1);
  fprintf(f,
          "<Topology TopologyType=\"Polyline\" NumberOfElements=\"1\" NodesPerElement=\"%d\"><DataItem "
          "Dimensions=\"1 %d\" NumberType=\"Int\">",
          (int)n + 1, (int)n + 1);
  for (PetscInt k = 0; k <= n; k++) fprintf(f, "%d ", (int)(k % n));
  fprintf(f, "</DataItem></Topology>\n<Geometry GeometryType=\"XY\">\n");
  HyperSlab(f, t, o->frames, "/vesicle/markers", first, n, m->M, 2, "");
  fprintf(f, "</Geometry>\n<Attribute Name=\"tension\" AttributeType=\"Scalar\" Center=\"Node\">\n");
  fprintf(f,
          "<DataItem ItemType=\"HyperSlab\" Dimensions=\"%d\"><DataItem Dimensions=\"3 2\" Format=\"XML\">%d %d 1 1 1 "
          "%d</DataItem>",
          (int)n, (int)t, (int)first, (int)n);
  fprintf(f,
          "<DataItem Dimensions=\"%d %d\" NumberType=\"Float\" Precision=\"8\" "
          "Format=\"HDF\">run.h5:/vesicle/tension</DataItem></DataItem>\n",
          (int)o->frames, (int)m->M);
  fprintf(f, "</Attribute></Grid>\n");
}

static void WriteXdmf(Output o, FILE *f) {
  fprintf(f, "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\"><Domain>\n<Grid Name=\"run\" GridType=\"Collection\" "
             "CollectionType=\"Temporal\">\n");
  for (PetscInt t = 0; t < o->frames; t++) {
    fprintf(f, "<Grid Name=\"frame %d\" GridType=\"Collection\" CollectionType=\"Spatial\"><Time Value=\"%.17g\"/>\n",
            (int)t, (double)o->times[t]);
    XdmfFluid(o, f, t);
    for (PetscInt v = 0; v < o->scheme->membrane->vesicles; v++) XdmfVesicle(o, f, t, v);
    fprintf(f, "</Grid>\n");
  }
  fprintf(f, "</Grid>\n</Domain></Xdmf>\n");
}

PetscErrorCode OutputXdmf(Output o) {
  char path[PETSC_MAX_PATH_LEN];
  FILE *f = NULL;
  PetscFunctionBeginUser;
  PetscCall(OutputPath(o, "run.xmf", path));
  if (!o->rank) f = fopen(path, "w");
  if (f) WriteXdmf(o, f);
  PetscCall(OutputCheckFile(o, f, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}
