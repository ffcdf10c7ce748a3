/* Curves from a text file: "x y" a line, # starts a comment, an empty line ends a curve; a header "x,y" is skipped.
   Surfaces: "x y z" or "l m c_x c_y c_z" a line. */
#include "curve/curve.h"
#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <strings.h>

#define PERIOD_ERROR 1e-6 /* over a period: error of a last point that is the first a period on */
#define POINT_ERROR 1e-9  /* over a curve's size: distance up to which two points are one */

#define MOST_COLUMNS 5

typedef struct {
  PetscInt columns; /* numbers a line; 0: 3 or 5, as the first line has */
  PetscInt n, curves;
  PetscInt *end;                                   /* [curves] points up to the end of each curve */
  PetscReal *xy;                                   /* [n][columns] */
  CurveNote *note;                                 /* [curves] */
  size_t end_capacity, xy_capacity, note_capacity; /* of the three arrays */
  CurveNote next;                                  /* note of the curve that is being read */
  const char *option, *file, *least;               /* how many points, for messages */
  const PetscReal *period;                         /* NULL: closed curves only */
  char error[PETVES_MAX_MESSAGE];
} Points;

static PetscErrorCode PointsEndCurve(Points *p) {
  const PetscInt last = p->curves ? p->end[p->curves - 1] : 0;
  PetscFunctionBeginUser;
  if (p->n == last) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArrayReserve((size_t)(p->curves + 1), &p->end_capacity, &p->end));
  PetscCall(ArrayReserve((size_t)(p->curves + 1), &p->note_capacity, &p->note));
  p->note[p->curves] = p->next;
  p->end[p->curves++] = p->n;
  p->next = (CurveNote){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Count of the finite numbers in a text, with blanks or commas between them; -1 if there are more than `most` or
   anything else. */
static int PointsNumbers(const char text[], int most, PetscReal x[]) {
  int n = 0;
  while (text[strspn(text, " \t\r\n,")]) {
    char *end;
    text += strspn(text, " \t\r\n,");
    const double value = strtod(text, &end);
    if (end == text || n == most || PetscIsInfOrNanReal(value)) return -1;
    x[n++] = value;
    text = end;
  }
  return n;
}

/* Write the message of a mistake; it begins with the option and the file. */
static void PETSC_ATTRIBUTE_FORMAT(2, 3) PointsRefuse(Points *p, const char format[], ...) {
  const int used = snprintf(p->error, sizeof(p->error), "%s %s: ", p->option, p->file);
  size_t length;
  va_list arguments;
  va_start(arguments, format);
  (void)PetscVSNPrintf(p->error + used, sizeof(p->error) - (size_t)used, format, &length, arguments);
  va_end(arguments);
}

/* Write the message of a line whose text is not what is allowed. */
static void PointsRefuseLine(Points *p, PetscInt number, const char line[], const char allowed[]) {
  PointsRefuse(p, "line %" PetscInt_FMT " is \"%.60s\"; allowed: %s", number, line, allowed);
}

/* Read a comment whose first word is known: it is a note on the next curve, such as "# velocity x y". */
static PetscErrorCode PointsReadNote(const char line[], PetscInt number, Points *points) {
  const char *start = line + 1 + strspn(line + 1, " \t");
  const size_t length = strcspn(start, " \t,:=");
  CurveNote *note = &points->next;
  const struct {
    const char *word;
    int numbers;
    PetscReal *value;
  } known[] = {{"open", 0, NULL}, {"velocity", 2, note->velocity}, {"rotation", 1, &note->rotation}};
  PetscReal x[2];
  PetscFunctionBeginUser;
  for (int k = 0; k < 3; k++) {
    if (length != strlen(known[k].word) || strncasecmp(start, known[k].word, length)) continue;
    if (PointsNumbers(start + length, 2, x) != known[k].numbers)
      PointsRefuseLine(points, number, line, "# velocity and two finite numbers, # rotation and one, # open and none");
    else if (known[k].value)
      PetscCall(PetscArraycpy(known[k].value, x, known[k].numbers));
    else
      note->open = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read line `number` of the file. */
static PetscErrorCode PointsReadLine(char line[], PetscInt number, Points *points) {
  const char *start = line + strspn(line, " \t");
  PetscReal x[MOST_COLUMNS];
  PetscFunctionBeginUser;
  line[strcspn(line, "\r\n")] = 0;
  if (*start == '#' && points->period) PetscCall(PointsReadNote(start, number, points));
  if (*start == '#' || (number == 1 && tolower((unsigned char)*start) == 'x')) /* the header "x,y" of CSV */
    PetscFunctionReturn(PETSC_SUCCESS);
  line[strcspn(line, "#")] = 0;
  const PetscInt n = PointsNumbers(line, MOST_COLUMNS, x);
  const PetscBool plane = points->columns == 2;
  if (points->columns == 0 && (n == 3 || n == 5)) points->columns = n;
  if (n == 0)
    PetscCall(PointsEndCurve(points));
  else if (n != points->columns)
    PointsRefuseLine(points, number, line,
                     plane ? "two finite numbers, x y"
                           : "finite numbers, x y z in all lines or l m c_x c_y c_z in all lines");
  else {
    PetscCall(ArrayReserve((size_t)(n * (points->n + 1)), &points->xy_capacity, &points->xy));
    PetscCall(PetscArraycpy(points->xy + n * points->n++, x, n));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Read the lines of the file, whose text rank 0 sends up to its end or a zero. */
static PetscErrorCode PointsRead(MPI_Comm comm, Points *p) {
  char *text = NULL, *rest;
  size_t room = 0;
  PetscInt length = 0;
  PetscMPIInt rank;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  FILE *f = rank ? NULL : FileOpen(p->file);
  if (!rank && !f) PointsRefuse(p, "cannot be opened (%s); allowed: a readable text file", strerror(errno));
  if (f && getdelim(&text, &room, 0, f) > 0) length = (PetscInt)strlen(text) + 1;
  if (f && ferror(f)) PointsRefuse(p, "cannot be read; allowed: a readable text file");
  if (f) fclose(f);
  PetscCallMPI(MPI_Bcast(p->error, sizeof(p->error), MPI_CHAR, 0, comm));
  PetscCallMPI(MPI_Bcast(&length, 1, MPIU_INT, 0, comm));
  if (rank) text = (char *)malloc((size_t)length);
  PetscCallMPI(MPI_Bcast(text, (PetscMPIInt)length, MPI_CHAR, 0, comm));
  rest = length ? text : NULL;
  for (PetscInt number = 1; rest && !*p->error; number++) PetscCall(PointsReadLine(strsep(&rest, "\n"), number, p));
  free(text);
  PetscCall(PointsEndCurve(p));
  if (!p->curves && !*p->error) PointsRefuse(p, "0 points; allowed: at least %s", p->least);
  PetscCheck(!*p->error, comm, PETSC_ERR_USER_INPUT, "%s", p->error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Distance up to which two points of a curve are one point. */
static PetscReal PointError(PetscInt n, const PetscReal xy[]) {
  PetscReal size = 0;
  for (PetscInt k = 2; k < 2 * n; k++) size = PetscMax(size, PetscAbsReal(xy[k] - xy[k % 2]));
  return POINT_ERROR * size;
}

/* The kind of a curve of n points. A last point that is the first, or the first a period on, is dropped. */
static CurveKind PointsKind(const Points *p, PetscInt *n, const PetscReal xy[], const CurveNote *note) {
  const PetscReal near = PointError(*n, xy);
  const PetscReal d[2] = {xy[2 * *n - 2] - xy[0], xy[2 * *n - 1] - xy[1]};
  CurveKind kind = {.type = p->period && note->open ? CURVE_OPEN : CURVE_CLOSED};
  if (kind.type == CURVE_OPEN) return kind;
  for (int c = 0; c < 2 && p->period; c++)
    if (p->period[c] > 0 && PetscAbsReal(PetscAbsReal(d[c]) - p->period[c]) < PERIOD_ERROR * p->period[c] &&
        PetscAbsReal(d[1 - c]) < PERIOD_ERROR * p->period[c]) {
      kind.type = CURVE_SPANNING;
      kind.span[c] = d[c] < 0 ? -p->period[c] : p->period[c];
    }
  if (*n > 1 && (kind.type == CURVE_SPANNING || (PetscAbsReal(d[0]) <= near && PetscAbsReal(d[1]) <= near))) (*n)--;
  return kind;
}

/* Reverse the order of the points; a closed curve still starts at the same point. */
static void PointsReverse(const CurveKind *kind, PetscInt n, PetscReal xy[]) {
  for (PetscInt i = kind->type == CURVE_OPEN ? 0 : 1, k = n - 1; i < k; i++, k--)
    for (int c = 0; c < 2; c++) {
      const PetscReal swap = xy[2 * i + c];
      xy[2 * i + c] = xy[2 * k + c];
      xy[2 * k + c] = swap;
    }
}

/* The kind of one curve and the number of its points without a repeated one. Its points are turned counter-clockwise.
   The message of a curve that cannot be used goes into p->error. */
static void PointsClean(Points *p, PetscInt *n, PetscReal xy[], CurveNote *note, CurveKind *kind) {
  const PetscReal near = PointError(*n, xy);
  PetscReal area = 0, length = 0;
  *kind = PointsKind(p, n, xy, note);
  if (*n < 8) PointsRefuse(p, "%" PetscInt_FMT " points; allowed: at least 8 a curve", *n);
  for (PetscInt i = 0; i < *n && !*p->error; i++) {
    const PetscReal *a = &xy[2 * i], *b = &xy[2 * ((i + 1) % *n)];
    const PetscReal d = PetscSqrtReal(PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1]));
    if (d <= near)
      PointsRefuse(p, "point %" PetscInt_FMT " (%g %g) is given twice; allowed: distinct points", i + 1, (double)a[0],
                   (double)a[1]);
    area += 0.5 * (a[0] * b[1] - b[0] * a[1]);
    length += d;
  }
  if (*p->error || kind->type == CURVE_SPANNING) return;
  if (PetscAbsReal(area) < 1e-6 * length * length)
    PointsRefuse(p, "the curve encloses an area of %g; allowed: a %s", (double)area,
                 kind->type == CURVE_OPEN ? "curve off the chord between its ends" : "closed simple curve");
  note->clockwise = area < 0 ? PETSC_TRUE : PETSC_FALSE;
  if (area < 0) PointsReverse(kind, *n, xy);
}

#define DIGEST_START 0xcbf29ce484222325u

/* The hash FNV-1a of what came before, h, and of n numbers. */
static uint64_t PointsDigest(uint64_t h, PetscInt n, const PetscReal x[]) {
  const unsigned char *bytes = (const unsigned char *)x;
  for (size_t k = 0; k < (size_t)n * sizeof(*x); k++) h = (h ^ bytes[k]) * 0x100000001b3u;
  return h;
}

PetscErrorCode CurvesFromFile(MPI_Comm comm, const char option[], const char file[], const PetscReal period[2],
                              PetscInt *curves, Curve **curve, CurveNote **note) {
  Points p = {.columns = 2, .option = option, .file = file, .least = "8 a curve", .period = period};
  uint64_t digest = DIGEST_START;
  PetscFunctionBeginUser;
  PetscCall(PointsRead(comm, &p));
  *curves = p.curves;
  PetscCall(PetscCalloc1(p.curves, curve));
  for (PetscInt k = 0; k < p.curves; k++) {
    const PetscInt first = k ? p.end[k - 1] : 0;
    PetscInt n = p.end[k] - first;
    CurveKind kind;
    const CurveNote *said = &p.note[k];
    const PetscReal says[] = {n, said->open, said->velocity[0], said->velocity[1], said->rotation};
    digest = PointsDigest(PointsDigest(digest, 5, says), 2 * n, p.xy + 2 * first);
    PointsClean(&p, &n, p.xy + 2 * first, &p.note[k], &kind);
    PetscCheck(!*p.error, comm, PETSC_ERR_USER_INPUT, "%s", p.error);
    PetscCall(CurveFromPoints(&kind, n, p.xy + 2 * first, *curve + k));
  }
  for (PetscInt k = 0; k < p.curves; k++) (void)snprintf((*curve)[k].digest, DIGEST, "%016" PRIx64, digest);
  if (note)
    *note = p.note;
  else
    PetscCall(PetscFree(p.note));
  PetscCall(PetscFree(p.end));
  PetscCall(PetscFree(p.xy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PointsFromFile(MPI_Comm comm, const char option[], const char file[], PetscInt *n, PetscReal **xy) {
  Points p = {.columns = 2, .option = option, .file = file, .least = "one"};
  PetscFunctionBeginUser;
  PetscCall(PointsRead(comm, &p));
  PetscCall(PetscFree(p.note));
  PetscCall(PetscFree(p.end));
  *n = p.n;
  *xy = p.xy;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfacesFromFile(MPI_Comm comm, const char option[], const char file[], SurfaceRows *rows) {
  Points p = {.option = option, .file = file, .least = "one"};
  PetscFunctionBeginUser;
  PetscCall(PointsRead(comm, &p));
  PetscCall(PetscFree(p.note));
  *rows = (SurfaceRows){.columns = p.columns, .surfaces = p.curves, .end = p.end, .x = p.xy};
  (void)snprintf(rows->digest, DIGEST, "%016" PRIx64, PointsDigest(DIGEST_START, p.columns * p.n, p.xy));
  PetscFunctionReturn(PETSC_SUCCESS);
}
