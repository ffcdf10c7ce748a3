#define _GNU_SOURCE /* open_memstream */
#include "output/xdmf.h"
#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

/* The number of frames has a fixed width, so that it can be replaced where it stands. */
#define XDMF_HEAD "<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf [<!ENTITY frames \""
#define XDMF_COUNT_WIDTH 10
#define XDMF_CLOSING "</Grid>\n</Domain></Xdmf>\n"

/* A part of a dataset of run.h5: rows first .. first + n - 1 and columns column .. column + columns - 1 of an entry. */
typedef struct {
  const char *name;
  int bytes;                /* bytes of a number */
  PetscInt frame;           /* -1: the dataset is no series, but one entry */
  PetscInt first, n, all;   /* rows; all: of an entry */
  PetscInt column, columns; /* columns */
  PetscInt width;           /* columns of an entry; 0: an entry is a list */
} XdmfSlab;

/* Print a slab as an XDMF item with the dimensions before, n, columns. */
static void PrintSlab(FILE *f, const char before[], const XdmfSlab *s) {
  const PetscInt start[3] = {s->frame, s->first, s->column}, count[3] = {1, s->n, s->columns};
  const int from = s->frame < 0 ? 1 : 0, end = s->width ? 3 : 2;
  fprintf(f, "<DataItem ItemType=\"HyperSlab\" Dimensions=\"%s%d", before, (int)s->n);
  if (s->columns > 1) fprintf(f, " %d", (int)s->columns);
  fprintf(f, "\"><DataItem Dimensions=\"3 %d\" Format=\"XML\">", end - from);
  for (int row = 0; row < 3; row++) /* starts, strides, counts */
    for (int d = from; d < end; d++)
      fprintf(f, "%s%d", row || d > from ? " " : "", row == 1 ? 1 : (int)(row ? count : start)[d]);
  fprintf(f, "</DataItem><DataItem Dimensions=\"%s%d", from ? "" : "&frames; ", (int)s->all);
  if (s->width) fprintf(f, " %d", (int)s->width);
  fprintf(f, "\" NumberType=\"Float\" Precision=\"%d\" Format=\"HDF\">run.h5:%s</DataItem></DataItem>\n", s->bytes,
          s->name);
}

/* Values at cell centres are the nodes of a grid of one layer: readers put a two-dimensional grid into the y-z plane.
 */
static void PrintFluid(Grid g, FILE *f, PetscInt t, int bytes) {
  const int nx = (int)g->n[0], ny = (int)g->n[1];
  XdmfSlab cells = {.name = "/fluid/p", .bytes = bytes, .frame = t, .n = ny, .all = ny, .columns = nx, .width = nx};
  fprintf(
      f, "<Grid Name=\"fluid\" GridType=\"Uniform\"><Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"1 %d %d\"/>\n",
      ny, nx);
  fprintf(f, "<Geometry GeometryType=\"ORIGIN_DXDYDZ\"><DataItem Dimensions=\"3\">0 %.17g %.17g</DataItem>",
          (double)(g->lo[1] + g->h / 2), (double)(g->lo[0] + g->h / 2));
  fprintf(f, "<DataItem Dimensions=\"3\">%.17g %.17g %.17g</DataItem></Geometry>\n", (double)g->h, (double)g->h,
          (double)g->h);
  fprintf(f, "<Attribute Name=\"pressure\" AttributeType=\"Scalar\" Center=\"Node\">\n");
  PrintSlab(f, "1 ", &cells);
  fprintf(f, "</Attribute>\n<Attribute Name=\"velocity\" AttributeType=\"Vector\" Center=\"Node\">\n");
  fprintf(f, "<DataItem ItemType=\"Function\" Function=\"JOIN($0, $1, 0*$0)\" Dimensions=\"1 %d %d 3\">\n", ny, nx);
  cells.name = "/fluid/u";
  PrintSlab(f, "1 ", &cells);
  cells.name = "/fluid/v";
  PrintSlab(f, "1 ", &cells);
  fprintf(f, "</DataItem></Attribute></Grid>\n");
}

/* Print the two columns of a slab as items of their own. */
static void PrintColumns(FILE *f, XdmfSlab s) {
  s.columns = 1;
  for (s.column = 0; s.column < 2; s.column++) PrintSlab(f, "", &s);
}

/* Print the markers of one body, shifted. */
static void PrintMarkers(FILE *f, const XdmfSlab *markers, const PetscReal shift[2]) {
  if (!shift[0] && !shift[1]) {
    PrintSlab(f, "", markers);
    return;
  }
  fprintf(f, "<DataItem ItemType=\"Function\" Function=\"JOIN($0 + (%.17g), $1 + (%.17g))\" Dimensions=\"%d 2\">\n",
          (double)shift[0], (double)shift[1], (int)markers->n);
  PrintColumns(f, *markers);
  fprintf(f, "</DataItem>\n");
}

