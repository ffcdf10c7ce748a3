#include "direct.h"
#include "bodies/bending.h"
#include "bodies/repulsion.h"
#include "bodies/turning.h"
#include "problem/contrast.h"

void DirectAdd(Direct *d, PetscInt row, PetscInt column, PetscReal value) {
  if (value != 0) TestCall(MatSetValue(d->A, row, column, value, ADD_VALUES));
}

/* Rows of the near field have an entry a marker, those of mean velocities one a face. */
static void Begin(Coupling c, Direct *d) {
  const PetscInt M = c->membrane->layout->M, all = 2 * c->bodies->layout->M;
  *d = (Direct){.c = c, .fluid = c->fluid, .grid = c->fluid->grid};
  const PetscInt size[PARTS] = {[PART_SIGMA] = M,
                                [PART_V] = 2 * M,
                                [PART_F] = 2 * M,
                                [PART_SOLID] = all - 2 * M,
                                [PART_JUMP] = c->mobility->contrast ? 2 * M : 0,
                                [PART_AREA] = LawAimsAreas(c->law) ? c->membrane->layout->bodies : 0,
                                [PART_MEAN] = DirectMeans(d)};
  for (int k = 0; k < PARTS; k++)
    d->first[k + 1] = d->first[k] + (k <= FIELD_P ? d->grid->columns[k] * d->grid->rows[k] : size[k]);
  const PetscInt n = d->first[PARTS];
  TestCall(MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 2 * all + 100, NULL, &d->A));
  TestCall(MatSetOption(d->A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
}

/* H, G and G^T. */
static void AddFluid(Direct *d) {
  const Grid g = d->grid;
  const PetscReal off = d->fluid->nu / PetscSqr(g->h), h = g->h;
  for (int f = FIELD_U; f <= FIELD_V; f++)
    for (PetscInt q = 0; q < g->columns[f] * g->rows[f]; q++) {
      const PetscInt i = q % g->columns[f], j = q / g->columns[f], row = DirectIndex(d, f, i, j);
      const PetscInt here = DirectIndex(d, FIELD_P, i, j), di[4] = {-1, 1, 0, 0}, dj[4] = {0, 0, -1, 1};
      const PetscInt ahead = DirectIndex(d, FIELD_P, (i + (f == FIELD_U)) % g->n[0], (j + (f == FIELD_V)) % g->n[1]);
      DirectAdd(d, row, row, d->fluid->alpha + 4 * off);
      for (int k = 0; k < 4; k++) {
        const PetscInt c = i + di[k], r = j + dj[k];
        if (g->wall[k / 2] && (c < 0 || c >= g->columns[f] || r < 0 || r >= g->rows[f]))
          DirectAdd(d, row, row, -off * GridWallFactor((Field)f, k / 2));
        else
          DirectAdd(d, row, DirectIndex(d, f, (c + g->columns[f]) % g->columns[f], (r + g->rows[f]) % g->rows[f]),
                    -off);
      }
      DirectAdd(d, row, ahead, 1 / h);
      DirectAdd(d, row, here, -1 / h);
      DirectAdd(d, ahead, row, 1 / h);
      DirectAdd(d, here, row, -1 / h);
      if (f < DirectMeans(d)) { /* g, and its own row, the sum of all velocities */
        DirectAdd(d, row, d->first[PART_MEAN] + f, 1);
        DirectAdd(d, d->first[PART_MEAN] + f, row, 1);
      }
    }
  DirectAdd(d, d->first[FIELD_P], d->first[FIELD_P], -1 / d->fluid->nu); /* p_0 = 0 */
}

/* E: -E w, what the markers have of it, in the rows of velocities, E^T F in the momentum. */
static void AddInterpolation(Direct *d) {
  const Grid g = d->grid;
  const PetscReal part = MobilityGridPart(d->c->mobility, d->fluid->alpha);
  for (PetscInt q = 0; q < 2 * d->c->bodies->layout->M; q++) {
    const Stencil *s = &d->c->markers->stencil[q];
    const int f = q % 2;
    for (PetscInt b = 0; b < s->n[1]; b++)
      for (PetscInt a = 0; a < s->n[0]; a++) {
        const PetscReal weight = s->weight[1][b] * s->weight[0][a];
        const PetscInt i = DirectEntry(g, 0, s->first[0] + a), j = DirectEntry(g, 1, s->first[1] + b);
        if (i < 0 || j < 0 || i >= g->columns[f] || j >= g->rows[f]) continue;
        DirectAdd(d, DirectRow(d, q), DirectIndex(d, f, i, j), -part * weight);
        DirectAdd(d, DirectIndex(d, f, i, j), d->first[PART_F] + q, weight);
      }
  }
}

/* One vesicle's rows between sigma, V and F, a column at a time by unit vectors:
   V + (v/a0) dV/dt - E w + h^2 C F = k,  F - Dm^T sigma/h^2 - ((c_b ds D4 + K_sigma)/(h^2 a0)) V = 0,  Dm V/h^2 = g,
   and with the area target the part m of the motion along z as an unknown of its own: V + .. + z m = k,  z.V = s. */
static void AddVesicle(Direct *d, PetscInt v) {
  const Membrane m = d->c->membrane;
  const PetscInt first = m->layout->start[v], n = LayoutCount(m->layout, v), sigma = d->first[PART_SIGMA] + first;
  const PetscInt V = d->first[PART_V] + 2 * first, F = d->first[PART_F] + 2 * first, area = d->first[PART_AREA] + v;
  const PetscReal h2 = PetscSqr(d->grid->h), a0 = d->fluid->a0;
  const Turning *turning = (const Turning *)ForcesFind(d->c->forces, "turning");
  PetscReal *unit = TestReals(2 * n), *D = TestReals(2 * n * n), *force = TestReals(2 * n), *turned = TestReals(2 * n);
  TestCall(LawBlock(d->c->law, v, D));
  for (PetscInt c = 0; c < 2 * n; c++) {
    unit[c] = 1;
    for (PetscInt k = 0; k < n; k++) {
      DirectAdd(d, sigma + k, V + c, D[2 * n * k + c]);
      DirectAdd(d, F + c, sigma + k, -D[2 * n * k + c]);
    }
    DirectAdd(d, F + c, F + c, 1);
    TestCall(PetscArrayzero(force, 2 * n));
    if (m->bending > 0) MembraneVesicleBending(m, v, -m->bending / (h2 * a0), unit, force);
    MembraneVesiclePull(m, v, -1 / (h2 * a0), turning->tension + first, unit, force);
    TestCall(PetscArraycpy(turned, unit, 2 * n));
    MembraneLabelDerivative(m, v, d->c->treading[v] / a0, unit, turned);
    for (PetscInt r = 0; r < 2 * n; r++) {
      DirectAdd(d, F + r, V + c, force[r]);
      if (!d->c->mobility->contrast) DirectAdd(d, V + r, V + c, turned[r]);
    }
    if (LawAimsAreas(d->c->law)) DirectAdd(d, V + c, area, d->c->law->z[2 * first + c]);
    if (LawAimsAreas(d->c->law)) DirectAdd(d, area, V + c, d->c->law->z[2 * first + c]);
    unit[c] = 0;
  }
}

/* The springs of a repulsion: -(K_rep/(h^2 a0)) V in the rows of F. */
static void AddSprings(Direct *d) {
  const Repulsion r = (Repulsion)ForcesFind(d->c->forces, "contact");
  const PetscReal scale = -1 / (PetscSqr(d->grid->h) * d->fluid->a0);
  for (PetscInt q = 0; r && q < r->count; q++) {
    const Spring *s = &r->spring[q];
    for (PetscInt i = 0; i < 2 * s->n; i++)
      for (PetscInt j = 0; j < 2 * s->n; j++)
        DirectAdd(d, d->first[PART_F] + 2 * s->marker[i / 2] + i % 2, d->first[PART_V] + 2 * s->marker[j / 2] + j % 2,
                  scale * s->stiffness * s->weight[i / 2] * s->normal[i % 2] * s->weight[j / 2] * s->normal[j % 2]);
  }
}

/* h^2 (C + D) F of the near field in the rows of velocities, h^2 beta N N^T F in those of each obstacle. */
static void AddNearField(Direct *d) {
  const Obstacles o = d->c->bodies->obstacles;
  const PetscInt n = 2 * d->c->bodies->layout->M, solid = d->first[PART_SOLID];
  const PetscReal h2 = PetscSqr(d->grid->h);
  const MarkerRange every = {0, n / 2};
  PetscReal *C = TestReals(n * n);
  if (d->c->mobility->near) TestCall(NearFieldAdd(d->c->mobility->near, h2, PETSC_TRUE, &every, &every, C));
  for (PetscInt k = 0; k < n * n; k++) DirectAdd(d, DirectRow(d, k % n), d->first[PART_F] + k / n, C[k]);
  for (PetscInt b = 0; o && b < o->layout->bodies; b++)
    for (PetscInt i = 2 * o->layout->start[b]; i < 2 * o->layout->start[b + 1]; i++)
      for (PetscInt j = 2 * o->layout->start[b]; j < 2 * o->layout->start[b + 1]; j++)
        DirectAdd(d, solid + i, solid + j, h2 * o->beta * o->N[i] * o->N[j]);
}

static void Assemble(Direct *d) {
  AddFluid(d);
  AddInterpolation(d);
  AddSprings(d);
  for (PetscInt v = 0; v < d->c->membrane->layout->bodies; v++) AddVesicle(d, v);
  AddNearField(d);
  if (d->c->mobility->contrast) DirectAddContrast(d);
  TestCall(MatAssemblyBegin(d->A, MAT_FINAL_ASSEMBLY));
  TestCall(MatAssemblyEnd(d->A, MAT_FINAL_ASSEMBLY));
}

/* Factors of the rows (side 0) and of the unknowns (side 1) that make all entries numbers without a unit, velocities
   staying as they are: pivots do not depend on what lengths and times are measured in. */
static void Factors(const Direct *d, int side, Vec factors) {
  const PetscReal h = d->grid->h, force = side ? d->fluid->nu / (h * h) : h * h / d->fluid->nu, own = side ? 1 : force;
  const PetscReal factor[PARTS] = {
      own, own, side ? force * h : h, side ? force * h * h : h * h, 1, force, side ? force : 1, 1, 1, side ? force : 1};
  PetscScalar *a = TestArray(factors);
  for (int k = 0; k < PARTS; k++)
    for (PetscInt i = d->first[k]; i < d->first[k + 1]; i++) a[i] = factor[k];
}

/* n numbers of a vector from `first` on. */
static void Take(Vec from, PetscInt first, PetscInt n, PetscScalar to[]) {
  TestCall(PetscArraycpy(to, TestArray(from) + first, n));
}

static void Give(const Direct *d, Vec x, int part, Vec to) {
  PetscInt n;
  TestCall(VecGetLocalSize(to, &n));
  Take(x, d->first[part], n, TestArray(to));
}

/* The near field of the forces that are known; of a contrast's motion that is known -B in k, the dipoles in f and the
   divergence, and the mean velocity that goes with them. */
static void RightHandSide(const Direct *d, const CoupledProblem *q, Vec rhs) {
  const PetscInt *first = d->first, V = first[PART_F] - first[PART_V];
  const Mobility m = d->c->mobility;
  const Layout l = d->c->membrane->layout;
  const MobilityKnown *known = &q->known;
  const PetscScalar *G = TestArray(known->G);
  PetscScalar *k = TestArray(q->k);
  TestCall(MobilityAddLayers(m, known->F, known->G, k));
  for (PetscInt v = 0; v < l->bodies; v++)
    for (PetscInt i = 2 * l->start[v]; i < 2 * l->start[v + 1]; i++) k[i] -= MobilityWeight(m, v) * G[i];
  if (m->contrast) TestCall(DoubleLayerSpread(m->contrast, known->G, known->f));
  TestCall(MobilityBegin(m, known));
  TestCall(VecSet(rhs, 0));
  PetscScalar *b = TestArray(rhs);
  Take(known->f->values, 0, first[FIELD_P], b);
  if (known->f->source) Take(known->f->source, 0, first[PART_SIGMA] - first[FIELD_P], b + first[FIELD_P]);
  Take(q->g, 0, V / 2, b + first[PART_SIGMA]);
  Take(q->k, 0, V, b + first[PART_V]);
  Take(q->k, V, first[PART_JUMP] - first[PART_SOLID], b + first[PART_SOLID]);
  for (PetscInt v = first[PART_AREA]; v < first[PART_MEAN]; v++) b[v] = d->c->law->speed[v - first[PART_AREA]];
  for (PetscInt f = 0; f < DirectMeans(d); f++)
    b[first[PART_MEAN] + f] = known->f->mean[f] * d->grid->n[0] * d->grid->n[1];
}

/* A x = b by MUMPS and two steps of iterative refinement. Pivoting in a saddle-point matrix needs more room than MUMPS
   expects: four times, ICNTL(14) in per cent. */
static void SolveLU(Mat A, Vec b, Vec x) {
  KSP ksp;
  PC pc;
  Mat F;
  TestCall(KSPCreate(PETSC_COMM_SELF, &ksp));
  TestCall(KSPSetType(ksp, KSPRICHARDSON));
  TestCall(KSPSetNormType(ksp, KSP_NORM_NONE));
  TestCall(KSPSetTolerances(ksp, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, 3));
  TestCall(KSPSetOperators(ksp, A, A));
  TestCall(KSPGetPC(ksp, &pc));
  TestCall(PCSetType(pc, PCLU));
  TestCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  TestCall(PCFactorSetUpMatSolverType(pc));
  TestCall(PCFactorGetMatrix(pc, &F));
  TestCall(MatMumpsSetIcntl(F, 14, 300));
  TestCall(KSPSetErrorIfNotConverged(ksp, PETSC_TRUE));
  TestCall(KSPSolve(ksp, b, x));
  TestCall(KSPDestroy(&ksp));
}

void DirectSolve(Coupling c, const CoupledProblem *q, Vec w, Vec p) {
  Direct d;
  Vec b, x, rows, columns;
  Begin(c, &d);
  Assemble(&d);
  TestCall(MatCreateVecs(d.A, &x, &b));
  TestKeep(x, PETSC_TRUE);
  TestKeep(b, PETSC_TRUE);
  TestVecs(x, &rows, &columns, NULL);
  Factors(&d, 0, rows);
  Factors(&d, 1, columns);
  TestCall(MatDiagonalScale(d.A, rows, columns));
  RightHandSide(&d, q, b);
  TestCall(VecPointwiseMult(b, b, rows));
  SolveLU(d.A, b, x);
  TestCall(VecPointwiseMult(x, x, columns));
  Give(&d, x, FIELD_U, w);
  Give(&d, x, FIELD_P, p);
  TestRemoveMean(p);
  Give(&d, x, PART_SIGMA, q->sigma);
  Give(&d, x, PART_V, q->V);
  if (q->solid) Give(&d, x, PART_SOLID, q->solid);
  if (q->solid) TestCall(VecScale(q->solid, PetscSqr(d.grid->h)));
  TestCall(MatDestroy(&d.A));
}
