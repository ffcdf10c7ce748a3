/* One option's value from text, and as text. */
#include "options/options.h"
#include <ctype.h>

#define DIGITS 26 /* characters of a number with 17 digits and its comma, at most */

/* One number from text; the whole text must be used up and finite. */
static PetscBool OptionParseReal(const char *text, PetscReal *value) {
  char *end;
  while (isspace((unsigned char)*text)) text++;
  if (!*text) return PETSC_FALSE;
  *value = strtod(text, &end);
  while (isspace((unsigned char)*end)) end++;
  return !*end && !PetscIsInfOrNanReal(*value);
}

static PetscBool OptionInRange(const char *range, PetscReal x) {
  double a, b;
  if (!strcmp(range, ">0")) return x > 0;
  if (sscanf(range, ">=%lf", &a) == 1) return x >= a;
  if (sscanf(range, "(%lf,%lf)", &a, &b) == 2) return x > a && (x < b || (x == b && strchr(range, ']')));
  if (sscanf(range, "[%lf,%lf]", &a, &b) == 2) return x >= a && x <= b;
  return PETSC_TRUE;
}

/* Index of text in "a|b|c", or -1. */
static PetscInt OptionIndexInList(const char *list, const char *text) {
  const size_t length = strlen(text);
  PetscInt index = 0;
  for (const char *p = list; *p; index++) {
    const size_t n = strcspn(p, "|");
    if (n == length && !strncmp(p, text, n)) return index;
    p += n + (p[n] == '|');
  }
  return -1;
}

/* One number of a value, or the index of a word in the range's list; where the value is a list, a message names both.
 */
