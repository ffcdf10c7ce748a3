#define _GNU_SOURCE /* open_memstream */
#include "output/xdmf.h"
#include "output/frames.h"
#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

/* The number of frames has a fixed width, so that it can be replaced where it stands. */
#define XDMF_HEAD "<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf [<!ENTITY frames \""
#define XDMF_COUNT_WIDTH 10
#define XDMF_OPENING                                                                                                   \
  XDMF_HEAD "         0\">]>\n<Xdmf Version=\"2.0\"><Domain>\n"                                                        \
            "<Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n"
#define XDMF_CLOSING "</Grid>\n</Domain></Xdmf>\n"

/* The entry of one frame in a series of run.h5: n rows of `columns` columns from `column` on. */
typedef struct {
  const char *name;
  int bytes; /* bytes of a number */
  PetscInt frame, n, column, columns;
  PetscInt width; /* columns of an entry; 0: an entry is a list */
} XdmfSlab;

/* Print a slab as an XDMF item with the dimensions before, n, columns. VTK keeps the points of a grid under the name of
   the comment, which is different for each slab. */
static void PrintSlab(FILE *f, const char before[], const XdmfSlab *s) {
  const PetscInt start[3] = {s->frame, 0, s->column}, count[3] = {1, s->n, s->columns};
  const int end = s->width ? 3 : 2;
  fprintf(f, "<DataItem ItemType=\"HyperSlab\" Dimensions=\"%s%d", before, (int)s->n);
  if (s->columns > 1) fprintf(f, " %d", (int)s->columns);
  fprintf(f, "\"><!-- %s %d --><DataItem Dimensions=\"3 %d\" Format=\"XML\">", s->name, (int)s->frame, end);
  for (int row = 0; row < 3; row++) /* starts, strides, counts */
    for (int d = 0; d < end; d++) fprintf(f, "%s%d", row || d ? " " : "", row == 1 ? 1 : (int)(row ? count : start)[d]);
  fprintf(f, "</DataItem><DataItem Dimensions=\"&frames; %d", (int)s->n);
  if (s->width) fprintf(f, " %d", (int)s->width);
  fprintf(f, "\" NumberType=\"Float\" Precision=\"%d\" Format=\"HDF\">run.h5:%s</DataItem></DataItem>\n", s->bytes,
          s->name);
}

/* Print two slabs as the x and y of a vector field with the dimensions dims. */
static void PrintVector(FILE *f, const char name[], const char dims[], const char before[], const XdmfSlab part[2]) {
  fprintf(f, "<Attribute Name=\"%s\" AttributeType=\"Vector\" Center=\"Node\">\n", name);
  fprintf(f, "<DataItem ItemType=\"Function\" Function=\"JOIN($0, $1, 0*$0)\" Dimensions=\"%s 3\">\n", dims);
  for (int c = 0; c < 2; c++) PrintSlab(f, before, &part[c]);
  fprintf(f, "</DataItem></Attribute>\n");
}

/* Values at cell centres are the nodes of a grid of one layer: readers put a two-dimensional grid into the y-z plane.
 */
static void PrintFluid(Grid g, FILE *f, PetscInt t, int bytes) {
  const PetscInt nx = g->n[0], ny = g->n[1];
  const XdmfSlab p = {"/fluid/p", bytes, t, ny, 0, nx, nx}, u = {"/fluid/u", bytes, t, ny, 0, nx, nx},
                 v = {"/fluid/v", bytes, t, ny, 0, nx, nx};
  char dims[64];
  (void)snprintf(dims, sizeof(dims), "1 %d %d", (int)ny, (int)nx);
  fprintf(f, "<Grid Name=\"fluid\" GridType=\"Uniform\"><Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"%s\"/>\n",
          dims);
  fprintf(f, "<Geometry GeometryType=\"ORIGIN_DXDYDZ\"><DataItem Dimensions=\"3\">0 %.17g %.17g</DataItem>",
          (double)(g->lo[1] + g->h / 2), (double)(g->lo[0] + g->h / 2));
  fprintf(f, "<DataItem Dimensions=\"3\">%.17g %.17g %.17g</DataItem></Geometry>\n", (double)g->h, (double)g->h,
          (double)g->h);
  fprintf(f, "<Attribute Name=\"pressure\" AttributeType=\"Scalar\" Center=\"Node\">\n");
  PrintSlab(f, "1 ", &p);
  fprintf(f, "</Attribute>\n");
  PrintVector(f, "velocity", dims, "1 ", (XdmfSlab[]){u, v});
  fprintf(f, "</Grid>\n");
}

