/* A background flow by formulas of the coordinates and t, read by muParser. */
#include "scene/flow.h"
#include "base/agree.h"
#include <muParserDLL.h>

static const char *const names[3] = {"-flow_u", "-flow_v", "-flow_w"}, *const coordinates[3] = {"x", "y", "z"};

typedef struct {
  PetscInt dim;
  muParserHandle_t parser[3]; /* of u_x, u_y and u_z */
  muFloat_t x[3], t;          /* the variables */
} Formulas;

/* A PetvesFlow: muParser gives infinity or no number where a formula has no value. */
static PetscErrorCode FormulaVelocities(PetscReal t, PetscInt n, const PetscReal X[], PetscReal u[], void *ctx) {
  Formulas *f = (Formulas *)ctx;
  f->t = t;
  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt d = 0; d < f->dim; d++) f->x[d] = X[f->dim * i + d];
    for (PetscInt d = 0; d < f->dim; d++) u[f->dim * i + d] = mupEval(f->parser[d]);
  }
  return PETSC_SUCCESS;
}

/* Read the formula of a component. wrong: what is wrong with it, empty when nothing is. */
static void FormulaRead(Formulas *f, int component, const char text[], char wrong[], size_t length) {
  const muParserHandle_t parser = mupCreate(muBASETYPE_FLOAT);
  int values = 0;
  f->parser[component] = parser;
  for (PetscInt d = 0; d < f->dim; d++) mupDefineVar(parser, coordinates[d], &f->x[d]);
  mupDefineVar(parser, "t", &f->t);
  mupDefineConst(parser, "pi", PETSC_PI);
  mupSetExpr(parser, text);
  (void)mupEvalMulti(parser, &values);
  *wrong = 0;
  if (mupError(parser)) {
    const char *const what = mupGetErrorMsg(parser);
    const size_t n = strlen(what);
    (void)snprintf(wrong, length, "%.*s", (int)(n && what[n - 1] == '.' ? n - 1 : n), what);
  } else if (values != 1) {
    (void)snprintf(wrong, length, "%d formulas, with commas between them", values);
  }
}

PetscErrorCode FlowReadFormulas(MPI_Comm comm, PetscInt dim, Flow *flow) {
  Formulas *f;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  flow->function = FormulaVelocities;
  flow->ctx = f;
  f->dim = dim;
  for (int k = 0; k < dim; k++) {
    char wrong[PETVES_MAX_MESSAGE / 2];
    FormulaRead(f, k, flow->formula[k], wrong, sizeof(wrong));
    PetvesCheck(!*wrong, comm,
                "%s %.100s: %s; allowed: a formula of x, y%s and t, in quotes, of numbers, pi, + - * / ^ ( ) and "
                "functions like sin, exp, sqrt (docs/scenes.md)",
                names[k], flow->formula[k], wrong, dim == 3 ? ", z" : "");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FlowDropFormulas(Flow *flow) {
  Formulas *f = flow->type == FLOW_FORMULA ? (Formulas *)flow->ctx : NULL;
  PetscFunctionBeginUser;
  for (int k = 0; f && k < f->dim; k++)
    if (f->parser[k]) mupRelease(f->parser[k]);
  PetscCall(PetscFree(f));
  flow->ctx = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}