static PetscErrorCode OptionParseNumber(MPI_Comm comm, const OptionRow *o, const char *all, const char *text,
                                        PetscReal *x) {
  const PetscBool integer = o->type == OPT_INT || o->type == OPT_INTS;
  const char *what = integer ? "an integer" : "a number";
  char part[128] = "";
  PetscFunctionBeginUser;
  if (strcmp(text, all)) PetscCall(PetscSNPrintf(part, sizeof(part), "\"%.100s\" is ", text));
  if (strchr(o->range, '|')) {
    const PetscInt index = OptionIndexInList(o->range, text);
    PetvesCheck(index >= 0, comm, "%s %s: %sunknown; allowed: %s", o->name, all, part, o->range);
    *x = (PetscReal)index;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetvesCheck(OptionParseReal(text, x) &&
                  (!integer || (*x == PetscFloorReal(*x) && PetscAbsReal(*x) < (PetscReal)PETSC_MAX_INT)),
              comm, "%s %s: %snot %s; allowed: %s%s%s", o->name, all, part, what, what,
              strcmp(o->range, "any") ? ", " : "", strcmp(o->range, "any") ? o->range : "");
  PetvesCheck(OptionInRange(o->range, *x), comm, "%s %s: %sout of range; allowed: %s %s", o->name, all, part, what,
              o->range);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers between commas, or one where the option is no list; x to be freed. */
static PetscErrorCode OptionParseNumbers(MPI_Comm comm, const OptionRow *o, const char *text, PetscInt *n,
                                         PetscReal **x) {
  const char *const comma = o->type == OPT_REALS || o->type == OPT_INTS ? "," : "", *const all = text;
  char *item;
  PetscFunctionBeginUser;
  *n = 1;
  for (const char *p = text; *p; p++) *n += *p == *comma;
  PetscCall(PetscMalloc1(*n, x));
  PetscCall(PetscMalloc1(strlen(text) + 1, &item));
  for (PetscInt k = 0; k < *n; k++) {
    const size_t length = strcspn(text, comma);
    PetscCall(PetscStrncpy(item, text, length + 1));
    PetscCall(OptionParseNumber(comm, o, all, item, *x + k));
    text += length + 1;
  }
  PetscCall(PetscFree(item));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode OptionParseTruth(MPI_Comm comm, const OptionRow *o, const char *text, PetscBool *truth) {
  const PetscInt yes = OptionIndexInList("|true|yes|on|1", text), no = OptionIndexInList("false|no|off|0", text);
  PetscFunctionBeginUser;
  PetvesCheck(yes >= 0 || no >= 0 || !*text, comm, "%s %s: allowed: true or false", o->name, text);
  *truth = no < 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A name that resolved.opts can hold, so that it repeats the run: options files have no escapes. */
static PetscErrorCode OptionParsePath(MPI_Comm comm, const OptionRow *o, const char *text, char path[]) {
  PetscBool plain = o->type == OPT_PATH && text[0] == '-' ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionBeginUser;
  for (const char *c = text; *c && plain; c++)
    plain = iscntrl((unsigned char)*c) || *c == '"' ? PETSC_FALSE : PETSC_TRUE;
  PetvesCheck(
      plain, comm,
      "%s %s: no options file can hold this name; allowed: no double quote or control character in it, and no dash "
      "before it",
      o->name, text);
  PetvesCheck(strlen(text) < PETSC_MAX_PATH_LEN - 64, comm, "%s: a name of %d characters; allowed: less than %d",
              o->name, (int)strlen(text), PETSC_MAX_PATH_LEN - 64);
  PetscCall(PetscStrncpy(path, text, PETSC_MAX_PATH_LEN));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OptionParse(MPI_Comm comm, const OptionRow *o, const char text[], void *place) {
  RealList *reals = (RealList *)place;
  IntList *ints = (IntList *)place;
  PetscReal *x;
  PetscInt n;
  const PetscBool words = o->type == OPT_PATH || o->type == OPT_TEXT;
  PetscFunctionBeginUser;
  if (o->type == OPT_BOOL) PetscCall(OptionParseTruth(comm, o, text, (PetscBool *)place));
  if (words) PetscCall(OptionParsePath(comm, o, text, (char *)place));
  if (words || o->type == OPT_BOOL) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(OptionParseNumbers(comm, o, text, &n, &x));
  if (o->type == OPT_NAME) PetscCall(PetscStrncpy((char *)place, text, OPTION_MAX_NAME));
  if (o->type == OPT_REAL) *(PetscReal *)place = *x;
  if (o->type == OPT_INT || o->type == OPT_ENUM) *(PetscInt *)place = (PetscInt)*x;
  if (o->type == OPT_REALS) {
    PetscCall(PetscFree(reals->v));
    *reals = (RealList){n, x};
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (o->type == OPT_INTS) {
    PetscCall(PetscFree(ints->v));
    PetscCall(PetscMalloc1(n, &ints->v));
    ints->n = n;
    for (PetscInt k = 0; k < n; k++) ints->v[k] = (PetscInt)x[k];
  }
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OptionText(const OptionTable *t, const void *values, PetscInt i, char **text) {
  const OptionRow *o = &t->row[i];
  const void *place = (const char *)values + o->offset;
  const RealList *list = (const RealList *)place;
  const PetscBool listed = o->type == OPT_REALS || o->type == OPT_INTS;
  const PetscBool real = o->type == OPT_REALS || o->type == OPT_REAL;
  const PetscBool word = o->type == OPT_ENUM || (o->type == OPT_INTS && strchr(o->range, '|'));
  const void *number = listed ? (const void *)list->v : place;
  const PetscInt n = listed ? list->n : o->type == OPT_REAL || o->type == OPT_INT || word ? 1 : 0;
  const size_t room = PETSC_MAX_PATH_LEN + (DIGITS + OPTION_MAX_NAME) * (size_t)n;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(room, text));
  if (o->type == OPT_BOOL) PetscCall(PetscStrncpy(*text, *(const PetscBool *)place ? "true" : "false", room));
  if (o->type == OPT_NAME || o->type == OPT_PATH || o->type == OPT_TEXT)
    PetscCall(PetscStrncpy(*text, (const char *)place, room));
  char *end = *text;
  for (PetscInt k = 0; k < n; k++, end += strlen(end)) {
    const char *comma = k ? "," : "", *p = o->range;
    for (PetscInt i = word ? ((const PetscInt *)number)[k] : 0; i > 0; i--) p = strchr(p, '|') + 1;
    if (word)
      PetscCall(PetscSNPrintf(end, OPTION_MAX_NAME, "%s%.*s", comma, (int)strcspn(p, "|"), p));
    else if (real)
      PetscCall(PetscSNPrintf(end, DIGITS + 1, "%s%.17g", comma, (double)((const PetscReal *)number)[k]));
    else
      PetscCall(PetscSNPrintf(end, DIGITS + 1, "%s%" PetscInt_FMT, comma, ((const PetscInt *)number)[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
