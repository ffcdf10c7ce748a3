#include "output/record.h"
#include <stdlib.h>

PetscBool RecordIsOwn(const RecordColumn *column) {
  return column->kind >= RECORD_APART;
}

/* Whether series.csv has a column of its own of each vesicle: not of one vesicle, nor of many. */
static PetscBool RecordRepeats(const Record *r, PetscInt column) {
  const PetscInt vesicles = r->setting.vesicles;
  return vesicles > 1 && vesicles <= RECORD_FEW && RecordIsOwn(&r->setting.column[column]);
}

static void RecordAddName(Record *r, size_t *used, const char name[]) {
  *used += (size_t)snprintf(r->header + *used, r->room - *used, "%s%s", *used ? "," : "", name);
}

/* Add a number to the text. NaN is an empty entry. */
static void RecordAddNumber(Record *r, size_t *used, PetscReal x) {
  *used += (size_t)snprintf(r->text + *used, r->room - *used, "%s", *used ? "," : "");
  if (!PetscIsNanReal(x)) *used += (size_t)snprintf(r->text + *used, r->room - *used, "%.17g", (double)x);
}

PetscErrorCode RecordCreate(const RecordSetting *s, Record *r) {
  size_t used = 0;
  PetscFunctionBeginUser;
  *r = (Record){.setting = *s};
  r->room = (size_t)(s->columns * (1 + PetscMin(s->vesicles, RECORD_FEW)) + s->extras) * RECORD_NAME;
  PetscCall(PetscCalloc4(s->columns + s->extras, &r->last, s->vesicles * s->columns, &r->each, (PetscInt)r->room,
                         &r->header, (PetscInt)r->room, &r->text));
  for (PetscInt c = 0; c < s->columns; c++) RecordAddName(r, &used, s->column[c].name);
  for (PetscInt v = 1; v <= s->vesicles; v++)
    for (PetscInt c = 0; c < s->columns; c++) {
      char name[2 * RECORD_NAME];
      (void)snprintf(name, sizeof(name), "%s_%d", s->column[c].name, (int)v);
      if (RecordRepeats(r, c)) RecordAddName(r, &used, name);
    }
  for (PetscInt k = 0; k < s->extras; k++) RecordAddName(r, &used, s->extra[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RecordDestroy(Record *r) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree4(r->last, r->each, r->header, r->text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The columns of all vesicles that follow from those of each. */
static void RecordCombineColumn(Record *r, PetscInt c) {
  const RecordKind kind = r->setting.column[c].kind;
  const PetscInt vesicles = r->setting.vesicles;
  PetscReal *all = &r->last[c];
  if (kind == RECORD_RUN || kind == RECORD_APART || !vesicles) return;
  *all = 0;
  for (PetscInt v = 0; v < vesicles; v++) {
    const PetscReal one = r->each[v * r->setting.columns + c];
    if (kind == RECORD_TOTAL || kind == RECORD_PAIRS) *all += one;
    if (kind == RECORD_MEAN) *all += one / (PetscReal)vesicles;
    if (kind == RECORD_WORST && PetscAbsReal(one) > PetscAbsReal(*all)) *all = one;
    if (kind == RECORD_FIRST && !v) *all = one;
    if (kind == RECORD_LEAST && (!v || one < *all)) *all = one;
    if (kind == RECORD_LARGEST && (!v || one > *all)) *all = one;
  }
}

void RecordCombine(Record *r) {
  const RecordSetting *s = &r->setting;
  size_t used = 0;
  for (PetscInt c = 0; c < s->columns; c++) {
    RecordCombineColumn(r, c);
    RecordAddNumber(r, &used, r->last[c]);
  }
  for (PetscInt v = 0; v < s->vesicles; v++)
    for (PetscInt c = 0; c < s->columns; c++)
      if (RecordRepeats(r, c)) RecordAddNumber(r, &used, r->each[v * s->columns + c]);
  for (PetscInt k = 0; k < s->extras; k++) RecordAddNumber(r, &used, r->last[s->columns + k]);
}

PetscReal RecordNumber(const Record *r, const char name[]) {
  PetscInt c = 0;
  while (strcmp(r->setting.column[c].name, name)) c++;
  return r->last[c];
}

PetscBool RecordFits(const Record *r, PetscInt step, PetscReal t) {
  PetscInt more = 0;
  for (const char *c = r->header; *c; c++) more += *c == ',';
  for (const char *c = r->text; *c; c++) more -= *c == ',';
  return !more && !r->text[strspn(r->text, "0123456789+-.einf,")] && RecordNumber(r, "step") == step &&
         RecordNumber(r, "time") == t;
}

void RecordParse(Record *r, const char text[]) {
  const char *p = r->text;
  (void)PetscStrncpy(r->text, text, r->room);
  for (PetscInt c = 0; c < r->setting.columns && p; c++) {
    char *end;
    const double x = strtod(p, &end);
    r->last[c] = end > p ? x : NAN; /* an empty entry, which the last may be */
    p = strchr(p, ',') ? strchr(p, ',') + 1 : NULL;
  }
}
