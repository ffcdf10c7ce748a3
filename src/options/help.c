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
  PrintWrapped(file, help);
}
