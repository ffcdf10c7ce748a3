/* Surfaces in spherical harmonics: tables, exact layers, bending energy, area. */
#include "facts.h"
#include "numerics/blas.h"
#include "sphere/spherelayer.h"
#include "sphere/surface.h"

TestScoped(Surface, SurfaceDestroy);

/* Any smooth surface: an ellipsoid and some harmonics of a degree below p. */
static PetscReal *TestSurface(PetscInt p, PetscReal rough) {
  const PetscInt count = HarmonicsCount(p);
  const PetscReal axes[3] = {1.3, 0.9, 0.8};
  PetscReal *c = TestReals(3 * count);
  unsigned seed = 7;
  SurfaceEllipsoid(p, axes, c);
  for (PetscInt k = 0; k < 3 * count; k++) {
    const PetscInt l = HarmonicsDegree(k % count);
    if (l > 0 && l < p) c[k] += rough * TestRandom(&seed) / PetscPowReal(4, (PetscReal)l);
  }
  return c;
}

static void CheckTables(Sphere s) {
  const PetscInt count = s->count, parts = HARMONIC_PARTS * count;
  PetscReal *gram = TestReals(count * count), *y = TestReals(count), *z = TestReals(count), error = 0;
  const PetscReal step = 1e-5, at[] = {0.7, 2.1}, turn = 0.9;
  TestCall(SphereTableProject(&s->fine, count, count, s->fine.part[HARMONIC], gram));
  for (PetscInt k = 0; k < count * count; k++) TestWorse(&error, gram[k] - (k % count == k / count));
  CheckBelow(error, 1e-13, "%d harmonics are orthonormal on %d points", (int)count, (int)s->fine.grid.n);
  PetscReal *table = TestReals(parts), *moved = TestReals(4 * parts);
  TestCall(HarmonicsAt(s->p, s->p, 1, at, at + 1, HARMONIC_PARTS, table));
  for (int q = 0; q < 4; q++) { /* theta and phi, each farther and back */
    PetscReal place[2] = {at[0], at[1]};
    place[q / 2] += q % 2 ? -step : step;
    TestCall(HarmonicsAt(s->p, s->p, 1, &place[0], &place[1], HARMONIC_PARTS, moved + q * parts));
  }
  static const int pairs[][3] = {{HARMONIC, HARMONIC_T, 0},
                                 {HARMONIC, HARMONIC_P, 2},
                                 {HARMONIC_T, HARMONIC_TT, 0},
                                 {HARMONIC_T, HARMONIC_TP, 2},
                                 {HARMONIC_P, HARMONIC_PP, 2}};
  for (int q = 0; q < 5; q++) {
    error = 0;
    for (PetscInt k = 0; k < count; k++) {
      const PetscReal *up = moved + pairs[q][2] * parts + pairs[q][0] * count, *down = up + parts;
      TestWorse(&error, (up[k] - down[k]) / (2 * step) - table[pairs[q][1] * count + k]);
    }
    CheckBelow(error, 1e-10 * PetscPowReal((PetscReal)s->p, 4), "degree %d: derivative %d by differences", (int)s->p,
               pairs[q][1]);
  }
  const PetscReal *c = TestSurface(s->p, 1), phi = at[1] + turn;
  HarmonicsTurn(s->p, turn, PETSC_FALSE, c, y);
  TestCall(HarmonicsAt(s->p, s->p, 1, at, &phi, 1, moved));
  CheckBelow(TestProduct(count, y, table) - TestProduct(count, c, moved), 1e-13, "coefficients turn by %g", turn);
  HarmonicsTurn(s->p, turn, PETSC_TRUE, y, z);
  CheckBelow(TestFar(count, z, c), 1e-14, "and back");
}

/* Drag over 6 pi b of a prolate spheroid, long half axis a, short b, along and across it (Perrin 1936). */
static PetscReal SpheroidDrag(PetscReal a, PetscReal b, PetscBool along) {
  const PetscReal e = PetscSqrtReal(1 - b * b / (a * a)), L = PetscLogReal((1 + e) / (1 - e));
  return a / b * e * e * e * (along ? 8 / (3 * ((1 + e * e) * L - 2 * e)) : 16 / (3 * ((3 * e * e - 1) * L + 2 * e)));
}

static void CheckDrag(Sphere s, PetscReal a, PetscReal most) {
  const PetscInt count = s->count, size = 3 * count;
  const PetscReal axes[3] = {a, 1, 1};
  PetscReal *c = TestReals(size), *S = TestReals(size * size), worst = 0;
  SurfaceEllipsoid(s->p, axes, c);
  TestCall(SphereSingleLayer(s, 2, c, S)); /* the force of a translating ellipsoid is even on the parameter sphere */
  for (int d = 0; d < 3; d++) {
    const PetscReal drag = a > 1 ? SpheroidDrag(a, 1, d == 0) : 1, *column = S + d * count * size;
    TestWorse(&worst, 3 * drag * column[d * count] - 1);
  }
  CheckBelow(worst, most, "drag of a spheroid of axes %g, 1, 1, relative", a);
}

