#define _GNU_SOURCE /* open_memstream */
#include "output/xdmf.h"
#include "output/lock.h"
#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

/* The number of frames takes a fixed width, so that it can be changed in its place. */
#define HEAD "<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf [<!ENTITY frames \""
#define COUNT_WIDTH 10
#define CLOSING "</Grid>\n</Domain></Xdmf>\n"

/* Rows first .. first + n - 1 of entry t of a series [frames,all,m], of so many bytes a number, as an XDMF item of
 * dimensions before,n,m. */
static void HyperSlab(FILE *f, PetscInt t, const char name[], PetscInt first, PetscInt n, PetscInt all, PetscInt m,
                      int bytes, const char before[]) {
  fprintf(f, "<DataItem ItemType=\"HyperSlab\" Dimensions=\"%s%d %d\"><DataItem Dimensions=\"3 3\" Format=\"XML\">",
          before, (int)n, (int)m);
  fprintf(f, "%d %d 0 1 1 1 1 %d %d</DataItem>", (int)t, (int)first, (int)n, (int)m);
  fprintf(f,
          "<DataItem Dimensions=\"&frames; %d %d\" NumberType=\"Float\" Precision=\"%d\" "
          "Format=\"HDF\">run.h5:%s</DataItem></DataItem>\n",
          (int)all, (int)m, bytes, name);
}

/* Values at cell centres are the nodes of a grid of one layer: readers put a two-dimensional grid into the
   y-z plane. */
static void PrintFluid(Grid g, FILE *f, PetscInt t, int bytes) {
  const int nx = (int)g->n[0], ny = (int)g->n[1];
  fprintf(
      f, "<Grid Name=\"fluid\" GridType=\"Uniform\"><Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"1 %d %d\"/>\n",
      ny, nx);
  fprintf(f, "<Geometry GeometryType=\"ORIGIN_DXDYDZ\"><DataItem Dimensions=\"3\">0 %.17g %.17g</DataItem>",
          (double)(g->lo[1] + g->h / 2), (double)(g->lo[0] + g->h / 2));
  fprintf(f, "<DataItem Dimensions=\"3\">%.17g %.17g %.17g</DataItem></Geometry>\n", (double)g->h, (double)g->h,
          (double)g->h);
  fprintf(f, "<Attribute Name=\"pressure\" AttributeType=\"Scalar\" Center=\"Node\">\n");
  HyperSlab(f, t, "/fluid/p", 0, ny, ny, nx, bytes, "1 ");
  fprintf(f, "</Attribute>\n<Attribute Name=\"velocity\" AttributeType=\"Vector\" Center=\"Node\">\n");
  fprintf(f, "<DataItem ItemType=\"Function\" Function=\"JOIN($0, $1, 0*$0)\" Dimensions=\"1 %d %d 3\">\n", ny, nx);
  HyperSlab(f, t, "/fluid/u", 0, ny, ny, nx, bytes, "1 ");
  HyperSlab(f, t, "/fluid/v", 0, ny, ny, nx, bytes, "1 ");
  fprintf(f, "</DataItem></Attribute></Grid>\n");
}

/* Component c of a series [frames,all,2] at n markers. */
static void PrintComponent(FILE *f, PetscInt t, const char name[], PetscInt first, PetscInt n, PetscInt all, int c) {
  fprintf(f,
          "<DataItem ItemType=\"HyperSlab\" Dimensions=\"%d\"><DataItem Dimensions=\"3 3\" Format=\"XML\">%d %d %d 1 1 "
          "1 1 %d 1</DataItem>",
          (int)n, (int)t, (int)first, c, (int)n);
  fprintf(f,
          "<DataItem Dimensions=\"&frames; %d 2\" NumberType=\"Float\" Precision=\"8\" "
          "Format=\"HDF\">run.h5:%s</DataItem></DataItem>\n",
          (int)all, name);
}