/* Print a list of whole numbers of run.h5. */
static void PrintWhole(FILE *f, PetscInt n, const char kind[], const char name[]) {
  fprintf(f, "<DataItem Dimensions=\"%d\" NumberType=\"Int\" Precision=\"%d\" Format=\"HDF\">run.h5:/%s/%s</DataItem>",
          (int)n, (int)sizeof(PetscInt), kind, name);
}

/* Print the lines through the markers of all bodies of a kind, up to the beginning of their geometry. */
static void PrintLines(FILE *f, const char kind[], Layout l, PetscInt closed) {
  fprintf(f, "<Grid Name=\"%s\" GridType=\"Uniform\"><Topology TopologyType=\"Mixed\" NumberOfElements=\"%d\">", kind,
          (int)l->bodies);
  PrintWhole(f, l->M + 2 * l->bodies + closed, kind, "lines");
  fprintf(f, "</Topology>\n<Attribute Name=\"%s\" AttributeType=\"Scalar\" Center=\"Cell\">", kind);
  PrintWhole(f, l->bodies, kind, "number");
  fprintf(f, "</Attribute>\n<Geometry GeometryType=\"XY\">\n");
}

static void PrintVesicles(FILE *f, PetscInt t, Membrane m, PetscBool wrapped) {
  const Layout l = m->layout;
  const XdmfSlab markers = {wrapped ? "/vesicle/wrapped" : "/vesicle/markers", 8, t, l->M, 0, 2, 2};
  const XdmfSlab edges[] = {{"/vesicle/tension", 8, t, l->M, 0, 1, 0}, {"/vesicle/stretch", 8, t, l->M, 0, 1, 0}};
  PrintLines(f, "vesicle", l, l->bodies);
  PrintSlab(f, "", &markers);
  fprintf(f, "</Geometry>\n");
  for (int k = 0; k < (m->stretches ? 2 : 1); k++) {
    fprintf(f, "<Attribute Name=\"%s\" AttributeType=\"Scalar\" Center=\"Node\">\n", k ? "stretch" : "tension");
    PrintSlab(f, "", &edges[k]);
    fprintf(f, "</Attribute>");
  }
  fprintf(f, "</Grid>\n");
}

/* Obstacles that rest have one entry of markers, no series. */
static void PrintObstacles(FILE *f, PetscInt t, Obstacles o, PetscBool moving, PetscBool wrapped) {
  const PetscInt W = o->layout->M;
  const XdmfSlab markers = {wrapped ? "/obstacle/wrapped" : "/obstacle/markers", 8, t, W, 0, 2, 2};
  const XdmfSlab x = {"/obstacle/force", 8, t, W, 0, 1, 2}, y = {"/obstacle/force", 8, t, W, 1, 1, 2};
  PetscInt closed = 0;
  char dims[32];
  for (PetscInt v = 0; v < o->layout->bodies; v++) closed += o->kind[v].type == CURVE_CLOSED;
  (void)snprintf(dims, sizeof(dims), "%d", (int)W);
  PrintLines(f, "obstacle", o->layout, closed);
  if (moving)
    PrintSlab(f, "", &markers);
  else
    fprintf(f,
            "<DataItem Dimensions=\"%s 2\" NumberType=\"Float\" Precision=\"8\" Format=\"HDF\">run.h5:/obstacle/markers"
            "</DataItem>",
            dims);
  fprintf(f, "</Geometry>\n");
  PrintVector(f, "force", dims, "", (XdmfSlab[]){x, y});
  fprintf(f, "</Grid>\n");
}

