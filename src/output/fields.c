/* run.h5 and run.xmf: fields at cell centres and markers, per saved time. */
#include "output/output.h"

PetscErrorCode FieldsCreateFile(Output o, const char path[], H5File *f) {
  const Grid g = o->scheme->fluid->grid;
  const Membrane m = o->scheme->membrane;
  const Scene scene = o->scene;
  const PetscInt cells[2] = {g->n[1], g->n[0]}, markers[2] = {m->M, 2};
  PetscFunctionBeginUser;
  PetscCall(H5FileCreate(o->comm, path, f));
  PetscCall(H5PutReals(f, "box", 4, scene->fluid.box));
  PetscCall(H5PutInts(f, "cells", 2, g->n));
  PetscCall(H5PutReals(f, "h", 1, &g->h));
  PetscCall(H5PutReals(f, "nu", 1, &scene->fluid.nu));
  PetscCall(H5PutReals(f, "c_b", 1, &scene->membrane.bending));
  PetscCall(H5PutInts(f, "vesicle_start", m->vesicles + 1, m->start));
  PetscCall(H5PutString(f, "about",
                        "u, v: velocity (background included) at cell centres; p: pressure at cell centres, of the "
                        "disturbance unless -flow_form total; tension k on the edge from marker k-1 to marker k"));
  PetscCall(H5CreateSeries(f, "/time", 0, NULL));
  for (int k = 0; k < FrameSeriesCount(o); k++)
    PetscCall(H5CreateSeries(f, FrameSeries[k], k < 5 ? 2 : 1, k < 3 ? cells : markers));
  PetscCall(H5FileFlush(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode NewFields(Output o, const char path[]) {
  PetscFunctionBeginUser;
  PetscCall(FieldsCreateFile(o, path, &o->fields));
  PetscCall(H5FileCheck(&o->fields));
  o->fields_open = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* run.h5 of an earlier run, cut to the frames that the checkpoint counts. A frame that was saved only because that run
   ended goes: the run goes on. */
static PetscErrorCode OldFields(Output o, const char path[]) {
  H5File *f = &o->fields;
  PetscBool failed;
  PetscInt length;
  PetscFunctionBeginUser;
  PetscCall(FramesRepair(o, path));
  PetscCall(H5FileOpen(o->comm, path, PETSC_TRUE, f));
  PetscCall(H5FileFailed(f, &failed));
  o->fields_open = PETSC_TRUE;
  PetscCall(H5SeriesLength(f, "/time", &length));
  PetscCheck(!failed && length >= o->scheduled, o->comm, PETSC_ERR_USER_INPUT,
             "-restart %s: %s has %" PetscInt_FMT " readable frames, the checkpoint counts %" PetscInt_FMT
             "; allowed: run.h5 as the run left it, or a new -output_dir",
             o->scene->output.restart, path, length, o->scheduled);
  o->frames = o->scheduled;
  PetscCall(PetscMalloc1(o->frames, &o->times));
  for (PetscInt t = 0; t < o->frames; t++) PetscCall(H5ReadArray(f, "/time", t, 1, &o->times[t]));
  PetscCall(FramesOpen(o));                           /* before anything is changed */
  PetscCall(H5TruncateSeries(f, "/time", o->frames)); /* the readers' count of frames goes first */
  PetscCall(H5FileFlush(f));
  for (int k = 0; k < FrameSeriesCount(o); k++) PetscCall(H5TruncateSeries(f, FrameSeries[k], o->frames));
  PetscCall(H5FileFlush(f));
  PetscCall(H5FileFailed(f, &failed));
  if (failed) PetscCall(H5FileClose(f));
  PetscCheck(!failed, o->comm, PETSC_ERR_USER_INPUT,
             "-restart %s: %s cannot be cut to the %" PetscInt_FMT
             " readable frames that the checkpoint counts; allowed: run.h5 as the run left it, or a new -output_dir",
             o->scene->output.restart, path, o->scheduled);
  PetscCall(OutputXdmf(o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FieldsCreate(Output o) {
  char path[PETSC_MAX_PATH_LEN];
  const Grid g = o->scheme->fluid->grid;
  PetscFunctionBeginUser;
  PetscCall(OutputPath(o, "run.h5", path));
  PetscCall(o->go_on ? OldFields(o, path) : NewFields(o, path));
  if (!o->go_on) PetscCall(FramesOpen(o));
  PetscCall(PetscMalloc1(g->n[0] * g->rows[FIELD_P], &o->cells));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Value of a velocity component on a wall: the background's in the total form, else zero. */
static PetscScalar WallValue(Output o, int c, PetscInt i, PetscInt j, PetscReal wall) {
  PetscReal X[2], u[2];
  if (!o->scheme->fluid->total) return 0;
  GridPosition(o->scheme->fluid->grid, FIELD_P, i, j, X);
  X[c] = wall;
  FlowVelocity(&o->scene->flow, o->scheme->state.t, X[0], X[1], u);
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
    if (!o->scheme->fluid->total) PetscCall(FlowVelocities(&o->scene->flow, o->scheme->state.t, nx, X, u));
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

static PetscErrorCode WriteFrame(Output o) {
  const State *q = &o->scheme->state;
  const Grid g = o->scheme->fluid->grid;
  const PetscInt M = o->scheme->membrane->M;
  const Vec marker[3] = {q->X, q->U, q->sigma};
  H5File *f = &o->fields;
  const PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(q->w, &a));
  for (int c = 0; c < 2; c++) {
    PetscCall(OutputVelocityAtCells(o, c, a, o->cells));
    PetscCall(H5WriteField(f, FrameSeries[c], o->frames, g, FIELD_P, o->cells));
  }
  PetscCall(VecRestoreArrayRead(q->w, &a));
  PetscCall(VecGetArrayRead(q->p, &a));
  PetscCall(H5WriteField(f, FrameSeries[2], o->frames, g, FIELD_P, a));
  PetscCall(VecRestoreArrayRead(q->p, &a));
  for (int k = 0; k < 3 && M; k++) {
    PetscCall(VecGetArrayRead(marker[k], &a));
    PetscCall(H5WriteArray(f, FrameSeries[3 + k], o->frames, k < 2 ? 2 * M : M, a));
    PetscCall(VecRestoreArrayRead(marker[k], &a));
  }
  PetscCall(H5FileFlush(f));
  PetscCall(FramesAppend(o, o->frames, q->t));
  PetscCall(H5WriteArray(f, "/time", o->frames, 1, &q->t)); /* last: readers count the frames by it */
  PetscCall(H5FileFlush(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputFields(Output o, PetscBool scheduled) {
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_OUTPUT));
  PetscCall(WriteFrame(o));
  PetscCall(H5FileCheck(&o->fields));
  o->frames++;
  if (scheduled) o->scheduled = o->frames;
  PetscCall(PetscRealloc((size_t)o->frames * sizeof(PetscReal), &o->times));
  o->times[o->frames - 1] = o->scheme->state.t;
  if (o->series) fflush(o->series);
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

static PetscErrorCode WriteXdmf(Output o, FILE *f) {
  PetscFunctionBeginUser;
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
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputXdmf(Output o) {
  PetscFunctionBeginUser;
  PetscCall(OutputWriteText(o, "run.xmf", WriteXdmf));
  PetscFunctionReturn(PETSC_SUCCESS);
}
