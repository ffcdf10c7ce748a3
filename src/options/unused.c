/* Misspelt and unused options: found, and named with the option that is meant, if one is near. */
#define _GNU_SOURCE /* strcasestr */
#include "options/options.h"
#include "base/agree.h"
#include <strings.h>

/* Options that PETSc itself reads only while it finalises. */
static const char *const late[] = {"options_left",    "objects_dump", "malloc_dump",    "malloc_view",
                                   "memory_view",     "log_view",     "log_trace",      "log_summary",
                                   "log_view_memory", "mpi_finalize", "on_error_abort", "options_view"};
#define LATE (sizeof(late) / sizeof(late[0]))

/* Solver options that PETSc reads only when it solves, after the check; viewers first. */
static const char *const later[] = {"_ksp_view", "_ksp_converged_reason", "_ksp_converged_rate", "_mat_view",
                                    "_mat_mumps_"};
#define LATER (sizeof(later) / sizeof(later[0]))
#define LATER_VIEWERS 4

/* TRUE if PETSc will read the option (given without its dash) after the check. viewer: the option names a viewer. */
static PetscBool OptionIsReadLater(const char *name, PetscBool *viewer) {
  *viewer = PETSC_FALSE;
  for (size_t k = 0; k < LATE; k++)
    if (!strcasecmp(name, late[k])) return PETSC_TRUE;
  for (size_t k = 0; k < LATER; k++)
    if (strstr(name, later[k])) {
      *viewer = k < LATER_VIEWERS;
      return PETSC_TRUE;
    }
  return PETSC_FALSE;
}

#if PETSC_VERSION_GE(3, 22, 0)
#define MakeViewer PetscOptionsCreateViewer
#else
#define MakeViewer PetscOptionsGetViewer
#endif

