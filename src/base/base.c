#define _GNU_SOURCE /* strcasestr */
#include "base/base.h"
#include <ctype.h>
#include <time.h>

#define PATIENCE 200 /* hundredths of a second that a rank that has failed waits for the others */

/* Logging and error state of the whole program, the only one that petves has. PETSc's logging, which it feeds, belongs
   to the whole program too. */
static struct {
  PetscBool one_line;
  PetscBool said, ending;          /* an error has been printed; the program ends */
  char unsaid[PETVES_MAX_MESSAGE]; /* the last error that was left to rank 0 to print */
  PetscBool quiet;                 /* PetvesSay says nothing */
  PetscBool registered;
  PetscLogStage stage[PHASE_COUNT];
  PetscReal seconds[PHASE_COUNT];
  Phase stack[16];
  PetscInt depth;
  PetscLogDouble since;
  PetscClassId classid;
} base;

const char *const PhaseNames[PHASE_COUNT] = {"setup", "step", "fast_solve", "output"};

/* Whether an option is one of PETSc's solvers or of its library. */
static PetscBool OptionIsPetscs(const char *name) {
  const char *const heads[] = {"-malloc", "-log_",     "-info",     "-fp_trap",
                               "-memory", "-options_", "-on_error", "-objects"};
  for (size_t k = 0; k < sizeof(heads) / sizeof(heads[0]); k++)
    if (!strncmp(name, heads[k], strlen(heads[k]))) return PETSC_TRUE;
  return strstr(name, "_ksp_") || strstr(name, "_pc_");
}

/* PETSc's messages about a bad option of its own (-tension_ksp_type foo) have the value but not the option. name: the
   first such option whose value is a word of the message, as "-name value: "; else "". */
static void ErrorNameOption(const char *message, char name[], size_t length) {
  char *all = NULL, *word, *last = NULL, *end = NULL;
  name[0] = 0;
  if (PetscOptionsGetAll(NULL, &all)) return;
  for (word = strtok_r(all, " \n", &end); word && !*name; last = word, word = strtok_r(NULL, " \n", &end)) {
    const char *found = last && OptionIsPetscs(last) ? strcasestr(message, word) : NULL;
    if (!found || (found > message && !isspace((unsigned char)found[-1]))) continue;
    if (!isalnum((unsigned char)found[strlen(word)])) (void)PetscSNPrintf(name, length, "%s %s: ", last, word);
  }
  (void)PetscFree(all);
}