static void CheckDoubleLayer(Sphere s) {
  const PetscInt count = s->count, size = 3 * count;
  const PetscReal axes[3] = {1.5, 0.8, 0.8};
  PetscReal *c = TestReals(size), *D = TestReals(size * size), *U = TestReals(size), *V = TestReals(size),
            error[2] = {0};
  SurfaceEllipsoid(s->p, axes, c);
  TestCall(SphereLayerMatrix(s, &Stresslet3, c, D));
  for (int q = 0; q < 6; q++) {
    const int d = q % 3, e = (d + 1) % 3, f = (d + 2) % 3;
    for (PetscInt k = 0; k < size; k++) U[k] = V[k] = 0;
    if (q < 3) U[d * count] = 1;
    for (PetscInt k = 0; k < count && q >= 3; k++) {
      U[e * count + k] = -c[f * count + k];
      U[f * count + k] = c[e * count + k];
    }
    TestCall(DenseMultAdd(PETSC_FALSE, size, size, 1, D, U, V));
    for (PetscInt k = 0; k < size; k++) TestWorse(&error[q / 3], V[k] - U[k] / 2);
  }
  CheckBelow(error[0], 2e-6, "the double layer halves translations");
  CheckBelow(error[1], 4e-6, "the double layer halves rotations");
}

static void CheckMeasures(Sphere s) {
  const PetscInt size = 3 * s->count;
  const PetscReal axes[3] = {2, 2, 2};
  PetscReal *c = TestReals(size), *N = TestReals(size * size), *n = TestReals(size);
  Scoped(Surface) surface;
  SurfaceEllipsoid(s->p, axes, c);
  TestCall(SurfaceCreate(s, &surface));
  TestCall(SurfacePlace(surface, c, PETSC_TRUE));
  CheckBelow(surface->area / (16 * PETSC_PI) - 1, 1e-13, "area of a sphere");
  CheckBelow(surface->volume / (32 * PETSC_PI / 3) - 1, 1e-13, "volume of a sphere");
  CheckBelow(surface->energy / (8 * PETSC_PI) - 1, 1e-12, "energy of a sphere");
  TestCall(SurfaceNormals(surface, N));
  TestCall(DenseMultAdd(PETSC_FALSE, size, size, 0.5, N, c, n)); /* X/2 is the normal */
  CheckBelow(TestProduct(size, n, n) - 4 * PETSC_PI, 1e-12, "the normal is normal");
  for (PetscInt k = 0; k < size; k++) c[k] *= 0.5;
  PetscReal *tension = TestReals(s->count), *K = TestReals(size * size), *V = TestReals(size);
  tension[0] = PetscSqrtReal(4 * PETSC_PI); /* 1 everywhere */
  TestCall(SurfacePlace(surface, c, PETSC_TRUE));
  TestCall(SurfacePull(surface, tension, K));
  for (PetscInt l = 2; l <= 4; l++) { /* V = n Y_(l, 1) */
    PetscReal *at = TestReals(3 * surface->n);
    for (PetscInt k = 0; k < 3 * surface->n; k++)
      at[k] = surface->normal[k] * s->fine.part[HARMONIC][(l * l + l + 1) * surface->n + k % surface->n];
    TestCall(SphereTableProject(&s->fine, s->count, 3, at, V));
    for (PetscInt k = 0; k < size; k++) n[k] = 0;
    TestCall(DenseMultAdd(PETSC_FALSE, size, size, 1, K, V, n));
    CheckBelow(TestProduct(size, n, V) / (l * (l + 1)) - 1, 1e-11, "tension pulls a bump of degree %d with l(l + 1)",
               (int)l);
  }
}

/* Energy and area along a random change, by differences of fourth order. */
static void CheckGradients(Sphere s) {
  static const PetscReal at[] = {1, -1, 2, -2}, weight[] = {2. / 3, -2. / 3, -1. / 12, 1. / 12};
  const PetscInt size = 3 * s->count;
  const PetscReal step = 2e-3;
  PetscReal *c = TestSurface(s->p, 1), *d = TestSurface(s->p, 2), *g = TestReals(size), *A = TestReals(size * s->count),
            *x = TestReals(size), rise[2] = {0}, slope[2] = {0};
  Scoped(Surface) surface;
  TestCall(SurfaceCreate(s, &surface));
  TestCall(SurfacePlace(surface, c, PETSC_TRUE));
  TestCall(SurfaceGradient(surface, g));
  TestCall(SurfaceAreaColumns(surface, A));
  for (PetscInt k = 0; k < size; k++) d[k] -= c[k];
  slope[0] = TestProduct(size, g, d);
  for (PetscInt k = 0; k < size; k++) slope[1] += A[k] * d[k] * PetscSqrtReal(4 * PETSC_PI);
  for (int q = 0; q < 4; q++) {
    for (PetscInt k = 0; k < size; k++) x[k] = c[k] + at[q] * step * d[k];
    TestCall(SurfacePlace(surface, x, PETSC_FALSE));
    rise[0] += weight[q] / step * surface->energy;
    rise[1] += weight[q] / step * surface->area;
  }
  for (int q = 0; q < 2; q++)
    CheckBelow(rise[q] / slope[q] - 1, 1e-8, "gradient of the %s by differences", q ? "area" : "energy");
}

void Facts(void) {
  static const PetscInt degrees[] = {8, 12};
  for (int q = 0; q < 2; q++) {
    Sphere s;
    TestAbout("degree %d", (int)degrees[q]);
    TestCall(SphereCreate(degrees[q], SPHERE_WHOLE, &s));
    CheckTables(s);
    CheckDrag(s, 1, 1e-13);
    CheckDrag(s, 1.6, q ? 1e-11 : 1e-8);
    CheckDoubleLayer(s);
    CheckMeasures(s);
    CheckGradients(s);
    TestCall(SphereDestroy(&s));
  }
}
