/* The frames of run.h5 in run.xmf. */
#include "output/xdmf.h"
#include "plane/plane.h"

/* Print two slabs as the x and y of a vector field with the dimensions dims. */
static void PrintVector(FILE *f, const char name[], const char dims[], const char before[], const XdmfSlab part[2]) {
  fprintf(f, "<Attribute Name=\"%s\" AttributeType=\"Vector\" Center=\"Node\">\n", name);
  fprintf(f, "<DataItem ItemType=\"Function\" Function=\"JOIN($0, $1, 0*$0)\" Dimensions=\"%s 3\">\n", dims);
  for (int c = 0; c < 2; c++) XdmfPrintSlab(f, before, &part[c]);
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
  XdmfPrintAttribute(f, "pressure", "Scalar", "1 ", &p);
  fprintf(f, "\n");
  PrintVector(f, "velocity", dims, "1 ", (XdmfSlab[]){u, v});
  fprintf(f, "</Grid>\n");
}

/* Print the lines through the markers of all bodies of a kind, up to the beginning of their geometry. */
static void PrintLines(FILE *f, const char kind[], Layout l, PetscInt closed) {
  fprintf(f, "<Grid Name=\"%s\" GridType=\"Uniform\"><Topology TopologyType=\"Mixed\" NumberOfElements=\"%d\">", kind,
          (int)l->bodies);
  XdmfPrintWhole(f, l->M + 2 * l->bodies + closed, 1, kind, "lines");
  fprintf(f, "</Topology>\n<Attribute Name=\"%s\" AttributeType=\"Scalar\" Center=\"Cell\">", kind);
  XdmfPrintWhole(f, l->bodies, 1, kind, "number");
  fprintf(f, "</Attribute>\n<Geometry GeometryType=\"XY\">\n");
}

static void PrintVesicles(FILE *f, PetscInt t, Membrane m, PetscBool wrapped) {
  const Layout l = m->layout;
  const XdmfSlab markers = {wrapped ? "/vesicle/wrapped" : "/vesicle/markers", 8, t, l->M, 0, 2, 2};
  const XdmfSlab tension = {"/vesicle/tension", 8, t, l->M, 0, 1, 0},
                 stretch = {"/vesicle/stretch", 8, t, l->M, 0, 1, 0};
  PrintLines(f, "vesicle", l, l->bodies);
  XdmfPrintSlab(f, "", &markers);
  fprintf(f, "</Geometry>\n");
  XdmfPrintAttribute(f, "tension", "Scalar", "", &tension);
  if (m->stretches) XdmfPrintAttribute(f, "stretch", "Scalar", "", &stretch);
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
    XdmfPrintSlab(f, "", &markers);
  else
    fprintf(f,
            "<DataItem Dimensions=\"%s 2\" NumberType=\"Float\" Precision=\"8\" Format=\"HDF\">run.h5:/obstacle/markers"
            "</DataItem>",
            dims);
  fprintf(f, "</Geometry>\n");
  PrintVector(f, "force", dims, "", (XdmfSlab[]){x, y});
  fprintf(f, "</Grid>\n");
}

void PlanePrint(const void *plane, FILE *f, PetscInt t, PetscReal time) {
  const Plane p = (Plane)plane;
  const Scheme s = p->scheme;
  const PetscInt tracers = p->tracers.n;
  const Obstacles solids = s->coupling->bodies->obstacles;
  const PetscBool wrapped = PlaneIsWrapped(s);
  fprintf(f, "<Grid Name=\"frame %d\" GridType=\"Collection\" CollectionType=\"Spatial\"><Time Value=\"%.17g\"/>\n",
          (int)t, (double)time);
  PrintFluid(s->fluid->grid, f, t, s->scene->output.precision == PRECISION_SINGLE ? 4 : 8);
  if (s->membrane->layout->M) PrintVesicles(f, t, s->membrane, wrapped);
  if (solids) PrintObstacles(f, t, solids, SceneObstaclesMove(&s->scene->obstacles), wrapped);
  if (tracers) {
    const XdmfSlab points = {wrapped ? "/tracers/wrapped" : "/tracers/points", 8, t, tracers, 0, 2, 2};
    fprintf(f, "<Grid Name=\"tracers\" GridType=\"Uniform\"><Topology TopologyType=\"Polyvertex\" ");
    fprintf(f, "NumberOfElements=\"%d\"/>\n<Geometry GeometryType=\"XY\">\n", (int)tracers);
    XdmfPrintSlab(f, "", &points);
    fprintf(f, "</Geometry></Grid>\n");
  }
  fprintf(f, "</Grid>\n");
}