/* Whole periods that bring the middle of a body with these n markers into the box. */
static void ShiftIntoBox(Grid g, PetscInt n, const PetscReal X[], PetscReal shift[2]) {
  for (int d = 0; d < 2; d++) {
    const PetscReal period = g->hi[d] - g->lo[d];
    PetscReal middle = 0;
    for (PetscInt k = 0; k < n; k++) middle += X[2 * k + d] / n;
    shift[d] = g->wall[d] || g->free ? 0 : -period * PetscFloorReal((middle - g->lo[d]) / period);
  }
}

/* Print the line through a body's n points, closed or not, up to the beginning of its geometry. */
static void PrintLine(FILE *f, const char what[], PetscInt number, PetscInt n, PetscBool closed) {
  fprintf(f, "<Grid Name=\"%s %d\" GridType=\"Uniform\">", what, (int)number);
  fprintf(f,
          "<Topology TopologyType=\"Polyline\" NumberOfElements=\"1\" NodesPerElement=\"%d\"><DataItem "
          "Dimensions=\"1 %d\" NumberType=\"Int\">",
          (int)(n + closed), (int)(n + closed));
  for (PetscInt k = 0; k < n + (PetscInt)closed; k++) fprintf(f, "%d ", (int)(k % n));
  fprintf(f, "</DataItem></Topology>\n<Geometry GeometryType=\"XY\">\n");
}

/* Print the number of a body, and the end of its grid. */
static void PrintNumber(FILE *f, const char what[], PetscInt number) {
  fprintf(f, "<Attribute Name=\"%s\" AttributeType=\"Scalar\" Center=\"Cell\">", what);
  fprintf(f, "<DataItem Dimensions=\"1\" NumberType=\"Int\">%d</DataItem></Attribute></Grid>\n", (int)number);
}

static void PrintObstacle(Scheme s, FILE *f, PetscInt t, PetscReal time, PetscInt v) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const Layout l = o->layout;
  const PetscInt n = LayoutCount(l, v);
  const ObstaclePose pose = ObstaclesPose(o, v, time);
  const XdmfSlab force = {"/obstacle/force", 8, t, l->start[v], n, l->M, 0, 2, 2};
  XdmfSlab markers = force;
  PetscReal shift[2] = {0, 0};
  markers.name = "/obstacle/markers";
  if (!s->scene->obstacles.moving) markers.frame = -1;
  PrintLine(f, "obstacle", v + 1, n, o->kind[v].type == CURVE_CLOSED ? PETSC_TRUE : PETSC_FALSE);
  if (o->motion[v].carried) ShiftIntoBox(s->fluid->grid, 1, pose.center, shift);
  PrintMarkers(f, &markers, shift);
  fprintf(f, "</Geometry>\n<Attribute Name=\"force\" AttributeType=\"Vector\" Center=\"Node\">\n");
  fprintf(f, "<DataItem ItemType=\"Function\" Function=\"JOIN($0, $1, 0*$0)\" Dimensions=\"%d 3\">\n", (int)n);
  PrintColumns(f, force);
  fprintf(f, "</DataItem></Attribute>\n");
  PrintNumber(f, "obstacle", v + 1);
}

