/* The solution of each step's coupled problem in whole runs, FGMRES's, is that of a sparse LU of the same equations. */
#include "facts.h"
#include "app/simulation.h"
#include "scheme/coupled.h"
#include "direct.h"
#include <dlfcn.h>

/* Largest |x - y| of the solves of a scene so far, over 1 + max |y|, of velocity, pressure, tension, the markers' and
   the obstacles' part. */
enum { W, P, SIGMA, V, SOLID, VECTORS };
static PetscReal largest[VECTORS];
static PetscInt solves, iterations;
static Simulation run;

static void Compare(Vec x, Vec y, PetscReal *error) {
  const PetscReal size = TestNorm(NORM_INFINITY, y);
  TestCall(VecAXPY(x, -1, y));
  TestWorse(error, TestNorm(NORM_INFINITY, x) / (1 + size));
}

/* A problem with vectors of its own, the states before it in its forcing f and in k; w is used. */
static void Duplicate(Coupling c, const CoupledProblem *q, Forcing *f, Vec w, CoupledProblem *own) {
  const StreamPast *past = q->known.past;
  *own = (CoupledProblem){.known = q->known, .g = q->g};
  own->known.f = f;
  TestVecs(q->k, &own->k, NULL);
  TestVecs(q->sigma, &own->sigma, NULL);
  TestVecs(q->V, &own->V, NULL);
  if (q->solid) TestVecs(q->solid, &own->solid, NULL);
  TestCall(VecCopy(q->k, own->k));
  for (PetscInt j = 0; past && j < past->count; j++) {
    TestCall(StreamFlowsVelocity(c->mobility->stream->flows, past->flow[j], w));
    TestCall(VecScale(w, past->weight[j]));
    TestCall(ForcingAdd(f, w));
  }
  TestCall(MarkersInterpolate(c->markers, f->values, c->velocity)); /* of which markers have the lag */
  if (past) TestCall(VecAXPY(own->k, past->lag, c->velocity));
  TestCall(ForcingAdd(f, q->known.f->values));
}

/* The solver's u and p on the grid. */
static void Fields(Mobility m, const MobilityKnown *known, Vec w, Vec p) {
  if (known->past) {
    TestCall(StreamFlowsVelocity(m->stream->flows, known->past->made, w));
    TestCall(MobilityPressure(m, known->f, w, p));
  } else
    TestCall(MobilityFields(m, known->f, w, p));
}

