/* A background flow by formulas of x, y and t, read by muParser. */
#include "scene/flow.h"
#include "base/agree.h"
#include <muParserDLL.h>

static const char *const names[2] = {"-flow_u", "-flow_v"};

typedef struct {
  muParserHandle_t parser[2]; /* of u_x and u_y */
  muFloat_t x, y, t;          /* the variables */
} Formulas;

/* A PetvesFlow: muParser gives infinity or no number where a formula has no value. */
static PetscErrorCode FormulaVelocities(PetscReal t, PetscInt n, const PetscReal X[], PetscReal u[], void *ctx) {
  Formulas *f = (Formulas *)ctx;
  for (PetscInt k = 0; k < 2 * n; k++) {
    f->x = X[k - k % 2];
    f->y = X[k - k % 2 + 1];
    f->t = t;
    u[k] = mupEval(f->parser[k % 2]);
  }
  return PETSC_SUCCESS;
}

/* Read the formula of a component. wrong: what is wrong with it, empty when nothing is. */
static void FormulaRead(Formulas *f, int component, const char text[], char wrong[], size_t length) {
  const muParserHandle_t parser = mupCreate(muBASETYPE_FLOAT);
  int values = 0;
  f->parser[component] = parser;
  mupDefineVar(parser, "x", &f->x);
  mupDefineVar(parser, "y", &f->y);
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

PetscErrorCode FlowReadFormulas(MPI_Comm comm, Flow *flow) {
  Formulas *f;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  flow->function = FormulaVelocities;
  flow->ctx = f;
  for (int k = 0; k < 2; k++) {
    char wrong[PETVES_MAX_MESSAGE / 2];
    FormulaRead(f, k, flow->formula[k], wrong, sizeof(wrong));
    PetvesCheck(!*wrong, comm,
                "%s %.100s: %s; allowed: a formula of x, y and t, in quotes, of numbers, pi, + - * / ^ ( ) and "
                "functions like sin, exp, sqrt (docs/scenes.md)",
                names[k], flow->formula[k], wrong);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FlowDropFormulas(Flow *flow) {
  Formulas *f = flow->type == FLOW_FORMULA ? (Formulas *)flow->ctx : NULL;
  PetscFunctionBeginUser;
  for (int k = 0; f && k < 2; k++)
    if (f->parser[k]) mupRelease(f->parser[k]);
  PetscCall(PetscFree(f));
  flow->ctx = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}