static void PrintVesicle(Scheme s, FILE *f, PetscInt t, PetscInt v, const PetscReal X[]) {
  const Layout l = s->membrane->layout;
  const PetscInt first = l->start[v], n = LayoutCount(l, v);
  const XdmfSlab markers = {"/vesicle/markers", 8, t, first, n, l->M, 0, 2, 2};
  const XdmfSlab tension = {"/vesicle/tension", 8, t, first, n, l->M, 0, 1, 0};
  PetscReal shift[2];
  ShiftIntoBox(s->fluid->grid, n, X + 2 * first, shift);
  PrintLine(f, "vesicle", v + 1, n, PETSC_TRUE);
  PrintMarkers(f, &markers, shift);
  fprintf(f, "</Geometry>\n<Attribute Name=\"tension\" AttributeType=\"Scalar\" Center=\"Node\">\n");
  PrintSlab(f, "", &tension);
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

/* What XdmfGoOn prints; last and end become the places where the last frame begins and ends. */
typedef struct {
  Scheme scheme;
  PetscInt frames;
  const PetscReal *times, *markers; /* [frames], [frames][2 M] */
  off_t *last, *end;
} XdmfDocument;

static PetscErrorCode PrintDocument(FILE *f, const void *what) {
  const XdmfDocument *d = what;
  fprintf(f, XDMF_HEAD "%*d\">]>\n<Xdmf Version=\"2.0\"><Domain>\n", XDMF_COUNT_WIDTH, (int)d->frames);
  fprintf(f, "<Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  for (PetscInt t = 0; t < d->frames; t++) {
    *d->last = ftello(f);
    PrintFrame(d->scheme, f, t, d->times[t], d->markers + 2 * t * d->scheme->membrane->layout->M);
  }
  *d->end = ftello(f);
  fprintf(f, XDMF_CLOSING);
  return PETSC_SUCCESS;
}

PetscErrorCode XdmfGoOn(Xdmf *x, PetscInt frames, const PetscReal times[], const PetscReal markers[]) {
  const XdmfDocument document = {x->scheme, frames, times, markers, &x->last, &x->end};
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  PetscCall(FolderWriteText(x->folder, "run.xmf", PrintDocument, &document));
  FolderPath(x->folder, "run.xmf", path);
  if (!x->folder->rank) x->file = open(path, O_WRONLY);
  PetscCall(FolderCheck(x->folder, x->file >= 0, "run.xmf"));
  FolderWatch(x->folder, "run.xmf");
  x->frames = frames;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write text at `place` and spaces up to the old end of the file, then cut the file behind the text: the document is
   whole before the cut too. When the disk is full the closing tags, for which there is room, are written back. */
static PetscBool XdmfOverwrite(int file, off_t place, const char text[], size_t length, off_t old_end) {
  const off_t old_size = old_end + (off_t)strlen(XDMF_CLOSING), new_size = place + (off_t)length;
  const size_t all = (size_t)(PetscMax(old_size, new_size) - place);
  char *padded = malloc(all + 1);
  PetscBool done;
  if (!padded) return PETSC_FALSE;
  (void)snprintf(padded, all + 1, "%-*s", (int)all, text);
  done = pwrite(file, padded, all, place) == (ssize_t)all ? PETSC_TRUE : PETSC_FALSE;
  free(padded);
  if (done) return new_size >= old_size || !ftruncate(file, new_size) ? PETSC_TRUE : PETSC_FALSE;
  if (pwrite(file, XDMF_CLOSING, strlen(XDMF_CLOSING), place) == (ssize_t)strlen(XDMF_CLOSING))
    (void)!ftruncate(file, place + (off_t)strlen(XDMF_CLOSING));
  return PETSC_FALSE;
}

/* Rank 0's part of XdmfWrite. The number of frames is written first: run.h5 has as many frames already. */
static PetscBool XdmfAppend(Xdmf *x, PetscInt frame, PetscReal time, const PetscReal X[]) {
  const off_t place = frame < x->frames ? x->last : x->end;
  char count[XDMF_COUNT_WIDTH + 8], *text = NULL;
  size_t size = 0;
  FILE *f = open_memstream(&text, &size);
  PetscBool done = PETSC_FALSE;
  if (!f) return PETSC_FALSE;
  PrintFrame(x->scheme, f, frame, time, X);
  fprintf(f, XDMF_CLOSING);
  if (!fclose(f)) {
    (void)snprintf(count, sizeof(count), "%*d", XDMF_COUNT_WIDTH, (int)frame + 1);
    done = pwrite(x->file, count, XDMF_COUNT_WIDTH, (off_t)strlen(XDMF_HEAD)) == XDMF_COUNT_WIDTH ? PETSC_TRUE
                                                                                                  : PETSC_FALSE;
    if (done) done = XdmfOverwrite(x->file, place, text, size, x->end);
    x->last = place;
    x->end = place + (off_t)(size - strlen(XDMF_CLOSING));
  }
  free(text);
  return done;
}

PetscErrorCode XdmfWrite(Xdmf *x, PetscInt frame, PetscReal time, const PetscReal markers[]) {
  PetscFunctionBeginUser;
  PetscCheck(frame == x->frames || frame == x->frames - 1, x->folder->comm, PETSC_ERR_PLIB,
             "frame %" PetscInt_FMT " of run.xmf after %" PetscInt_FMT, frame, x->frames);
  if (!x->frames) {
    PetscCall(XdmfGoOn(x, 1, &time, markers));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(FolderCheck(x->folder, x->folder->rank || XdmfAppend(x, frame, time, markers), "run.xmf"));
  x->frames = frame + 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool XdmfClose(Xdmf *x) {
  return !x->folder || x->file < 0 || !close(x->file) ? PETSC_TRUE : PETSC_FALSE;
}
