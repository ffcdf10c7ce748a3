#include "mobility/mobility.h"
#include "markers/streamresponse.h"

/* Inner fluid and markers. E smooths the grid's velocity, which the spreading has smoothed, by `smoothed` times its
   Laplacian (length^2). */
static PetscErrorCode CreateMarkers(Mobility m, const MobilitySetting *setting, PetscReal *smoothed) {
  const Kernel *k = KernelFind(setting->kernel);
  const PetscReal cells = k ? (KernelSecondMoment(k->along) + 3 * KernelSecondMoment(k->across)) / 4 - 1. / 8 : 0;
  const Obstacles o = m->bodies->obstacles;
  const Grid g = m->fluid->grid;
  PetscFunctionBeginUser;
  *smoothed = cells * PetscSqr(g->h);
  if (!m->fluid->steady && o && o->free->M) PetscCall(InnerFluidCreate(o, g->h, *smoothed, &m->inner));
  PetscCall(MarkersCreate(g, m->bodies->layout, setting->kernel, setting->near == NEAR_EXACT,
                          m->inner ? m->inner->n : 0, m->inner ? m->inner->X : NULL, &m->markers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The markers' velocities beside the grid's: near field, double layer, lag. */
static PetscErrorCode CreateLayers(Mobility m, const MobilitySetting *setting, PetscReal smoothed) {
  PetscFunctionBeginUser;
  if (setting->near != NEAR_EXACT || !m->bodies->layout->bodies) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(NearFieldCreate(m->markers, m->bodies, m->fluid->nu, &m->near));
  if (setting->box_part) PetscCall(NearFieldAddBoxPart(m->near, setting->spec));
  if (setting->lag) m->lag = smoothed / m->fluid->nu;
  if (!setting->ratio) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DoubleLayerCreate(m->near, setting->ratio, &m->contrast));
  if (setting->box_part) PetscCall(DoubleLayerAddBoxPart(m->contrast, setting->spec));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityCreate(Fluid fluid, Bodies bodies, const MobilitySetting *setting, Mobility *out) {
  PetscReal smoothed;
  Mobility m;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->fluid = fluid;
  m->bodies = bodies;
  PetscCall(CreateMarkers(m, setting, &smoothed));
  PetscCall(CreateLayers(m, setting, smoothed));
  if (!setting->solver) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LayoutCreateVec(bodies->layout, 2, &m->F));
  if (m->contrast) PetscCall(LayoutCreateVec(bodies->membrane->layout, 2, &m->G));
  if (fluid->grid->free) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StokesCreate(fluid, &m->stokes));
  m->stream = StokesStream(m->stokes);
  if (m->contrast) PetscCall(DipoleRowsCreate(fluid->grid, fluid->nu, &m->dipoles));
  if (!fluid->steady) PetscCall(VecDuplicate(m->F, &m->flow));
  if (!m->inner) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StreamFlowsCreateVec(m->stream->flows, &m->sum));
  PetscCall(DMCreateGlobalVector(fluid->grid->velocity, &m->field));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityDestroy(Mobility *mobility) {
  Mobility m = *mobility;
  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DipoleRowsDestroy(&m->dipoles));
  PetscCall(StokesDestroy(&m->stokes));
  PetscCall(DoubleLayerDestroy(&m->contrast));
  PetscCall(NearFieldDestroy(&m->near));
  PetscCall(MarkersDestroy(&m->markers));
  PetscCall(InnerFluidDestroy(&m->inner));
  PetscCall(VecDestroy(&m->sum));
  PetscCall(VecDestroy(&m->field));
  PetscCall(VecDestroy(&m->F));
  PetscCall(VecDestroy(&m->G));
  PetscCall(VecDestroy(&m->flow));
  PetscCall(PetscFree(*mobility));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityPlace(Mobility m, PetscReal a0, Vec X) {
  PetscFunctionBeginUser;
  PetscCall(FluidSetTimeCoefficient(m->fluid, a0));
  if (!m->bodies->layout->bodies) PetscFunctionReturn(PETSC_SUCCESS);
  if (m->inner) InnerFluidPlace(m->inner);
  PetscCall(MarkersPlace(m->markers, X));
  if (m->near) PetscCall(NearFieldPlace(m->near));
  if (m->contrast) PetscCall(DoubleLayerPlace(m->contrast));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityAddLayers(Mobility m, Vec F, Vec G, PetscScalar U[]) {
  const PetscScalar *a;
  PetscFunctionBeginUser;
  if (m->near && F) {
    PetscCall(VecGetArrayRead(F, &a));
    PetscCall(NearFieldApply(m->near, -1, a, U));
    PetscCall(VecRestoreArrayRead(F, &a));
  }
  if (m->contrast && G) PetscCall(DoubleLayerApply(m->contrast, 1, G, U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The dipoles of the motion G as rows of the stream, with their force where the forcing has not got it. */
static PetscErrorCode MobilitySetDipoles(Mobility m, Vec G, PetscBool own) {
  PetscFunctionBeginUser;
  if (m->contrast) PetscCall(DoubleLayerRows(m->contrast, G, own, StreamProfile(m->stream), m->dipoles));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U += what the grid does not give. */
static PetscErrorCode MobilityFinish(Mobility m, Vec F, Vec G, Vec U) {
  PetscScalar *u;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(U, &u));
  PetscCall(MobilityAddLayers(m, F, G, u));
  PetscCall(VecRestoreArray(U, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* alpha INT_inside R^T u of the u that E has passed last. */
static PetscErrorCode MobilityAddInner(Mobility m, InnerPart part, PetscReal alpha) {
  PetscFunctionBeginUser;
  if (m->inner) PetscCall(InnerFluidAdd(m->inner, part, alpha, m->markers->part + 2 * m->bodies->layout->M));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityApply(Mobility m, Vec F, Vec G, Vec U) {
  PetscFunctionBeginUser;
  if (m->stokes) {
    PetscCall(MobilitySetDipoles(m, G, PETSC_TRUE));
    PetscCall(MarkersRespond(m->markers, m->stream, m->dipoles, -1 / PetscSqr(m->fluid->grid->h), F, U));
    PetscCall(VecScale(U, MobilityGridPart(m, m->fluid->alpha)));
    PetscCall(MobilityAddInner(m, INNER_PRODUCT, m->fluid->alpha));
  } else
    PetscCall(VecSet(U, 0));
  PetscCall(MobilityFinish(m, F, G, U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityBegin(Mobility m, const MobilityKnown *q) {
  const Grid g = m->fluid->grid;
  PetscFunctionBeginUser;
  m->known = q;
  m->added = 0;
  m->measures = (StreamMeasures){0};
  if (m->inner) { /* N(u*) */
    PetscCall(MarkersInterpolate(m->markers, q->f->values, NULL));
    PetscCall(MobilityAddInner(m, INNER_BEGIN, -1));
  }
  PetscCall(q->F ? VecCopy(q->F, m->F) : VecSet(m->F, 0));
  if (m->contrast) PetscCall(q->G ? VecCopy(q->G, m->G) : VecSet(m->G, 0));
  if (!q->F || g->free) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForcingSpread(q->f, m->markers, -1 / PetscSqr(g->h), q->F));
  if (q->outside && !g->wall[0] && !g->wall[1]) PetscCall(ForcingRemoveMean(q->f, m->fluid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In fluid with inertia: the flow of the step gets that of the states before and of all forces (the first time) or that
   of the forces F; U = E u. What is measured is then a sum; that of divergences is a bound. */
static PetscErrorCode MobilityFollowFlow(Mobility m, Vec F, Vec U) {
  const StreamPast *past = m->known->past;
  StreamMeasures more;
  PetscFunctionBeginUser;
  if (m->added == 1) {
    PetscCall(MarkersFollow(m->markers, m->stream, NULL, m->known->f, past, m->flow, &m->measures));
    if (m->inner) { /* alpha u - uhat */
      PetscCall(VecAXPBY(m->sum, m->fluid->alpha, 0, past->made));
      for (PetscInt j = 0; j < past->count; j++) PetscCall(VecAXPY(m->sum, -past->weight[j], past->flow[j]));
      PetscCall(StreamFlowsVelocity(m->stream->flows, m->sum, m->field));
      PetscCall(MarkersInterpolate(m->markers, m->field, NULL));
      PetscCall(MobilityAddInner(m, INNER_ADD, 1));
    }
  } else {
    PetscCall(MarkersAddFlow(m->markers, m->stream, -1 / PetscSqr(m->fluid->grid->h), F, U, past->made, &more));
    PetscCall(MobilityAddInner(m, INNER_ADD, m->fluid->alpha));
    PetscCall(VecAXPY(m->flow, MobilityGridPart(m, m->fluid->alpha), U));
    m->measures.divergence += more.divergence;
    m->measures.slip += more.slip;
    m->measures.pressure += more.pressure;
  }
  PetscCall(VecCopy(m->flow, U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityAdd(Mobility m, Vec F, Vec G, Vec U) {
  PetscFunctionBeginUser;
  m->added++;
  PetscCall(VecAXPY(m->F, 1, F));
  if (m->contrast) PetscCall(VecAXPY(m->G, 1, G));
  if (m->stokes) {
    PetscCall(ForcingSpread(m->known->f, m->markers, -1 / PetscSqr(m->fluid->grid->h), F));
    if (m->contrast) /* the first time with what is known of the motion */
      PetscCall(DoubleLayerSpread(m->contrast, m->added == 1 ? m->G : G, m->known->f));
    if (m->known->past)
      PetscCall(MobilityFollowFlow(m, F, U));
    else { /* E u of the whole forcing */
      PetscCall(MobilitySetDipoles(m, m->G, PETSC_FALSE));
      PetscCall(MarkersFollow(m->markers, m->stream, m->dipoles, m->known->f, NULL, U, &m->measures));
      PetscCall(VecScale(U, MobilityGridPart(m, m->fluid->alpha)));
    }
  } else
    PetscCall(VecSet(U, 0));
  PetscCall(MobilityFinish(m, m->F, m->G, U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In a box that is periodic both ways, and in a channel without flux, the solve leaves u without a mean, which dipoles
   have. */
static PetscErrorCode AddMean(Mobility m, const PetscReal mean[2], Vec u) {
  const Grid g = m->fluid->grid;
  PetscScalar *a;
  PetscFunctionBeginUser;
  if (!m->contrast) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscReal *profile = StreamProfile(m->stream);
  if (g->wall[0] || (g->wall[1] && !profile)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(u, &a));
  for (int f = FIELD_U; f <= (g->wall[1] ? FIELD_U : FIELD_V); f++)
    for (PetscInt j = 0; j < g->rows[f]; j++)
      for (PetscInt i = 0; i < g->n[0]; i++)
        a[GridRowStart(g, (Field)f, j) + i] += mean[f] * (profile ? profile[g->first + j] : 1);
  PetscCall(VecRestoreArray(u, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityFields(Mobility m, const Forcing *f, Vec u, Vec p) {
  PetscFunctionBeginUser;
  if (!m->stokes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StokesSolve(m->stokes, f->values, f->source, u, p));
  PetscCall(AddMean(m, f->mean, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityPressure(Mobility m, const Forcing *f, Vec u, Vec p) {
  PetscFunctionBeginUser;
  PetscCall(StokesPressure(m->stokes, f->values, u, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}