/* In the place of the library's, which it calls: the dynamic linker finds this one first. */
PetscErrorCode CoupledSolverSolve(CoupledSolver s, const CoupledProblem *q, SolveReport *report) {
  PetscErrorCode (*solve)(CoupledSolver, const CoupledProblem *, SolveReport *);
  const Coupling c = s->coupling;
  CoupledProblem own;
  Forcing f;
  Vec w[2], p[2];
  PetscFunctionBeginUser;
  *(void **)&solve = dlsym(RTLD_NEXT, "CoupledSolverSolve");
  PetscCall(ForcingCreate(c->fluid->grid, c->mobility->contrast ? PETSC_TRUE : PETSC_FALSE, &f));
  TestVecs(f.values, &w[0], &w[1], NULL);
  TestFieldVecs(c->fluid->grid->da[FIELD_P], &p[0], &p[1], NULL);
  Duplicate(c, q, &f, w[0], &own);
  DirectSolve(c, &own, w[0], p[0]);
  PetscCall(solve(s, q, report));
  solves++;
  iterations += report->its;
  Fields(c->mobility, &q->known, w[1], p[1]);
  Compare(w[0], w[1], &largest[W]);
  Compare(p[0], p[1], &largest[P]);
  Compare(own.sigma, q->sigma, &largest[SIGMA]);
  Compare(own.V, q->V, &largest[V]);
  if (q->solid) Compare(own.solid, q->solid, &largest[SOLID]);
  PetscCall(ForcingDestroy(&f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where there is no body a step is a solve for u and p alone. */
PetscErrorCode MobilityFields(Mobility m, const Forcing *f, Vec u, Vec p) {
  PetscErrorCode (*solve)(Mobility, const Forcing *, Vec, Vec);
  const Coupling c = PlaneOf(&run->model)->coupling;
  CoupledProblem own = {0};
  Forcing copy;
  Vec w, q;
  PetscFunctionBeginUser;
  *(void **)&solve = dlsym(RTLD_NEXT, "MobilityFields");
  PetscCall(solve(m, f, u, p));
  if (CouplingHasBodies(c)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForcingCreate(m->fluid->grid, PETSC_FALSE, &copy));
  PetscCall(ForcingCopy(f, &copy));
  TestMarkerVecs(c->bodies->layout, 2, &own.k, NULL);
  TestMarkerVecs(c->membrane->layout, 2, &own.V, &own.known.G, NULL);
  TestMarkerVecs(c->membrane->layout, 1, &own.g, &own.sigma, NULL);
  TestVecs(u, &w, NULL);
  TestVecs(p, &q, NULL);
  own.known.f = &copy;
  DirectSolve(c, &own, w, q);
  Compare(w, u, &largest[W]);
  Compare(q, p, &largest[P]);
  solves++;
  PetscCall(ForcingDestroy(&copy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A scene's run, all of whose solves agree to `within`. */
static void Agrees(const char name[], PetscReal within, const char options[]) {
  static const char *const what[VECTORS] = {"velocity", "pressure", "tension", "markers' velocity", "obstacles' force"};
  PetscBool good;
  solves = iterations = 0;
  TestCall(PetscArrayzero(largest, VECTORS));
  TestCall(PetscOptionsClear(NULL));
  TestCall(PetscOptionsInsertString(NULL, "-output_overwrite -allow_unused_options -vesicle_allow_close_markers "
                                          "-coupled_ksp_rtol 1e-12 -checkpoint_every 0"));
  TestCall(PetscOptionsInsertString(NULL, options));
  TestCall(PetscOptionsSetValue(NULL, "-output_dir", TestScratch("direct")));
  TestCall(SimulationCreate(PETSC_COMM_WORLD, &run));
  TestCall(PetvesSetQuiet(PETSC_TRUE));
  TestCall(SimulationRun(run, &good));
  TestCall(SimulationDestroy(&run));
  TestAbout("%s", name);
  CHECK(good && solves > 0, "%d solves in %d iterations", (int)solves, (int)iterations);
  for (int k = 0; k < VECTORS; k++) CheckBelow(largest[k], within, "%s as of the sparse LU", what[k]);
}

#define STEPS " -time_step 0.02 -time_end 0.06"
#define SHEAR " -flow_type shear -flow_rate 2 -vesicle_angle 20"
#define ALONG " " CHANNEL
#define SEAMS " " PERIODIC
#define PAPER " " PAPER_MEMBRANE

/* The paper's membrane, of both orders, with and without bending, in every kind of box. */
static void PaperScenes(void) {
  static const char *const box[] = {" -domain_cells 24,24",
                                    " -domain_cells 30,24 -domain_box 0,2.5,-1,1 -vesicle_center 2.4,0.1" ALONG,
                                    " -domain_cells 24,24 -vesicle_center 0,0.9" SEAMS};
  static const char *const flow[] = {" -vesicle_angle 20", SHEAR};
  for (int k = 0; k < 12; k++) {
    const int order = 1 + k % 2, shear = k / 2 % 2;
    const char *name = TestText("box %d, %s, order %d", k / 4, shear ? "shear" : "at rest", order);
    const char *options = TestText("%s%s -scheme_order %d" PAPER STEPS, box[k / 4], flow[shear], order);
    Agrees(name, 1e-9, options);
    if (shear) Agrees(name, 1e-9, TestText("%s -vesicle_bending 0", options));
  }
}

#define PAIR                                                                                                           \
  " -domain_box -1.125,1.125,-1.125,1.125 -domain_cells 36,36 -vesicle_count 2 -vesicle_semi_axes 0.2,0.4 "            \
  "-vesicle_angle 0"
#define SMALL                                                                                                          \
  " -domain_box -2,2,-2,2 -domain_cells 32,32 -flow_type shear -vesicle_area 0.5 -vesicle_markers 25 -vesicle_count "  \
  "2 "                                                                                                                 \
  "-vesicle_center -.6,.2,.6,-.2 -vesicle_angle 60 -vesicle_bending .03 -time_step .1 -time_end .3 -scheme_order 3"
#define UNLIKE SMALL " -vesicle_viscosity_ratio 5,.3"
#define TOUCHING                                                                                                       \
  " -fluid_inertia none -vesicle_count 2 -vesicle_semi_axes 0.4,0.8 -vesicle_bending 0.05 -vesicle_markers 21 "        \
  "-domain_box -1.35,1.35,-1.35,1.35 -domain_cells 24,24 -coupling_box_part false -vesicle_center -0.45,0,0.45,0.3 "   \
  "-contact_repulsion 30 -contact_repulsion_range 0.3 -contact_adhesion 1 -contact_adhesion_range 0.2 "                \
  "-flow_type shear"
#define SETTLES                                                                                                        \
  " -domain_box -4,4,-4,4 -domain_cells 32,32 -vesicle_area 1 -vesicle_reduced_area .7 -vesicle_markers 35 "           \
  "-vesicle_bending .03 -vesicle_density_difference 2 -fluid_gravity 0,-1 -scheme_order 3 -time_step .05 -time_end .2"
#define POST                                                                                                           \
  " -vesicle_area .19634954 -vesicle_reduced_area .7 -vesicle_angle 90 -vesicle_center .25,1 -domain_box 0,2,0,2 "     \
  "-domain_cells 32,32 -obstacle_shape posts -obstacle_radius .3 -obstacle_center 1,1 -obstacle_spacing .75 "          \
  "-flow_type uniform -vesicle_bending .01 -scheme_order 3 -time_step .04 -time_end .12" SEAMS
#define POISEUILLE " -domain_box 0,3,0,1 -flow_type poiseuille -flow_half_width .5 -flow_center_y .5" ALONG
#define THROAT                                                                                                         \
  POISEUILLE " -flow_peak_velocity 1.5 -obstacle_shape constriction -obstacle_throat .48 -obstacle_length 1 "          \
             "-obstacle_center 1.5,0 -vesicle_semi_axes .45,.16 -vesicle_center 1.3,.5 -vesicle_bending .1 "           \
             "-domain_cells 72,24 -time_step .003 -time_end .009"
#define CELLS SHEAR STEPS " -domain_cells 24,24"

static const struct {
  const char *name, *options;
  PetscReal within; /* 0: 1e-9 */
} scenes[] = {
    {"exact near field", CELLS},
    {"ib6", CELLS " -delta_type ib6"},
    {"order 1", CELLS " -scheme_order 1"},
    {"chords", CELLS " -membrane_derivative bending"},
    {"unsteady", CELLS " -fluid_inertia unsteady"},
    {"channel", CELLS " -domain_box 0,2.5,-1,1 -domain_cells 30,24 -vesicle_center 1.2,0.1" ALONG},
    {"seam", CELLS " -domain_cells 25,25 -vesicle_center 0.97,-0.95" SEAMS},
    {"close markers", CELLS " -vesicle_spacing 0.7"},
    {"pair", CELLS PAIR " -vesicle_center -0.29375,0.05,0.29375,-0.05"},
    {"pair over a seam", CELLS PAIR " -vesicle_center -0.925,0.05,0.725,-0.05" ALONG},
    {"no bending", CELLS " -vesicle_bending 0"},
    {"little bending", CELLS " -vesicle_bending 1e-4"},
    {"stiff", CELLS " -vesicle_bending 1"},
    {"stiffer", CELLS " -vesicle_bending 100", 1e-7},
    {"quasi-steady in a box", CELLS " -fluid_inertia none"},
    {"quasi-steady in a channel", CELLS " -fluid_inertia none" ALONG},
    {"quasi-steady, periodic", CELLS " -fluid_inertia none" SEAMS},
    {"convective", CELLS " -fluid_inertia convective -time_step 0.005 -time_end 0.02"},
    {"no vesicle", " -vesicle_shape none -domain_cells 24,24 -flow_type shear -fluid_inertia unsteady" STEPS},
    {"box part between walls", SMALL " -fluid_inertia none"},
    {"box part in a channel", SMALL " -fluid_inertia none" ALONG},
    {"contrast between walls", UNLIKE},
    {"contrast next to walls", UNLIKE " -vesicle_center -.8,-1.58,.8,1.6 -vesicle_angle 5" ALONG},
    {"contrast, periodic", UNLIKE SEAMS},
    {"repulsion and adhesion", TOUCHING STEPS ALONG},
    {"gravity in a box", SETTLES " -fluid_inertia none"},
    {"gravity, periodic", SETTLES " -fluid_inertia none" SEAMS},
    {"gravity with inertia, periodic", SETTLES " -fluid_inertia unsteady" SEAMS},
    {"post", POST},
    {"post with inertia", POST " -fluid_inertia unsteady"},
    {"post and contrast", POST " -vesicle_viscosity_ratio 5"},
    {"post, flux held",
     POISEUILLE " -vesicle_shape none -domain_cells 72,24 -obstacle_shape posts -obstacle_center 1.5,.5 "
                "-obstacle_radius .2 -flow_drive flux -time_step .01 -time_end .01"},
    {"throat", THROAT, 3e-9},
};

/* A bump on a wall, with its foot half a cell from a corner of four walls. */
static void BumpBesideCorner(void) {
  const char *path = TestScratch("bump.txt");
  FILE *file;
  TestCall(PetscFOpen(PETSC_COMM_SELF, path, "w", &file));
  fprintf(file, "# open\n");
  for (int k = -40; k <= 40; k++)
    fprintf(file, "%.17g %.17g\n", 0.28 + k / 160., 0.15 * (1 + PetscCosReal(PETSC_PI * k / 40)));
  TestCall(PetscFClose(PETSC_COMM_SELF, file));
  Agrees("bump beside a corner", 1e-7,
         TestText("-vesicle_shape none -time_step .01 -time_end .01 -domain_box 0,1,0,1 -domain_cells 16,16 "
                  "-flow_type shear -obstacle_shape file -obstacle_file %s",
                  path));
}

void Facts(void) {
  PaperScenes();
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(scenes); k++)
    Agrees(scenes[k].name, scenes[k].within > 0 ? scenes[k].within : 1e-9, scenes[k].options);
  BumpBesideCorner();
}
