/* Misspelt and unused options: found, named, and the nearest known option suggested. */
#include "options/options.h"

/* Options that PETSc itself reads only while it finalises. */
static const char *const late[] = {"options_left",    "objects_dump", "malloc_dump",    "malloc_view",
                                   "memory_view",     "log_view",     "log_trace",      "log_summary",
                                   "log_view_memory", "mpi_finalize", "on_error_abort", "options_view"};

/* Solver options that PETSc reads only when it solves, after the check. */
static PetscBool ReadWhileSolving(const char *name) {
  const char *const parts[] = {"_ksp_view", "_ksp_converged_reason", "_ksp_converged_rate", "_mat_mumps_", "_mat_view"};
  for (size_t i = 0; i < sizeof(parts) / sizeof(parts[0]); i++)
    if (strstr(name, parts[i])) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Edit distance of two short words (Levenshtein). */
static PetscInt Distance(const char *a, const char *b) {
  PetscInt row[128];
  const PetscInt n = (PetscInt)PetscMin(strlen(b), (size_t)127);
  for (PetscInt j = 0; j <= n; j++) row[j] = j;
  for (PetscInt i = 1; a[i - 1]; i++) {
    PetscInt corner = row[0];
    row[0] = i;
    for (PetscInt j = 1; j <= n; j++) {
      const PetscInt change = corner + (a[i - 1] != b[j - 1]);
      corner = row[j];
      row[j] = PetscMin(change, 1 + PetscMin(row[j], row[j - 1]));
    }
  }
  return row[n];
}

static const char *Nearest(const OptionTable *t, const char *const others[], const char *name) {
  const char *best = "";
  PetscInt least = PETSC_MAX_INT;
  for (PetscInt i = 0; i < t->n; i++)
    if (Distance(name, t->row[i].name) < least) least = Distance(name, t->row[i].name), best = t->row[i].name;
  for (PetscInt i = 0; others[i]; i++)
    if (Distance(name, others[i]) < least) least = Distance(name, others[i]), best = others[i];
  return best;
}

PetscErrorCode OptionsCheckUnused(const OptionTable *t, const char *const others[]) {
  PetscInt n = 0;
  char **names, **values, unused[PETSC_MAX_PATH_LEN] = "", value[PETSC_MAX_PATH_LEN] = "";
  const PetscInt late_count = (PetscInt)(sizeof(late) / sizeof(late[0]));
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt i = 0; i < n && !*unused; i++) {
    PetscBool known = ReadWhileSolving(names[i]);
    for (PetscInt k = 0; k < late_count && !known; k++) PetscCall(PetscStrcmp(names[i], late[k], &known));
    if (known) continue;
    PetscCall(PetscSNPrintf(unused, sizeof(unused), "-%s", names[i]));
    if (values[i]) PetscCall(PetscStrncpy(value, values[i], sizeof(value)));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscCheck(!*unused, t->comm, PETSC_ERR_USER_INPUT,
             "%s %s: misspelt, or not used by this scene's solvers; nearest known option: %s "
             "(-allow_unused_options goes on)",
             unused, value, Nearest(t, others, unused));
  PetscFunctionReturn(PETSC_SUCCESS);
}
