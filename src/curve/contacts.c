#include "curve/contacts.h"
#include "curve/crossing.h"
#include <stdlib.h>

#define CONTACT_FINER 8 /* times as many points where smooth curves are near */

typedef struct {
  const CurveSet *set;
  PetscReal reach;
  PetscReal seam;        /* an image of a point is farther than this from the point */
  PetscInt soft;         /* curves that may touch themselves */
  const PetscReal *ds;   /* [soft] their point spacings */
  PetscInt *curve;       /* [points] the curve that a point is on */
  CurveContact *contact; /* [count] */
  PetscInt count;
  size_t capacity;
  PetscErrorCode error;
} ContactSearch;

/* Number of the point `steps` from point k along its curve. */
static PetscInt ContactStep(const ContactSearch *s, PetscInt k, PetscInt steps) {
  const PetscInt *start = s->set->start + s->curve[k], n = start[1] - start[0];
  return start[0] + (k - start[0] + steps + n) % n;
}

/* Whether the edge from q on is twice the reach and two edges or more from point p along their curve. */
static PetscBool ContactFar(const ContactSearch *s, PetscInt p, PetscInt q) {
  const PetscInt *start = s->set->start + s->curve[p], n = start[1] - start[0], steps = (q - p + n) % n;
  const PetscReal ds = s->ds[s->curve[p]];
  return PetscMin(steps, n - 1 - steps) * ds >= 2 * PetscMax(s->reach, ds) ? PETSC_TRUE : PETSC_FALSE;
}

/* The outside at the point `steps` from point k of curve v; `out` stays at the end of an open curve. */
static void ContactOutside(const CurveSet *set, PetscInt v, PetscInt k, PetscInt steps, PetscReal out[2]) {
  PetscReal P[2], Q[2];
  if (!CurveSetWalk(set, v, k, steps - 1, P) || !CurveSetWalk(set, v, k, steps + 1, Q)) return;
  out[0] = Q[1] - P[1];
  out[1] = P[0] - Q[0];
}

/* The contact of point p with the edge that starts at q or, with `back`, ends at q, q moved by `shift`; false where an
   open curve ends and, of p's own curve, near p along it. At an end of the edge the outside is that of both edges that
   meet there. */
static PetscBool ContactMeasure(const ContactSearch *s, PetscInt p, PetscInt q, PetscBool back, PetscBool own,
                                const PetscReal shift[2], CurveContact *c) {
  const PetscInt v = s->curve[q], a = back ? -1 : 0;
  PetscReal A[2], B[2], d[2], edge[2], size;
  if (!CurveSetWalk(s->set, v, q, a, A) || !CurveSetWalk(s->set, v, q, a + 1, B)) return PETSC_FALSE;
  for (int k = 0; k < 2; k++) {
    edge[k] = B[k] - A[k];
    d[k] = s->set->X[2 * p + k] - A[k] - shift[k];
  }
  const PetscReal square = edge[0] * edge[0] + edge[1] * edge[1];
  const PetscReal along = square > 0 ? (d[0] * edge[0] + d[1] * edge[1]) / square : 0;
  *c = (CurveContact){.point = p, .edge = {ContactStep(s, q, a), ContactStep(s, q, a + 1)}, .curve = {s->curve[p], v}};
  if (own && !ContactFar(s, p, c->edge[0])) return PETSC_FALSE;
  PetscReal out[2] = {edge[1], -edge[0]};
  c->at = PetscMax(0, PetscMin(1, along));
  if (c->at == 0 || c->at == 1) ContactOutside(s->set, v, q, c->at == 1 ? a + 1 : a, out);
  for (int k = 0; k < 2; k++) c->normal[k] = d[k] - c->at * edge[k];
  c->distance = PetscSqrtReal(PetscSqr(c->normal[0]) + PetscSqr(c->normal[1]));
  if ((c->normal[0] * out[0] + c->normal[1] * out[1] < 0) != (CurveSetKind(s->set, s->curve[p]).around == v + 1))
    c->distance = -c->distance;
  if (own) {
    ContactOutside(s->set, v, p, 0, out);
    c->type = c->normal[0] * out[0] + c->normal[1] * out[1] > 0 ? CONTACT_INSIDE : CONTACT_OUTSIDE;
    c->distance = PetscAbsReal(c->distance);
  }
  size = PetscAbsReal(c->distance) > 0 ? c->distance : PetscSqrtReal(PetscSqr(out[0]) + PetscSqr(out[1]));
  for (int k = 0; k < 2; k++) c->normal[k] = (PetscAbsReal(c->distance) > 0 ? c->normal[k] : out[k]) / size;
  return PETSC_TRUE;
}