static void PrintFrame(const Xdmf *x, FILE *f, PetscInt t, PetscReal time) {
  const Scheme s = x->scheme;
  const Obstacles solids = s->coupling->bodies->obstacles;
  const PetscBool wrapped = FramesAreWrapped(s);
  fprintf(f, "<Grid Name=\"frame %d\" GridType=\"Collection\" CollectionType=\"Spatial\"><Time Value=\"%.17g\"/>\n",
          (int)t, (double)time);
  PrintFluid(s->fluid->grid, f, t, s->scene->output.precision == PRECISION_SINGLE ? 4 : 8);
  if (s->membrane->layout->M) PrintVesicles(f, t, s->membrane, wrapped);
  if (solids) PrintObstacles(f, t, solids, SceneObstaclesMove(&s->scene->obstacles), wrapped);
  if (x->tracers) {
    const XdmfSlab points = {wrapped ? "/tracers/wrapped" : "/tracers/points", 8, t, x->tracers, 0, 2, 2};
    fprintf(f, "<Grid Name=\"tracers\" GridType=\"Uniform\"><Topology TopologyType=\"Polyvertex\" ");
    fprintf(f, "NumberOfElements=\"%d\"/>\n<Geometry GeometryType=\"XY\">\n", (int)x->tracers);
    PrintSlab(f, "", &points);
    fprintf(f, "</Geometry></Grid>\n");
  }
  fprintf(f, "</Grid>\n");
}

static PetscErrorCode PrintEmpty(FILE *f, const void *none) {
  fprintf(f, XDMF_OPENING XDMF_CLOSING);
  return PETSC_SUCCESS;
}

/* Make a document without frames. */
static PetscErrorCode XdmfBegin(Xdmf *x) {
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  PetscCall(FolderWriteText(x->folder, "run.xmf", PrintEmpty, NULL));
  FolderPath(x->folder, "run.xmf", path);
  if (!x->folder->rank) x->file = open(path, O_WRONLY);
  PetscCall(FolderCheck(x->folder, x->file >= 0, "run.xmf"));
  FolderWatch(x->folder, "run.xmf");
  x->end = (off_t)strlen(XDMF_OPENING);
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
  done = pwrite(file, padded, all, place) == (ssize_t)all;
  free(padded);
  if (done) return new_size >= old_size || !ftruncate(file, new_size);
  if (pwrite(file, XDMF_CLOSING, strlen(XDMF_CLOSING), place) == (ssize_t)strlen(XDMF_CLOSING))
    (void)!ftruncate(file, place + (off_t)strlen(XDMF_CLOSING));
  return PETSC_FALSE;
}

/* Write a frame, the next one or the last one again, on rank 0. The number of frames is written first: run.h5 has as
 * many frames already. */
static PetscBool XdmfAppend(Xdmf *x, PetscInt frame, PetscReal time) {
  const off_t place = frame < x->frames ? x->last : x->end;
  char count[XDMF_COUNT_WIDTH + 8], *text = NULL;
  size_t size = 0;
  FILE *f = open_memstream(&text, &size);
  PetscBool done = PETSC_FALSE;
  if (!f) return PETSC_FALSE;
  PrintFrame(x, f, frame, time);
  fprintf(f, XDMF_CLOSING);
  if (!fclose(f)) {
    (void)snprintf(count, sizeof(count), "%*d", XDMF_COUNT_WIDTH, (int)frame + 1);
    done = pwrite(x->file, count, XDMF_COUNT_WIDTH, (off_t)strlen(XDMF_HEAD)) == XDMF_COUNT_WIDTH;
    if (done) done = XdmfOverwrite(x->file, place, text, size, x->end);
    x->last = place;
    x->end = place + (off_t)(size - strlen(XDMF_CLOSING));
  }
  free(text);
  return done;
}

PetscErrorCode XdmfWrite(Xdmf *x, AppendedFile *frames) {
  PetscBool done = PETSC_TRUE;
  PetscReal time = 0;
  PetscFunctionBeginUser;
  if (!x->end) PetscCall(XdmfBegin(x));
  for (PetscInt t = PetscMin(x->frames, frames->count - 1); t < frames->count; t++) {
    PetscCall(H5ReadArray(&frames->file, "/time", t, 1, &time));
    if (done && !x->folder->rank) done = XdmfAppend(x, t, time);
    x->frames = t + 1;
  }
  PetscCall(FolderCheck(x->folder, done, "run.xmf"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool XdmfClose(Xdmf *x) {
  return !x->folder || x->file < 0 || !close(x->file);
}