/* One body's markers of a series, shifted. */
static void PrintPlaces(FILE *f, PetscInt t, const char name[], PetscInt first, PetscInt n, PetscInt M,
                        const PetscReal shift[2]) {
  if (!shift[0] && !shift[1]) {
    HyperSlab(f, t, name, first, n, M, 2, 8, "");
    return;
  }
  fprintf(f, "<DataItem ItemType=\"Function\" Function=\"JOIN($0 + (%.17g), $1 + (%.17g))\" Dimensions=\"%d 2\">\n",
          (double)shift[0], (double)shift[1], (int)n);
  for (int c = 0; c < 2; c++) PrintComponent(f, t, name, first, n, M, c);
  fprintf(f, "</DataItem>\n");
}

/* Whole periods that bring the middle of a body with these n markers into the box. */
static void Wrap(Grid g, PetscInt n, const PetscReal X[], PetscReal shift[2]) {
  for (int d = 0; d < 2; d++) {
    const PetscReal period = g->hi[d] - g->lo[d];
    PetscReal middle = 0;
    for (PetscInt k = 0; k < n; k++) middle += X[2 * k + d] / n;
    shift[d] = g->wall[d] || g->free ? 0 : -period * PetscFloorReal((middle - g->lo[d]) / period);
  }
}

/* A line through n points, closed or not; its geometry follows. */
static void PrintLine(FILE *f, const char what[], PetscInt number, PetscInt n, PetscBool closed) {
  fprintf(f, "<Grid Name=\"%s %d\" GridType=\"Uniform\">", what, (int)number);
  fprintf(f,
          "<Topology TopologyType=\"Polyline\" NumberOfElements=\"1\" NodesPerElement=\"%d\"><DataItem "
          "Dimensions=\"1 %d\" NumberType=\"Int\">",
          (int)(n + closed), (int)(n + closed));
  for (PetscInt k = 0; k < n + (PetscInt)closed; k++) fprintf(f, "%d ", (int)(k % n));
  fprintf(f, "</DataItem></Topology>\n<Geometry GeometryType=\"XY\">\n");
}

/* The number of a body, and the end of its grid. */
static void PrintNumber(FILE *f, const char what[], PetscInt number) {
  fprintf(f, "<Attribute Name=\"%s\" AttributeType=\"Scalar\" Center=\"Cell\">", what);
  fprintf(f, "<DataItem Dimensions=\"1\" NumberType=\"Int\">%d</DataItem></Attribute></Grid>\n", (int)number);
}

/* The markers of an obstacle that rests, which are no series. */
static void PrintResting(FILE *f, PetscInt first, PetscInt n, PetscInt M) {
  fprintf(f,
          "<DataItem ItemType=\"HyperSlab\" Dimensions=\"%d 2\"><DataItem Dimensions=\"3 2\" Format=\"XML\">%d 0 1 1 "
          "%d 2</DataItem>",
          (int)n, (int)first, (int)n);
  fprintf(f,
          "<DataItem Dimensions=\"%d 2\" NumberType=\"Float\" Precision=\"8\" "
          "Format=\"HDF\">run.h5:/obstacle/markers</DataItem></DataItem>\n",
          (int)M);
}

static void PrintObstacle(Scheme s, FILE *f, PetscInt t, PetscReal time, PetscInt v) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const Layout l = o->layout;
  const PetscInt n = LayoutCount(l, v);
  const ObstaclePose pose = ObstaclesPose(o, v, time);
  PetscReal shift[2] = {0, 0};
  PrintLine(f, "obstacle", v + 1, n, o->kind[v].type == CURVE_CLOSED ? PETSC_TRUE : PETSC_FALSE);
  if (o->motion[v].carried) Wrap(s->fluid->grid, 1, pose.center, shift);
  if (s->scene->obstacles.moving)
    PrintPlaces(f, t, "/obstacle/markers", l->start[v], n, l->M, shift);
  else
    PrintResting(f, l->start[v], n, l->M);
  fprintf(f, "</Geometry>\n<Attribute Name=\"force\" AttributeType=\"Vector\" Center=\"Node\">\n");
  fprintf(f, "<DataItem ItemType=\"Function\" Function=\"JOIN($0, $1, 0*$0)\" Dimensions=\"%d 3\">\n", (int)n);
  for (int c = 0; c < 2; c++) PrintComponent(f, t, "/obstacle/force", l->start[v], n, l->M, c);
  fprintf(f, "</DataItem></Attribute>\n");
  PrintNumber(f, "obstacle", v + 1);
}