/* Keep contact c if it is within reach. */
static PetscErrorCode ContactOffer(ContactSearch *s, const CurveContact *c) {
  PetscFunctionBeginUser;
  if (PetscAbsReal(c->distance) >= s->reach) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ArrayReserve((size_t)(s->count + 1), &s->capacity, &s->contact));
  s->contact[s->count++] = *c;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The order of the groups of contacts of which one is kept: by point, by curve, by type. */
static int ContactGroup(const CurveContact *a, const CurveContact *b) {
  if (a->point != b->point) return a->point < b->point ? -1 : 1;
  if (a->curve[1] != b->curve[1]) return a->curve[1] < b->curve[1] ? -1 : 1;
  return (a->type > b->type) - (a->type < b->type);
}

/* The order of contacts: by group, then from near to far. */
static int ContactOrder(const void *first, const void *second) {
  const CurveContact *a = (const CurveContact *)first, *b = (const CurveContact *)second;
  const PetscReal x = PetscAbsReal(a->distance), y = PetscAbsReal(b->distance);
  const int group = ContactGroup(a, b);
  return group ? group : (x > y) - (x < y);
}

/* Offer the contacts of points i and j, the image of j being d from i, each with the two edges at the other. own: they
   are of one curve, and no image. */
static PetscErrorCode ContactOfferBoth(ContactSearch *s, PetscInt i, PetscInt j, PetscBool own, const PetscReal d[2]) {
  const PetscInt pair[2][2] = {{i, j}, {j, i}};
  PetscFunctionBeginUser;
  for (int side = 0; side < 2; side++) {
    const PetscInt p = pair[side][0], q = pair[side][1];
    PetscReal shift[2];
    for (int k = 0; k < 2; k++) shift[k] = (side ? -d[k] : d[k]) - (s->set->X[2 * q + k] - s->set->X[2 * p + k]);
    for (int back = 0; back < 2; back++) {
      CurveContact c;
      if (ContactMeasure(s, p, q, back ? PETSC_TRUE : PETSC_FALSE, own, shift, &c)) PetscCall(ContactOffer(s, &c));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool ContactNear(void *context, PetscInt i, PetscInt j, const PetscReal d[2]) {
  ContactSearch *s = (ContactSearch *)context;
  const PetscReal *X = s->set->X, x = d[0] - (X[2 * j] - X[2 * i]), y = d[1] - (X[2 * j + 1] - X[2 * i + 1]);
  const PetscBool own = s->curve[i] == s->curve[j] && PetscAbsReal(x) + PetscAbsReal(y) < s->seam ? PETSC_TRUE
                                                                                                  : PETSC_FALSE;
  if (PetscMin(s->curve[i], s->curve[j]) >= s->set->moving) return PETSC_FALSE;
  if (own && s->curve[i] >= s->soft) return PETSC_FALSE;
  s->error = ContactOfferBoth(s, i, j, own, d);
  return s->error ? PETSC_TRUE : PETSC_FALSE;
}

#define FEW_CURVES 32 /* in most scenes with more curves their rectangles overlap */

/* Whether the rectangles around closed curves show that each curve that moves is farther than reach from all others,
   and from its own images or every image of its points more than half a period from the point. */
static PetscBool CurvesAreApart(const CurveSet *set, PetscReal reach) {
  PetscReal box[FEW_CURVES][4];
  if (set->curves > FEW_CURVES) return PETSC_FALSE;
  for (PetscInt v = 0; v < set->curves; v++) {
    if (CurveSetKind(set, v).type == CURVE_SPANNING) return PETSC_FALSE;
    (void)PetscMemcpy(box[v], (PetscReal[4])CURVE_NOWHERE, sizeof(box[v]));
    CurveBounds(set->start[v + 1] - set->start[v], set->X + 2 * set->start[v], box[v]);
    for (PetscInt w = 0; w <= v && w < set->moving; w++) {
      PetscBool apart = w == v ? PETSC_TRUE : PETSC_FALSE;
      for (int d = 0; d < 2; d++) {
        const PetscReal *a = box[v] + 2 * d, *b = box[w] + 2 * d, period = set->period[d], extent = a[1] - a[0];
        const PetscReal middle = 0.5 * (b[0] + b[1] - a[0] - a[1]),
                        images = period > 0 ? period * rint(middle / period) : 0;
        if (w < v && PetscAbsReal(middle - images) - 0.5 * (extent + b[1] - b[0]) > reach) apart = PETSC_TRUE;
        if (w == v && period > 0 && extent + reach >= period && 2 * extent >= period) apart = PETSC_FALSE;
      }
      if (!apart) return PETSC_FALSE;
    }
  }
  return PETSC_TRUE;
}

PetscErrorCode CurveContacts(const CurveSet *set, PetscReal reach, PetscInt soft, const PetscReal ds[], PetscInt *n,
                             CurveContact **contacts) {
  const PetscInt points = set->start[set->curves], *part = set->part;
  const PetscInt first[2] = {part ? set->start[part[0]] : 0, part ? set->start[part[1]] : points};
  /* a point nearer than reach to an edge is nearer than this to one end of the edge */
  const PetscReal apart = PetscHypotReal(reach, 0.5 * CurveLongestEdge(set));
  ContactSearch s = {.set = set, .reach = reach, .seam = PETSC_MAX_REAL, .soft = soft, .ds = ds};
  PetscFunctionBeginUser;
  *n = 0;
  *contacts = NULL;
  if (!soft && CurvesAreApart(set, apart)) PetscFunctionReturn(PETSC_SUCCESS);
  for (int d = 0; d < 2; d++)
    if (set->period[d] > 0) s.seam = PetscMin(s.seam, 0.5 * set->period[d]);
  PetscCall(PetscMalloc1(points, &s.curve));
  for (PetscInt v = 0; v < set->curves; v++)
    for (PetscInt k = set->start[v]; k < set->start[v + 1]; k++) s.curve[k] = v;
  PetscCall(PairsWithin(points, set->X, first, set->period, apart, ContactNear, &s));
  PetscCall(s.error);
  if (s.count) qsort(s.contact, (size_t)s.count, sizeof(*s.contact), ContactOrder);
  for (PetscInt k = 0; k < s.count; k++)
    if (!*n || ContactGroup(&s.contact[k], &s.contact[*n - 1])) s.contact[(*n)++] = s.contact[k];
  *contacts = s.contact;
  PetscCall(PetscFree(s.curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The order of gaps: by pair, then by distance. */
static int GapOrder(const void *first, const void *second) {
  const CurveGap *a = (const CurveGap *)first, *b = (const CurveGap *)second;
  for (int k = 0; k < 2; k++)
    if (a->curve[k] != b->curve[k]) return a->curve[k] < b->curve[k] ? -1 : 1;
  return (a->distance > b->distance) - (a->distance < b->distance);
}

/* The gaps of the polygons. */
static PetscErrorCode PolygonGaps(const CurveSet *set, PetscReal reach, PetscInt *n, CurveGap **gaps) {
  CurveContact *c;
  PetscInt count, kept = 0;
  PetscFunctionBeginUser;
  PetscCall(CurveContacts(set, reach, 0, NULL, &count, &c));
  PetscCall(PetscMalloc1(count, gaps));
  for (PetscInt k = 0; k < count; k++) {
    const PetscInt v = c[k].curve[0], w = c[k].curve[1];
    (*gaps)[k] = (CurveGap){.curve = {PetscMin(v, w), PetscMax(v, w)}, .distance = c[k].distance};
  }
  PetscCall(PetscFree(c));
  if (count) qsort(*gaps, (size_t)count, sizeof(**gaps), GapOrder);
  for (PetscInt k = 0; k < count; k++)
    if (!kept || (*gaps)[k].curve[0] != (*gaps)[kept - 1].curve[0] || (*gaps)[k].curve[1] != (*gaps)[kept - 1].curve[1])
      (*gaps)[kept++] = (*gaps)[k];
  *n = kept;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Replace the gap of two polygons by that of the curves, which bulge beyond their chords. */
static PetscErrorCode GapRefine(const CurveSet *set, PetscReal edge, CurveGap *gap) {
  const PetscInt two = gap->curve[0] == gap->curve[1] ? 1 : 2;
  PetscInt count;
  CurveGap *found;
  CurveFine fine;
  PetscFunctionBeginUser;
  PetscCall(CurveFineCreate(set, two, gap->curve, CONTACT_FINER, &fine));
  PetscCall(PolygonGaps(&fine.set, PetscAbsReal(gap->distance) + 0.5 * edge, &count, &found));
  for (PetscInt k = 0; k < count; k++)
    if (two == 1 || found[k].curve[0] != found[k].curve[1]) gap->distance = found[k].distance;
  PetscCall(PetscFree(found));
  PetscCall(CurveFineDestroy(&fine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurveGaps(const CurveSet *set, PetscReal reach, PetscInt *n, CurveGap **gaps) {
  const PetscReal edge = CurveLongestEdge(set);
  PetscInt kept = 0;
  PetscFunctionBeginUser;
  PetscCall(PolygonGaps(set, set->smooth ? reach + 0.25 * edge : reach, n, gaps));
  for (PetscInt k = 0; k < *n; k++) {
    if (set->smooth && (*gaps)[k].distance < 0.5 * edge) PetscCall(GapRefine(set, edge, &(*gaps)[k]));
    if ((*gaps)[k].distance < reach) (*gaps)[kept++] = (*gaps)[k];
  }
  *n = kept;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurveLeastGap(const CurveSet *set, PetscReal *distance) {
  const PetscReal edge = CurveLongestEdge(set), *period = set->period;
  PetscReal most = 0, around[4] = CURVE_NOWHERE;
  PetscFunctionBeginUser;
  *distance = NAN;
  CurveBounds(set->start[set->curves], set->X, around);
  for (int d = 0; d < 2; d++)
    most += period[d] > 0 ? period[d] : around[2 * d + 1] - around[2 * d]; /* no two points are farther apart */
  if (set->curves < 2 && period[0] <= 0 && period[1] <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscReal reach = 2 * edge; PetscIsNanReal(*distance); reach *= 4) {
    CurveGap *gaps, *least = NULL;
    PetscInt n;
    PetscCall(PolygonGaps(set, reach, &n, &gaps));
    for (PetscInt k = 0; k < n; k++)
      if (!least || gaps[k].distance < least->distance) least = &gaps[k];
    if (least && set->smooth) PetscCall(GapRefine(set, edge, least));
    if (least) *distance = least->distance;
    PetscCall(PetscFree(gaps));
    if (reach > most) break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal CurveWallGap(PetscInt n, const PetscReal X[], const CurveRoom *room, PetscInt *side) {
  PetscReal least = PETSC_MAX_REAL;
  *side = -1;
  for (int at = 0; at < 4; at++)
    for (PetscInt k = 0; k < n && room->wall[at / 2]; k++) {
      const PetscReal gap = (at % 2 ? -1 : 1) * (X[2 * k + at / 2] - room->box[at]);
      if (gap >= least) continue;
      least = gap;
      *side = at;
    }
  return least;
}

/* Take the film between v and w if it is thinner than `film`. */
static void FilmThinner(CurveFilm *film, PetscReal gap, PetscReal ds, PetscInt v, PetscInt w) {
  if (gap <= 0 || gap >= film->spacings * ds) return;
  *film = (CurveFilm){.thickness = gap, .spacings = gap / ds, .pair = {v, w}};
}

PetscErrorCode CurveThinnestFilm(const CurveSet *set, const PetscReal ds[], const CurveRoom *room, PetscReal most,
                                 CurveFilm *film) {
  const PetscInt *start = set->start;
  PetscReal widest = 0;
  CurveGap *gap;
  PetscInt n, side;
  PetscFunctionBeginUser;
  *film = (CurveFilm){.spacings = most};
  for (PetscInt v = 0; v < set->curves; v++) widest = PetscMax(widest, ds[v]);
  PetscCall(CurveGaps(set, most * widest, &n, &gap));
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt v = gap[k].curve[0], w = gap[k].curve[1];
    FilmThinner(film, gap[k].distance, PetscMax(ds[v], ds[w]), v, w);
  }
  PetscCall(PetscFree(gap));
  for (PetscInt v = set->part ? set->part[0] : 0; v < (set->part ? set->part[1] : set->moving); v++) {
    const PetscReal wall = CurveWallGap(start[v + 1] - start[v], set->X + 2 * start[v], room, &side);
    FilmThinner(film, wall, ds[v], v, -1 - side);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
