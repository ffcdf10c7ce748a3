/* A row of the option table for a reader. */
#include "options/options.h"

#define WIDTH 100 /* of a line */
#define INDENT 6

/* Words of a text in lines of at most WIDTH characters. */
static void PrintWrapped(FILE *file, const char *text) {
  size_t at = 0;
  for (const char *p = text; *p;) {
    const size_t n = strcspn(p, " ");
    if (at && at + 1 + n > WIDTH) at = 0 * (size_t)fputc('\n', file);
    at += (size_t)fprintf(file, "%*s%.*s", at ? 1 : INDENT, "", (int)n, p);
    p += n + (p[n] == ' ');
  }
  fputc('\n', file);
}

void OptionHelp(FILE *file, const OptionRow *row) {
  fprintf(file, "  %s%s%s", row->name, *row->value ? " " : "", row->value);
  fprintf(file, *row->range && strcmp(row->range, "any") ? "  [%s]\n" : "\n", row->range);
  PrintWrapped(file, row->help);
}