/* One line of text: the option at fault and the message; TRUE if there is such an option. */
static PetscBool ErrorOneLine(PetscErrorCode code, const char *message, char text[PETVES_MAX_MESSAGE]) {
  char before[PETVES_MAX_MESSAGE / 2] = "";
  size_t n;
  if (code != PETSC_ERR_USER_INPUT && message) ErrorNameOption(message, before, sizeof(before));
  (void)PetscStrncpy(text, before, PETVES_MAX_MESSAGE);
  n = strlen(text);
  for (const char *c = message ? message : "unknown error"; *c && n < PETVES_MAX_MESSAGE - 1; c++)
    text[n++] = iscntrl((unsigned char)*c) ? ' ' : *c;
  text[n] = 0;
  return *before ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode PetvesErrorHandler(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                  PetscErrorType type, const char *message, void *ctx) {
  char text[PETVES_MAX_MESSAGE], *kept = (char *)ctx;
  PetscMPIInt rank = 0,
              among = 0; /* rank of all ranks, and of those that have the error: the first of them prints it */
  PetscBool mistake;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (comm != MPI_COMM_NULL) MPI_Comm_rank(comm, &among);
  if (type != PETSC_ERROR_INITIAL || (base.said && base.ending)) return code;
  if (code == PETSC_ERR_MEM ||
      !strcmp(function, "PetscMallocAlign")) { /* PetscMallocAlign gives a line number as the code */
    code = PETSC_ERR_MEM;
    message = "out of memory; allowed: fewer cells or vesicles, a larger limit, or more nodes";
  }
  if ((rank || among) && code == PETSC_ERR_USER_INPUT && !kept) return code; /* rank 0 prints it */
  mistake = ErrorOneLine(code, message, text) || code == PETSC_ERR_USER_INPUT || base.one_line;
  if (!mistake) { /* add the place in the source */
    const size_t used = strlen(text);
    (void)PetscSNPrintf(text + used, sizeof(text) - used, " (%s() in %s, line %d, rank %d)", function, file, line,
                        rank);
  }
  if (kept && !*kept)
    (void)PetscStrncpy(kept, text, PETVES_MAX_MESSAGE);
  else if (!kept && (code == PETSC_ERR_MEM || !rank || !(base.one_line || among)))
    fprintf(stderr, "petves: error: %s\n", text);
  else if (!kept)
    (void)PetscStrncpy(base.unsaid, text, PETVES_MAX_MESSAGE);
  if (!kept) base.said = PETSC_TRUE;
  fflush(stderr);
  return code;
}

PetscErrorCode PetvesEndTogether(MPI_Comm comm, const char line[]) {
  const struct timespec moment = {.tv_nsec = 10000000};
  MPI_Request all;
  int here = 0, failed = MPI_Ibarrier(comm, &all);
  for (int k = 0; k < PATIENCE && !here && !failed; k++) {
    failed = MPI_Test(&all, &here, MPI_STATUS_IGNORE);
    if (!here) (void)nanosleep(&moment, NULL);
  }
  if (here) return PETSC_SUCCESS;
  if (!line) line = base.unsaid;
  if (*line) fprintf(stderr, "petves: error: %s\n", line);
  (void)MPI_Abort(comm, 1);
  return PETSC_ERR_MPI;
}

PetscErrorCode PetvesLastErrors(void) {
  PetscFunctionBeginUser;
  base.ending = base.one_line = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PetvesSetupErrors(PetscBool on) {
  PetscFunctionBeginUser;
  base.one_line = on;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PhaseRegister(void) {
  PetscFunctionBeginUser;
  for (int p = 0; p < PHASE_COUNT; p++) {
    char name[64];
    PetscCall(PetscSNPrintf(name, sizeof(name), "petves %s", PhaseNames[p]));
    PetscCall(PetscLogStageRegister(name, &base.stage[p]));
  }
  PetscCall(PetscClassIdRegister("petves", &base.classid));
  base.registered = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Add the time since the last call to the phase that has lasted since then. */
static void PhaseCharge(void) {
  PetscLogDouble now;
  (void)PetscTime(&now);
  if (base.depth > 0) base.seconds[base.stack[base.depth - 1]] += now - base.since;
  base.since = now;
}

PetscErrorCode PhaseBegin(Phase phase) {
  PetscFunctionBeginUser;
  if (!base.registered) PetscCall(PhaseRegister());
  PetscCheck(base.depth < 16, PETSC_COMM_SELF, PETSC_ERR_PLIB, "phases nested too deep");
  PhaseCharge();
  base.stack[base.depth++] = phase;
  PetscCall(PetscLogStagePush(base.stage[phase]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PhaseEnd(void) {
  PetscFunctionBeginUser;
  PetscCheck(base.depth > 0, PETSC_COMM_SELF, PETSC_ERR_PLIB, "PhaseEnd without PhaseBegin");
  PhaseCharge();
  base.depth--;
  PetscCall(PetscLogStagePop());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt PhaseDepth(void) {
  return base.depth;
}

PetscReal PhaseSeconds(Phase phase) {
  return base.seconds[phase];
}

PetscErrorCode PetvesEvent(const char name[], PetscLogEvent *event) {
  PetscFunctionBeginUser;
  if (!base.registered) PetscCall(PhaseRegister());
  PetscCall(PetscLogEventRegister(name, base.classid, event));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PetvesSetQuiet(PetscBool quiet) {
  base.quiet = quiet;
  return PETSC_SUCCESS;
}

PetscErrorCode PetvesSay(MPI_Comm comm, const char format[], ...) {
  char text[PETVES_MAX_MESSAGE];
  va_list arguments;
  PetscFunctionBeginUser;
  if (base.quiet) PetscFunctionReturn(PETSC_SUCCESS);
  va_start(arguments, format);
  PetscCall(PetscVSNPrintf(text, sizeof(text), format, NULL, arguments));
  va_end(arguments);
  PetscCall(PetscPrintf(comm, "%s", text));
  PetscFunctionReturn(PETSC_SUCCESS);
}