/* Read now what PETSc reads when the run is over, a viewer or a truth: a mistake in it would be found only then. */
static PetscErrorCode OptionTryLate(MPI_Comm comm, const char name[], PetscBool is_viewer) {
  const char *value = NULL;
  PetscErrorCode error;
  PetscViewer viewer = NULL;
  PetscViewerFormat format;
  PetscBool set, truth, failed;
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsFindPair(NULL, NULL, name, &value, &set));
  if (!set) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  error = is_viewer ? MakeViewer(comm, NULL, NULL, name, &viewer, &format, &set)
                    : PetscOptionsGetBool(NULL, NULL, name, &truth, &set);
  PetscCall(PetscPopErrorHandler());
  PetscCall(AgreeFlag(comm, error ? PETSC_TRUE : PETSC_FALSE, &failed)); /* one rank alone opens a file */
  if (failed) {                                                          /* PETSc must not stumble over it once more */
    char text[256];
    PetscCall(PetscSNPrintf(text, sizeof(text), "%s %s", name, value ? value : ""));
    PetscCall(PetscOptionsClearValue(NULL, name));
    SETERRQ(comm, PETSC_ERR_USER_INPUT, "%s: %s", text,
            is_viewer ? "no viewer of PETSc's, or its file cannot be written; allowed: no value, or type:file:format, "
                        "such as ascii:log.txt"
                      : "allowed: true or false");
  }
  PetscCall(PetscViewerDestroy(&viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Edit distance of two short words, two swapped neighbours one edit (Damerau and Levenshtein). */
static PetscInt NameDistance(const char *a, const char *b) {
  PetscInt rows[3][128];
  const PetscInt n = (PetscInt)PetscMin(strlen(b), (size_t)127);
  for (PetscInt j = 0; j <= n; j++) rows[0][j] = j;
  for (PetscInt i = 1; a[i - 1]; i++) {
    PetscInt *row = rows[i % 3], *above = rows[(i + 2) % 3], *second = rows[(i + 1) % 3];
    row[0] = i;
    for (PetscInt j = 1; j <= n; j++) {
      row[j] = PetscMin(above[j - 1] + (a[i - 1] != b[j - 1]), 1 + PetscMin(above[j], row[j - 1]));
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = PetscMin(row[j], 1 + second[j - 2]);
    }
  }
  return rows[strlen(a) % 3][n];
}

/* TRUE if `name` is the end of a longer name (-rate of -flow_rate) or its beginning (-vesicle_reduced of
   -vesicle_reduced_area). */
static PetscBool NameIsPart(const char *name, const char *longer) {
  const size_t n = strlen(name) - 1, m = strlen(longer);
  if (n < 3 || m <= n + 1) return PETSC_FALSE;
  if (longer[m - n - 1] == '_' && !strcmp(longer + m - n, name + 1)) return PETSC_TRUE;
  return strchr(name, '_') && longer[n + 1] == '_' && !strncmp(longer, name, n + 1);
}

/* Number of the first character after the words with which two names begin alike. */
static size_t NameAlike(const char *a, const char *b) {
  size_t same = 0;
  for (size_t k = 0; a[k] && a[k] == b[k]; k++)
    if (a[k] == '_') same = k + 1;
  return same;
}

/* The known name that is nearest; NULL: no name is near. One letter may be wrong, and one in four of the letters that
   follow the common words. */
static const char *NameMeant(const OptionTable *t, const char *const others[], const char *name) {
  const char *best = NULL;
  PetscInt least = PETSC_MAX_INT;
  for (PetscInt i = 0; i < t->n || others[i - t->n]; i++) {
    const char *known = i < t->n ? t->row[i].name : others[i - t->n];
    const size_t same = NameAlike(name, known);
    const PetscInt far = 1 + (PetscInt)strlen(name + same) / 4;
    const PetscInt distance = NameIsPart(name, known) ? 0 : NameDistance(name + same, known + same);
    if (distance > far || distance >= least) continue;
    least = distance;
    best = known;
  }
  return best;
}

/* TRUE if a name has these words as whole words, case ignored, as -domain_inflow_x has inflow. */
static PetscBool NameHasWords(const char *name, const char *words) {
  const size_t n = strlen(words);
  for (const char *p = strcasestr(name, words); p; p = strcasestr(p + 1, words))
    if ((p[-1] == '_' || p[-1] == '-') && (!p[n] || p[n] == '_')) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* TRUE if a name is among the names of a suggestion, such as "-nx *grid". A word after * counts only if no name of the
   table has the word. */
static PetscBool NameIsAmong(const OptionTable *t, const char *names, const char *name) {
  for (const char *p = names; *p; p += strspn(p, " ")) {
    const size_t n = strcspn(p, " ");
    char one[64];
    PetscBool found;
    (void)snprintf(one, sizeof(one), "%.*s", (int)n, p);
    found = *one == '*' ? NameHasWords(name, one + 1) : !strcasecmp(one, name);
    for (PetscInt i = 0; i < t->n && *one == '*' && found; i++) found = !NameHasWords(t->row[i].name, one + 1);
    if (found) return PETSC_TRUE;
    p += n;
  }
  return PETSC_FALSE;
}

/* An option that nothing has read, with its dash. */
static PetscErrorCode OptionRefuse(const OptionTable *t, const void *values, const char *const others[],
                                   const OptionOwner owners[], const OptionSuggestion *suggestion, const char name[],
                                   const char value[]) {
  const OptionOwner *owner = owners;
  const char *meant;
  char in_force[OPTION_MAX_NAME], given[256];
  PetscBool known = PETSC_FALSE;
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(given, sizeof(given), *value ? "%s %s" : "%s", name, value));
  while (owner->prefix && strncmp(owner->prefix, name, strlen(owner->prefix))) owner++;
  if (owner->prefix) PetscCall(OptionValue(t, values, OptionFind(t, owner->name), in_force, sizeof(in_force)));
  for (PetscInt i = 0; others[i] && !known; i++) PetscCall(PetscStrcmp(others[i], name, &known));
  PetvesCheck(!owner->prefix || !strcmp(in_force, owner->value), t->comm,
              "%s: not used by this scene; allowed: with %s %s (-allow_unused_options goes on)", given, owner->name,
              owner->value);
  PetvesCheck(!known, t->comm,
              "%s: not used by this scene's solvers as they are set up (-allow_unused_options goes on)", given);
  while (suggestion->names && !NameIsAmong(t, suggestion->names, name)) suggestion++;
  PetvesCheck(!suggestion->names, t->comm, "%s: no such option; %s (-allow_unused_options goes on)", given,
              suggestion->say);
  meant = NameMeant(t, others, name);
  PetvesCheck(!meant, t->comm, "%s: no such option; %s is meant? (-allow_unused_options goes on)", given, meant);
  SETERRQ(t->comm, PETSC_ERR_USER_INPUT,
          "%s: no such option; petves -help options lists them (-allow_unused_options goes on)", given);
}

PetscErrorCode OptionsTryLate(const OptionTable *t) {
  PetscFunctionBeginUser;
  PetscCall(OptionTryLate(t->comm, "-log_view", PETSC_TRUE));
  PetscCall(OptionTryLate(t->comm, "-options_left", PETSC_FALSE));
  PetscCall(OptionTryLate(t->comm, "-options_view", PETSC_FALSE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OptionsCheckUnused(const OptionTable *t, const void *values, const char *const others[],
                                  const OptionOwner owners[], const OptionSuggestion suggestions[]) {
  char **names, **texts, unused[128] = "", value[128] = "";
  PetscInt n = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &texts));
  for (PetscInt i = 0; i < n && !*unused; i++) {
    char name[128];
    PetscBool viewer;
    PetscCall(PetscSNPrintf(name, sizeof(name), "-%s", names[i]));
    const PetscBool later_read = OptionIsReadLater(names[i], &viewer);
    if (viewer) PetscCall(OptionTryLate(t->comm, name, PETSC_TRUE));
    if (later_read) continue;
    PetscCall(PetscStrncpy(unused, name, sizeof(unused)));
    if (texts[i]) PetscCall(PetscStrncpy(value, texts[i], sizeof(value)));
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &texts));
  if (*unused) PetscCall(OptionRefuse(t, values, others, owners, suggestions, unused, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}
