#include "markers/streamresponse.h"

typedef struct {
  Markers m;
  DipoleRows dipoles;
  PetscReal alpha;           /* factor of the markers' forces */
  const PetscScalar *f;      /* force on the grid in place of the markers' forces; NULL: none */
  Rows u;                    /* component u of f, with the row above this rank's */
  const PetscScalar *source; /* the dipoles' source on the grid; NULL: none */
  PetscBool measured;        /* the velocity at the markers is not wanted */
  const StreamPast *past;    /* force of earlier states; NULL: none */
  Vec flow;                  /* the flow of the velocity; NULL: not wanted */
  PetscBool add;             /* the flow is added to `flow` */
} Response;

static const PetscScalar *ResponseSpreadForce(void *ctx, Field f, PetscInt j, PetscScalar work[]) {
  const Response *r = (const Response *)ctx;
  (void)PetscArrayzero(work, r->m->grid->columns[f]);
  StencilRowSpread(r->m->rows, f, j, r->alpha, r->m->force, work);
  if (r->dipoles) DipoleRowsAddForce(r->dipoles, f, j, work);
  return work;
}

static const PetscScalar *ResponseGridForce(void *ctx, Field f, PetscInt j, PetscScalar work[]) {
  const Response *r = (const Response *)ctx;
  const PetscScalar *row = f == FIELD_U ? RowAt(&r->u, j) : r->f + GridRowStart(r->m->grid, f, j);
  if (!r->dipoles) return row;
  (void)PetscArraycpy(work, row, r->m->grid->columns[f]);
  DipoleRowsAddForce(r->dipoles, f, j, work);
  return work;
}

static void ResponseVelocity(void *ctx, Field f, PetscInt j, PetscScalar row[]) {
  const Response *r = (const Response *)ctx;
  if (r->dipoles && f == FIELD_U) DipoleRowsAddVelocity(r->dipoles, j, row);
  if (!r->measured) StencilRowInterpolate(r->m->rows, f, j, row, r->m->part);
}

/* One solve. window: forces are zero outside it; NULL: they may be anywhere. */
static PetscErrorCode ResponseSolve(Response *r, Stream stream, const GridWindow *window, Vec U,
                                    StreamMeasures *measures) {
  const Markers m = r->m;
  const StreamRows rows = {.ctx = r,
                           .forced = {window ? window->rows[0] : 0, window ? window->rows[1] : m->grid->rows[FIELD_U]},
                           .wanted = {m->window.rows[0], m->window.rows[1]},
                           .past = r->past,
                           .flow = r->flow,
                           .add = r->add,
                           .force = r->f ? ResponseGridForce : ResponseSpreadForce,
                           .velocity = ResponseVelocity,
                           .mean = {r->dipoles ? r->dipoles->flow : NULL, r->dipoles ? r->dipoles->mean : NULL},
                           .source = r->source};
  PetscScalar *own;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(m->part, 2 * (m->layout->M + m->points)));
  PetscCall(StreamSolve(stream, &rows, measures));
  if (r->measured) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(U, &own));
  PetscCall(LayoutSum(m->layout, 2, m->part, own));
  PetscCall(VecRestoreArray(U, &own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ResponseToForces(Response *r, Stream stream, Vec F, Vec U, StreamMeasures *measures) {
  const Markers m = r->m;
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(m->respond, 0, 0, 0, 0));
  PetscCall(LayoutGatherVec(m->layout, F, m->force));
  PetscCall(ResponseSolve(r, stream, &m->window, U, measures));
  PetscCall(PetscLogEventEnd(m->respond, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MarkersRespond(Markers m, Stream stream, DipoleRows dipoles, PetscReal alpha, Vec F, Vec U) {
  Response r = {.m = m, .dipoles = dipoles, .alpha = alpha};
  PetscFunctionBeginUser;
  PetscCall(ResponseToForces(&r, stream, F, U, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MarkersAddFlow(Markers m, Stream stream, PetscReal alpha, Vec F, Vec U, Vec flow,
                              StreamMeasures *measures) {
  Response r = {.m = m, .alpha = alpha, .flow = flow, .add = PETSC_TRUE};
  PetscFunctionBeginUser;
  PetscCall(ResponseToForces(&r, stream, F, U, measures));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MarkersFollow(Markers m, Stream stream, DipoleRows dipoles, const Forcing *f, const StreamPast *past,
                             Vec U, StreamMeasures *measures) {
  const Vec source = dipoles ? f->source : NULL;
  Response r = {.m = m, .dipoles = dipoles, .measured = U ? PETSC_FALSE : PETSC_TRUE, .past = past};
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(m->respond, 0, 0, 0, 0));
  if (past) r.flow = past->made;
  PetscCall(VecGetArrayRead(f->values, &r.f));
  if (source) PetscCall(VecGetArrayRead(source, &r.source));
  PetscCall(GridRows(m->grid, FIELD_U, r.f, &r.u));
  PetscCall(ResponseSolve(&r, stream, f->everywhere ? NULL : &f->window, U, measures));
  if (source) PetscCall(VecRestoreArrayRead(source, &r.source));
  PetscCall(VecRestoreArrayRead(f->values, &r.f));
  PetscCall(PetscLogEventEnd(m->respond, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
