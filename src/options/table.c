/* All options of a table: read, chosen, shown, written. */
#include "options/options.h"
#include <ctype.h>

PetscReal ListEntry(const RealList *list, PetscInt each, PetscInt entry, PetscInt component) {
  return list->v[list->n > each ? each * entry + component : component];
}

PetscReal ListLargest(const RealList *list) {
  PetscReal largest = 0;
  for (PetscInt k = 0; k < list->n; k++) largest = PetscMax(largest, list->v[k]);
  return largest;
}

static void *OptionPlace(const OptionTable *t, void *values, PetscInt i) {
  return (char *)values + t->row[i].offset;
}

PetscErrorCode OptionsRead(MPI_Comm comm, const char title[], PetscInt n, const OptionRow row[],
                           const OptionDefault dependent[], OptionTable *t, void *values) {
  PetscFunctionBeginUser;
  t->comm = comm;
  t->n = n;
  t->row = row;
  t->dependent = dependent;
  PetscCall(PetscCalloc1(n, &t->given));
  PetscOptionsBegin(comm, NULL, title, NULL);
  for (PetscInt i = 0; i < n; i++) {
    const char *range = strcmp(row[i].range, "any") ? row[i].range : "";
    char text[PETSC_MAX_PATH_LEN], help[OPTION_HELP], ranged[2 * OPTION_HELP];
    OptionHelpText(&row[i], dependent, help);
    PetscCall(PetscSNPrintf(ranged, sizeof(ranged), *range ? "%s [%s]" : "%s%s", help, range));
    PetscCall(
        PetscOptionsString(row[i].name, ranged, "docs/options.md", row[i].value, text, sizeof(text), &t->given[i]));
    const char *value = NULL; /* as long as it may be */
    if (t->given[i]) PetscCall(PetscOptionsFindPair(NULL, NULL, row[i].name, &value, NULL));
    if (!value) value = t->given[i] ? "" : row[i].value;
    PetvesCheck(!t->given[i] || *value || row[i].type == OPT_BOOL, comm, "%s: given without a value; allowed: %s",
                row[i].name, *range ? range : row[i].help);
    PetscCall(OptionParse(comm, &row[i], value, OptionPlace(t, values, i)));
  }
  PetscOptionsEnd();
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OptionsDestroy(OptionTable *t, void *values) {
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < t->n; i++) {
    void *place = OptionPlace(t, values, i);
    if (t->row[i].type == OPT_REALS) PetscCall(PetscFree(((RealList *)place)->v));
    if (t->row[i].type == OPT_INTS) PetscCall(PetscFree(((IntList *)place)->v));
  }
  PetscCall(PetscFree(t->given));
  t->n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt OptionFind(const OptionTable *t, const char name[]) {
  for (PetscInt i = 0; i < t->n; i++)
    if (!strcmp(t->row[i].name, name)) return i;
  return -1;
}

PetscBool OptionGiven(const OptionTable *t, const char name[]) {
  const PetscInt i = OptionFind(t, name);
  return i >= 0 && t->given[i];
}

PetscErrorCode OptionChoose(const OptionTable *t, void *values, const char name[], const char text[]) {
  const PetscInt i = OptionFind(t, name);
  PetscFunctionBeginUser;
  PetscCheck(i >= 0, t->comm, PETSC_ERR_PLIB, "%s is not in the table of options", name);
  if (!t->given[i]) PetscCall(OptionParse(t->comm, &t->row[i], text, OptionPlace(t, values, i)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool OptionDepends(const OptionTable *t, const void *values, const OptionDefault *d, char value[OPTION_MAX_NAME]) {
  *value = 0;
  if (OptionGiven(t, d->name) || !d->when(values)) return PETSC_FALSE;
  if (d->find)
    d->find(values, value);
  else
    (void)snprintf(value, OPTION_MAX_NAME, "%s", d->value);
  return *value ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode OptionsDepend(const OptionTable *t, void *values) {
  PetscFunctionBeginUser;
  for (const OptionDefault *d = t->dependent; d->name; d++) {
    char value[OPTION_MAX_NAME];
    if (OptionDepends(t, values, d, value)) PetscCall(OptionChoose(t, values, d->name, value));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool OptionNeedIsMet(const OptionNeed *need, const char *values) {
  if (need->met) return need->met(values);
  if (need->any_of) return need->any_of >> *(const PetscInt *)(values + need->offset) & 1;
  return *(const PetscReal *)(values + need->positive) > 0;
}

const char *OptionMissing(const OptionTable *t, const OptionRow *row, const void *values) {
  const char *missing = t->missing ? t->missing(row, values) : NULL;
  if (missing || !row->need) return missing;
  return OptionNeedIsMet(row->need, (const char *)values) ? NULL : row->need->what;
}

PetscErrorCode OptionsCheckUsed(const OptionTable *t, const void *values) {
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < t->n; i++) {
    const char *const missing = OptionMissing(t, &t->row[i], values);
    const char *value = NULL; /* as it was typed */
    if (!t->given[i] || !missing) continue;
    PetscCall(PetscOptionsFindPair(NULL, NULL, t->row[i].name, &value, NULL));
    SETERRQ(t->comm, PETSC_ERR_USER_INPUT,
            "%s%s%.128s: not used by this scene; allowed: with %s (-allow_unused_options goes on)", t->row[i].name,
            value && *value ? " " : "", value ? value : "", missing);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OptionValue(const OptionTable *t, const void *values, PetscInt i, char text[], size_t length) {
  char *all;
  PetscFunctionBeginUser;
  PetscCall(OptionText(t, values, i, &all));
  PetscCall(PetscStrncpy(text, all, length));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void OptionPrint(FILE *file, const char name[], const char value[]) {
  const char *const quote = strpbrk(value, " #'") || (*value == '-' && isalpha((unsigned char)value[1])) ? "\"" : "";
  fprintf(file, *value ? "%s %s%s%s\n" : "%s\n", name, quote, value, quote);
}

PetscErrorCode OptionsWrite(const OptionTable *t, const void *values, const char *const skip[], FILE *file) {
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < t->n; i++) {
    char *text;
    PetscBool left = OptionMissing(t, &t->row[i], values) ? PETSC_TRUE : PETSC_FALSE;
    for (PetscInt k = 0; skip[k] && !left; k++) left = !strcmp(skip[k], t->row[i].name);
    if (left) continue;
    PetscCall(OptionText(t, values, i, &text));
    if (*text) OptionPrint(file, t->row[i].name, text);
    PetscCall(PetscFree(text));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define WIDTH 100 /* of a line */
#define INDENT 6

/* Words of a text in lines of at most WIDTH characters. */
static void OptionPrintWrapped(FILE *file, const char *text) {
  size_t at = 0;
  for (const char *p = text; *p;) {
    const size_t n = strcspn(p, " ");
    if (at && at + 1 + n > WIDTH) at = 0 * (size_t)fputc('\n', file);
    at += (size_t)fprintf(file, "%*s%.*s", at ? 1 : INDENT, "", (int)n, p);
    p += n + (p[n] == ' ');
  }
  fputc('\n', file);
}

void OptionHelpText(const OptionRow *row, const OptionDefault *d, char text[OPTION_HELP]) {
  (void)snprintf(text, OPTION_HELP, "%s", row->help);
  for (; d->name; d++) {
    const size_t used = strlen(text);
    char own[OPTION_HELP];
    if (!d->help || strcmp(d->name, row->name)) continue;
    (void)snprintf(own, sizeof(own), d->help, d->value);
    (void)snprintf(text + used, OPTION_HELP - used, "; %s", own);
  }
}

void OptionHelp(FILE *file, const OptionRow *row, const OptionDefault dependent[]) {
  char help[OPTION_HELP];
  fprintf(file, "  %s%s%s", row->name, *row->value ? " " : "", row->value);
  fprintf(file, *row->range && strcmp(row->range, "any") ? "  [%s]\n" : "\n", row->range);
  OptionHelpText(row, dependent, help);
  OptionPrintWrapped(file, help);
}