static void PrintVesicle(Scheme s, FILE *f, PetscInt t, PetscInt v, const PetscReal X[]) {
  const Membrane m = s->membrane;
  const PetscInt first = m->layout->start[v], n = LayoutCount(m->layout, v);
  PetscReal shift[2];
  Wrap(s->fluid->grid, n, X + 2 * first, shift);
  PrintLine(f, "vesicle", v + 1, n, PETSC_TRUE);
  PrintPlaces(f, t, "/vesicle/markers", first, n, m->layout->M, shift);
  fprintf(f, "</Geometry>\n<Attribute Name=\"tension\" AttributeType=\"Scalar\" Center=\"Node\">\n");
  fprintf(f,
          "<DataItem ItemType=\"HyperSlab\" Dimensions=\"%d\"><DataItem Dimensions=\"3 2\" Format=\"XML\">%d %d 1 1 1 "
          "%d</DataItem>",
          (int)n, (int)t, (int)first, (int)n);
  fprintf(f,
          "<DataItem Dimensions=\"&frames; %d\" NumberType=\"Float\" Precision=\"8\" "
          "Format=\"HDF\">run.h5:/vesicle/tension</DataItem></DataItem>\n",
          (int)m->layout->M);
  fprintf(f, "</Attribute>\n");
  PrintNumber(f, "vesicle", v + 1);
}

static void PrintFrame(Scheme s, FILE *f, PetscInt t, PetscReal time, const PetscReal X[]) {
  const Obstacles solids = s->coupling->bodies->obstacles;
  fprintf(f, "<Grid Name=\"frame %d\" GridType=\"Collection\" CollectionType=\"Spatial\"><Time Value=\"%.17g\"/>\n",
          (int)t, (double)time);
  PrintFluid(s->fluid->grid, f, t, s->scene->output.precision == PRECISION_SINGLE ? 4 : 8);
  for (PetscInt v = 0; v < s->membrane->layout->bodies; v++) PrintVesicle(s, f, t, v, X);
  for (PetscInt v = 0; solids && v < solids->layout->bodies; v++) PrintObstacle(s, f, t, time, v);
  fprintf(f, "</Grid>\n");
}

/* What XdmfGoOn prints, and where in it the last frame begins and ends. */
typedef struct {
  Scheme scheme;
  PetscInt frames;
  const PetscReal *times, *markers; /* [frames], [frames][2 M] */
  off_t *last, *end;
} Document;

static PetscErrorCode PrintDocument(FILE *f, const void *what) {
  const Document *d = what;
  fprintf(f, HEAD "%*d\">]>\n<Xdmf Version=\"2.0\"><Domain>\n", COUNT_WIDTH, (int)d->frames);
  fprintf(f, "<Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  for (PetscInt t = 0; t < d->frames; t++) {
    *d->last = ftello(f);
    PrintFrame(d->scheme, f, t, d->times[t], d->markers + 2 * t * d->scheme->membrane->layout->M);
  }
  *d->end = ftello(f);
  fprintf(f, CLOSING);
  return PETSC_SUCCESS;
}

