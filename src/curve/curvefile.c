/* Closed curves from a text file: "x y" a line, # starts a comment, an empty line ends a curve. */
#include "curve/curve.h"
#include <errno.h>

typedef struct {
  PetscInt n, curves;
  PetscInt *end; /* points up to the end of each curve */
  PetscReal *xy;
  char error[PETVES_MAX_MESSAGE];
} Points;

static PetscErrorCode EndCurve(Points *p) {
  const PetscInt last = p->curves ? p->end[p->curves - 1] : 0;
  PetscFunctionBeginUser;
  if (p->n == last) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscRealloc((size_t)(p->curves + 1) * sizeof(PetscInt), &p->end));
  p->end[p->curves++] = p->n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read the lines on one rank; what is wrong goes into points->error. */
static PetscErrorCode ReadPoints(const char file[], Points *points) {
  FILE *f = fopen(file, "r");
  char line[1024];
  PetscInt number = 0, capacity = 0;
  PetscFunctionBeginUser;
  if (!f) {
    PetscCall(PetscSNPrintf(points->error, sizeof(points->error),
                            "-vesicle_file %s: cannot be opened (%s); allowed: a readable text file", file,
                            strerror(errno)));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  while (fgets(line, sizeof(line), f) && !*points->error) {
    double x, y;
    char rest[8];
    const PetscBool comment = line[strspn(line, " \t")] == '#' ? PETSC_TRUE : PETSC_FALSE;
    number++;
    line[strcspn(line, "#\r\n")] = 0;
    if (line[strspn(line, " \t,")] == 0) {
      if (!comment) PetscCall(EndCurve(points));
      continue;
    }
    for (char *p = line; *p; p++)
      if (*p == ',') *p = ' ';
    if (sscanf(line, "%lf %lf %7s", &x, &y, rest) != 2 || PetscIsInfOrNanReal(x) || PetscIsInfOrNanReal(y)) {
      PetscCall(PetscSNPrintf(points->error, sizeof(points->error),
                              "-vesicle_file %s: line %" PetscInt_FMT " is \"%.60s\"; allowed: two finite numbers, x y",
                              file, number, line));
      break;
    }
    if (points->n == capacity) {
      capacity = capacity ? 2 * capacity : 256;
      PetscCall(PetscRealloc(2 * capacity * sizeof(PetscReal), &points->xy));
    }
    points->xy[2 * points->n] = x;
    points->xy[2 * points->n++ + 1] = y;
  }
  fclose(f);
  PetscCall(EndCurve(points));
  if (!points->curves && !*points->error)
    PetscCall(PetscSNPrintf(points->error, sizeof(points->error),
                            "-vesicle_file %s: 0 points; allowed: at least 8 a curve", file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Number of points of one curve after dropping a repeated last one; turned counter-clockwise; what makes the curve
   unusable goes into error. */
static PetscErrorCode CleanCurve(const char file[], PetscInt *n, PetscReal xy[], char error[], size_t length_of_error) {
  PetscReal area = 0, length = 0;
  PetscFunctionBeginUser;
  if (*n > 1 && xy[0] == xy[2 * *n - 2] && xy[1] == xy[2 * *n - 1]) (*n)--;
  if (*n < 8) {
    PetscCall(PetscSNPrintf(error, length_of_error,
                            "-vesicle_file %s: %" PetscInt_FMT " points; allowed: at least 8 a curve", file, *n));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt i = 0; i < *n; i++) {
    const PetscReal *a = &xy[2 * i], *b = &xy[2 * ((i + 1) % *n)];
    const PetscReal d = PetscSqrtReal(PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1]));
    if (d == 0) {
      PetscCall(PetscSNPrintf(error, length_of_error,
                              "-vesicle_file %s: point %" PetscInt_FMT
                              " (%g %g) is given twice; allowed: distinct points",
                              file, i + 1, (double)a[0], (double)a[1]));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    area += 0.5 * (a[0] * b[1] - b[0] * a[1]);
    length += d;
  }
  if (PetscAbsReal(area) < 1e-6 * length * length)
    PetscCall(PetscSNPrintf(error, length_of_error,
                            "-vesicle_file %s: the curve encloses an area of %g; allowed: a closed simple curve", file,
                            (double)area));
  for (PetscInt i = 1, k = *n - 1; area < 0 && i < k; i++, k--)
    for (int c = 0; c < 2; c++) {
      const PetscReal swap = xy[2 * i + c];
      xy[2 * i + c] = xy[2 * k + c];
      xy[2 * k + c] = swap;
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurvesFromFile(MPI_Comm comm, const char file[], PetscInt *curves, Curve **curve) {
  Points p = {0};
  PetscMPIInt rank;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) PetscCall(ReadPoints(file, &p));
  PetscCallMPI(MPI_Bcast(p.error, sizeof(p.error), MPI_CHAR, 0, comm));
  PetscCallMPI(MPI_Bcast(&p.n, 1, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(&p.curves, 1, MPIU_INT, 0, comm));
  PetscCheck(!*p.error, comm, PETSC_ERR_USER_INPUT, "%s", p.error);
  if (rank) PetscCall(PetscRealloc((size_t)p.curves * sizeof(PetscInt), &p.end));
  if (rank) PetscCall(PetscRealloc(2 * (size_t)p.n * sizeof(PetscReal), &p.xy));
  PetscCallMPI(MPI_Bcast(p.end, (PetscMPIInt)p.curves, MPIU_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(p.xy, (PetscMPIInt)(2 * p.n), MPIU_REAL, 0, comm));
  *curves = p.curves;
  PetscCall(PetscCalloc1(p.curves, curve));
  for (PetscInt k = 0; k < p.curves; k++) {
    const PetscInt first = k ? p.end[k - 1] : 0;
    PetscInt n = p.end[k] - first;
    PetscCall(CleanCurve(file, &n, p.xy + 2 * first, p.error, sizeof(p.error)));
    PetscCheck(!*p.error, comm, PETSC_ERR_USER_INPUT, "%s", p.error);
    PetscCall(CurveFromPoints(n, p.xy + 2 * first, *curve + k));
  }
  PetscCall(PetscFree(p.end));
  PetscCall(PetscFree(p.xy));
  PetscFunctionReturn(PETSC_SUCCESS);
}
