/* Packings of ellipses: all of them in the box, a gap apart, at fractions that random placing alone does not reach. */
#include "curve/packing.h"
#include "facts.h"

#define POINTS 64 /* on an outline */

/* The outline of an ellipse as it lies. */
static void Outline(const PetscReal axes[2], const Pose *at, PetscReal X[]) {
  for (PetscInt k = 0; k < POINTS; k++) {
    const PetscReal t = 2 * PETSC_PI * k / POINTS, x = axes[0] * PetscCosReal(t), y = axes[1] * PetscSinReal(t);
    X[2 * k] = at->center[0] + at->along[0] * x - at->along[1] * y;
    X[2 * k + 1] = at->center[1] + at->along[1] * x + at->along[0] * y;
  }
}

/* Least distance of points of any two ellipses or images, at least the true one (walls: of a point from a wall). */
static PetscReal LeastDistance(const PackingSpec *s, PetscInt n, const PetscReal X[], PetscBool walls) {
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt i = 0; i < n * POINTS; i++) {
    for (int c = 0; c < 2 && walls; c++)
      if (!s->periodic[c])
        least = PetscMin(least, PetscMin(X[2 * i + c] - s->box[2 * c], s->box[2 * c + 1] - X[2 * i + c]));
    for (PetscInt j = (i / POINTS + 1) * POINTS; j < n * POINTS && !walls; j++) {
      PetscReal d[2];
      for (int c = 0; c < 2; c++) {
        d[c] = X[2 * i + c] - X[2 * j + c];
        if (s->periodic[c]) d[c] = remainder(d[c], s->box[2 * c + 1] - s->box[2 * c]);
      }
      least = PetscMin(least, PetscHypotReal(d[0], d[1]));
    }
  }
  return least;
}

/* Semi-axes of n ellipses in the proportion 3:1, or every other of them half as large and rounder. */
static void Axes(PetscInt n, PetscBool mixed, PetscReal fraction, PetscReal box, PetscReal axes[]) {
  PetscReal area = 0;
  for (PetscInt i = 0; i < n; i++) {
    const PetscBool small = mixed && i % 2;
    axes[2 * i] = small ? 0.8 : 1.7;
    axes[2 * i + 1] = small ? 0.6 : 0.57;
    area += PETSC_PI * axes[2 * i] * axes[2 * i + 1];
  }
  const PetscReal scale = PetscSqrtReal(fraction * box / area);
  for (PetscInt i = 0; i < 2 * n; i++) axes[i] *= scale;
}

static void CheckRandom(const PackingSpec *s, PetscInt n, PetscBool mixed, PetscReal fraction) {
  const PetscReal box = (s->box[1] - s->box[0]) * (s->box[3] - s->box[2]);
  PetscReal *axes = TestReals(2 * n), *X = TestReals(2 * n * POINTS), part, other, mean[2] = {0, 0}, same = 0,
            apart = 0;
  PackingSpec again = *s;
  Pose *pose, *second;
  TestCall(PetscMalloc2(n, &pose, n, &second));
  Axes(n, mixed, fraction, box, axes);
  TestCall(PackRandomly(s, n, axes, pose, &part));
  for (PetscInt i = 0; i < n; i++) {
    Outline(axes + 2 * i, pose + i, X + 2 * POINTS * i);
    mean[0] += (2 * PetscSqr(pose[i].along[0]) - 1) / n; /* cos, sin of twice the angle */
    mean[1] += 2 * pose[i].along[0] * pose[i].along[1] / n;
  }
  TestCall(PackRandomly(s, n, axes, second, &other));
  for (PetscInt i = 0; i < n; i++) TestWorse(&same, pose[i].center[0] - second[i].center[0]);
  again.seed++;
  TestCall(PackRandomly(&again, n, axes, second, &other));
  for (PetscInt i = 0; i < n; i++) apart += PetscAbsReal(pose[i].center[0] - second[i].center[0]) / n;
  TestAbout("%d %s ellipses at %g", (int)n, mixed ? "mixed" : "equal", fraction);
  CHECK(part >= 1, "all have their size");
  CHECK(LeastDistance(s, n, X, PETSC_FALSE) >= s->gap, "they are %.3g apart, at least %g",
        LeastDistance(s, n, X, PETSC_FALSE), s->gap);
  CHECK(LeastDistance(s, n, X, PETSC_TRUE) >= s->wall_gap * (1 - 1e-12), "they are %.3g from walls, at least %g",
        LeastDistance(s, n, X, PETSC_TRUE), s->wall_gap);
  CheckBelow(PetscHypotReal(mean[0], mean[1]), 5 / PetscSqrtReal(n), "their directions have the mean");
  CHECK(same == 0 && apart > 0.1 * (s->box[1] - s->box[0]), "the same seed gives the same, another one another");
  TestCall(PetscFree2(pose, second));
}

/* On a lattice, and where there is no room. */
static void CheckFull(void) {
  const PackingSpec s = {{0, 12, -2, 4}, {PETSC_TRUE, PETSC_FALSE}, 0.05, 0.05, 1};
  const PetscReal along[2] = {0.8, 0.6};
  PetscReal axes[2 * 20], X[2 * 18 * POINTS], part;
  Pose pose[20];
  TestAbout("ellipses");
  Axes(18, PETSC_FALSE, 0.3, 72, axes);
  TestCall(PackLattice(&s, 18, axes, along, pose, &part));
  for (PetscInt i = 0; i < 18; i++) Outline(axes + 2 * i, pose + i, X + 2 * POINTS * i);
  CHECK(part >= 1 && LeastDistance(&s, 18, X, PETSC_FALSE) >= s.gap && LeastDistance(&s, 18, X, PETSC_TRUE) >= s.gap,
        "a lattice at .3");
  Axes(18, PETSC_FALSE, 0.9, 72, axes);
  TestCall(PackLattice(&s, 18, axes, along, pose, &part));
  CHECK(part < 0.9 && part > 0.3, "at .9 it has room for %.2g", (0.9 * part));
  const PackingSpec box = {{0, 8, 0, 8}, {PETSC_TRUE, PETSC_TRUE}, 0.02, 0.02, 1};
  Axes(20, PETSC_FALSE, 0.95, 64, axes);
  TestCall(PackRandomly(&box, 20, axes, pose, &part));
  CHECK(part < 1, "at random at .95 only %.2g have their size", part);
}

void Facts(void) {
  const PackingSpec channel = {{0, 12, -3, 3}, {PETSC_TRUE, PETSC_FALSE}, 0.03, 0.03, 1},
                    walls = {{-5, 5, 0, 8}, {PETSC_FALSE, PETSC_FALSE}, 0.02, 0.1, 7},
                    periodic = {{0, 6, 0, 6}, {PETSC_TRUE, PETSC_TRUE}, 0.03, 0.03, 3},
                    tiny = {{0, 2.6, 0, 2.6}, {PETSC_TRUE, PETSC_TRUE}, 0.02, 0.02, 1}; /* images are neighbours */
  CheckRandom(&channel, 60, PETSC_FALSE, 0.3);
  CheckRandom(&channel, 48, PETSC_TRUE, 0.52);
  CheckRandom(&walls, 60, PETSC_FALSE, 0.52);
  CheckRandom(&periodic, 36, PETSC_FALSE, 0.55);
  CheckRandom(&tiny, 3, PETSC_FALSE, 0.3);
  CheckFull();
}