PetscErrorCode XdmfCreate(Xdmf *x, Folder *folder, Scheme scheme) {
  PetscFunctionBeginUser;
  x->folder = folder;
  x->scheme = scheme;
  x->file = -1;
  x->frames = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode XdmfGoOn(Xdmf *x, PetscInt frames, const PetscReal times[], const PetscReal markers[]) {
  const Document document = {x->scheme, frames, times, markers, &x->last, &x->end};
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  PetscCall(FolderWriteText(x->folder, "run.xmf", PrintDocument, &document));
  PetscCall(FolderPath(x->folder, "run.xmf", path));
  if (!x->folder->rank) x->file = open(path, O_WRONLY);
  PetscCall(FolderCheck(x->folder, x->file >= 0, path));
  FolderWatch(x->folder, "run.xmf");
  x->frames = frames;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write text over what is at `place`, with spaces up to the old end of the file, which is then cut: the document is
   whole in between too. When the disk is full the closing tags, for which there is room, go back. */
static PetscBool Overwrite(int file, off_t place, const char text[], size_t length, off_t old_end) {
  const off_t old_size = old_end + (off_t)strlen(CLOSING), new_size = place + (off_t)length;
  const size_t all = (size_t)(PetscMax(old_size, new_size) - place);
  char *padded = malloc(all + 1);
  PetscBool done;
  if (!padded) return PETSC_FALSE;
  (void)snprintf(padded, all + 1, "%-*s", (int)all, text);
  done = pwrite(file, padded, all, place) == (ssize_t)all ? PETSC_TRUE : PETSC_FALSE;
  free(padded);
  if (done) return new_size >= old_size || !ftruncate(file, new_size) ? PETSC_TRUE : PETSC_FALSE;
  if (pwrite(file, CLOSING, strlen(CLOSING), place) == (ssize_t)strlen(CLOSING))
    (void)!ftruncate(file, place + (off_t)strlen(CLOSING));
  return PETSC_FALSE;
}

/* Rank 0's part of XdmfWrite. The number of frames goes first: run.h5 has them already. */
static PetscBool Append(Xdmf *x, PetscInt frame, PetscReal time, const PetscReal X[]) {
  const off_t place = frame < x->frames ? x->last : x->end;
  char count[COUNT_WIDTH + 8], *text = NULL;
  size_t size = 0;
  FILE *f = open_memstream(&text, &size);
  PetscBool done = PETSC_FALSE;
  if (!f) return PETSC_FALSE;
  PrintFrame(x->scheme, f, frame, time, X);
  fprintf(f, CLOSING);
  if (!fclose(f)) {
    (void)snprintf(count, sizeof(count), "%*d", COUNT_WIDTH, (int)frame + 1);
    done = pwrite(x->file, count, COUNT_WIDTH, (off_t)strlen(HEAD)) == COUNT_WIDTH ? PETSC_TRUE : PETSC_FALSE;
    if (done) done = Overwrite(x->file, place, text, size, x->end);
    x->last = place;
    x->end = place + (off_t)(size - strlen(CLOSING));
  }
  free(text);
  return done;
}

PetscErrorCode XdmfWrite(Xdmf *x, PetscInt frame, PetscReal time, const PetscReal markers[]) {
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  PetscCheck(frame == x->frames || frame == x->frames - 1, x->folder->comm, PETSC_ERR_PLIB,
             "frame %" PetscInt_FMT " of run.xmf after %" PetscInt_FMT, frame, x->frames);
  if (!x->frames) {
    PetscCall(XdmfGoOn(x, 1, &time, markers));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(FolderPath(x->folder, "run.xmf", path));
  PetscCall(FolderCheck(x->folder, x->folder->rank || Append(x, frame, time, markers), path));
  x->frames = frame + 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode XdmfClose(Xdmf *x, PetscBool *good) {
  const int file = x->file;
  PetscFunctionBeginUser;
  *good = !x->folder || file < 0 || !close(file) ? PETSC_TRUE : PETSC_FALSE;
  x->file = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}
