/* The words that a user typed, checked one by one. Plain malloc: PETSc has not started. */
#define _GNU_SOURCE /* strcasestr */
#include "options/typed.h"
#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#define MOST_BYTES (16 << 20) /* of an option file */
#define MOST_NAME 128         /* characters of an option's name */
#define EXCERPT 60            /* characters of a line that a message shows */

typedef struct {
  const char *text;
  PetscBool quoted; /* a value, whatever it begins with */
} Word;

/* The source of words: the command line, an environment variable or a file. */
typedef struct _Source {
  const struct _Source *outer; /* the file that includes this one */
  const char *option;          /* that names the file; NULL: no file */
  const char *name;            /* "PETSC_OPTIONS" or a file's path; NULL: the command line */
  const char *line;            /* of a file, with its number; an option of a file of YAML, without */
  int number;
  dev_t device;
  ino_t file;
} Source;

/* Write the message of a mistake; it begins with the place where the mistake is. */
static void PETSC_ATTRIBUTE_FORMAT(3, 4) TypedWrong(Typed *t, const Source *from, const char format[], ...) {
  int used = 0;
  va_list arguments;
  if (from->number)
    used = snprintf(t->error, sizeof(t->error), "-options_file %.200s: line %d is \"%.*s\": ", from->name, from->number,
                    EXCERPT, from->line);
  else if (from->option)
    used = snprintf(t->error, sizeof(t->error), "%s %.200s: ", from->option, from->name);
  else if (from->name)
    used = snprintf(t->error, sizeof(t->error), "%.200s: ", from->name);
  va_start(arguments, format);
  (void)vsnprintf(t->error + used, sizeof(t->error) - (size_t)used, format, arguments);
  va_end(arguments);
  for (char *p = t->error; *p; p++)
    if (iscntrl((unsigned char)*p)) *p = ' ';
}

static void TypedAppend(Typed *t, const char *name, const char *value) {
  const size_t need = strlen(name) + (value ? strlen(value) + 1 : 0) + 2;
  if (t->used + need > t->room) {
    t->room = 2 * (t->used + need);
    t->text = (char *)realloc(t->text, t->room);
    if (!t->text) abort();
  }
  t->used += (size_t)sprintf(t->text + t->used, "%s", name) + 1;
  t->used += (size_t)sprintf(t->text + t->used, "%s%s", value ? "=" : "", value ? value : "") + 1;
}

/* TRUE if a word is the name of an option and not a value: a dash and a letter, except -inf and -nan. */
static PetscBool WordIsName(const Word *word) {
  PetscBool is = PETSC_FALSE;
  if (!word->quoted) (void)PetscOptionsValidKey(word->text, &is);
  return is;
}

static void TypedCheckName(Typed *t, const Source *from, const char *name) {
  const char *p = name + 1;
  if (*p == '-') {
    TypedWrong(t, from, "%.100s: two dashes, as petves plot and other tools have; allowed in a run: one, as in %.100s",
               name, name + 1);
    return;
  }
  while (isalnum((unsigned char)*p) || *p == '_' || *p == '-' || *p == '.') p++;
  if (*p == '=')
    TypedWrong(t, from, "%.100s: an equals sign; allowed: a blank, as in %.*s %.60s", name, (int)PetscMin(p - name, 60),
               name, p[1] ? p + 1 : "VALUE");
  else if (*p || p - name > MOST_NAME)
    TypedWrong(t, from, "%.100s: not the name of an option; allowed: up to %d letters, digits and _", name, MOST_NAME);
}

/* Write the message of a word that stands where an option should begin: after an option with a value, or alone. */
static void TypedWrongWord(Typed *t, const Source *from, const char *name, const char *value, const char *word) {
  const PetscBool comma = value && *value && (value[strlen(value) - 1] == ',' || *word == ',');
  if (value && *value == '=')
    TypedWrong(t, from, "%.60s = %.60s: an equals sign; allowed: a blank, as in %.60s %.60s", name, word, name, word);
  else if (value)
    TypedWrong(
        t, from,
        "%.60s %.60s %.60s: two values; allowed: one, a list with commas and no blanks (%.60s%s%.60s), text with "
        "blanks in quotes",
        name, value, word, value, comma ? "" : ",", word);
  else if (from->line)
    TypedWrong(t, from, "no option, for its first word begins with no dash; allowed: -name value");
  else
    TypedWrong(t, from,
               "\"%.150s\": no option, file, scene or command; allowed: -name value, or what petves help lists", word);
}

static void TypedReadFile(Typed *t, const char *option, const char *path, const Source *outer);

static PetscBool NameHasPart(const char *name, const char *const part[], PetscBool first) {
  for (; *part; part++) {
    const char *found = strcasestr(name, *part);
    if (found && (found == name || !first)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscBool TypedIsOwn(const char *name, const char *value) {
  static const char *const first[] = {"-citations", "-debug",   "-display",  "-dll",      "-draw",   "-glvis",
                                      "-history",   "-info",    "-library",  "-log",      "-malloc", "-memory",
                                      "-mpi",       "-objects", "-on_err",   "-options_", "-petsc",  "-popen",
                                      "-saws",      "-start_",  "-stop_for", "-viewer",   "-x_",     NULL};
  static const char *const any[] = {"python", "_dump", "_draw", "_plot", "tmpdir", NULL};
  static const char *const shows[] = {"_view", "_monitor", "_converged_r", NULL}, *const type[] = {"_type", NULL};
  if (NameHasPart(name, first, PETSC_TRUE) || NameHasPart(name, any, PETSC_FALSE)) return PETSC_TRUE;
  if (!value || !*value) return PETSC_FALSE;
  return NameHasPart(name, shows, PETSC_FALSE) ||
         (NameHasPart(name, type, PETSC_FALSE) && !strcasecmp(value, "python"));
}

/* Ways to give options that PETSc follows without a check of their words. */
static const char *const others[] = {"-options_string_yaml", "-saws", NULL};

/* Whether an option names a file of options. */
static PetscBool NameIsFile(const char *name) {
  return strcasecmp(name, "-options_file") && strcasecmp(name, "-options_file_yaml") ? PETSC_FALSE : PETSC_TRUE;
}

/* The value of an option that names a file, such as -vesicle_file: where the program was started no file has this path,
   but beside the option file that gives it there is one, its path is the value. */
static const char *TypedFileValue(const Source *from, const char *name, const char *value,
                                  char path[PETSC_MAX_PATH_LEN]) {
  const char *const end = strrchr(name, '_'), *const slash = from->line ? strrchr(from->name, '/') : NULL;
  if (!slash || !value || *value == '/' || !access(value, F_OK)) return value;
  if (!NameIsFile(name) && (!end || strcasecmp(end, "_file"))) return value;
  (void)snprintf(path, PETSC_MAX_PATH_LEN, "%.*s%s", (int)(slash + 1 - from->name), from->name, value);
  return access(path, F_OK) ? value : path;
}

/* Pairs of names and values. files: -options_file is to be read (1), left out (-1). */
static void TypedTakeWords(Typed *t, const Source *from, int n, const Word word[], int files) {
  for (int k = 0; k < n && !*t->error;) {
    const char *name = word[k].text, *value = NULL;
    char path[PETSC_MAX_PATH_LEN];
    if (!WordIsName(&word[k])) TypedWrongWord(t, from, NULL, NULL, name);
    if (!*t->error) TypedCheckName(t, from, name);
    if (++k < n && !WordIsName(&word[k])) value = word[k++].text;
    if (!*t->error && k < n && !WordIsName(&word[k])) TypedWrongWord(t, from, name, value, word[k].text);
    if (!*t->error && value && *value == '=' && !word[k - 1].quoted)
      TypedWrong(t, from, "%.60s %.60s: an equals sign; allowed: a blank, as in %.60s %.60s", name, value, name,
                 value[1] ? value + 1 : "VALUE");
    const PetscBool file = NameIsFile(name);
    if (!*t->error && NameHasPart(name, others, PETSC_TRUE))
      TypedWrong(t, from, "%.60s: petves does not read options so; allowed: -options_file, or the command line", name);
    if (!*t->error && !file && from->line && !t->own && TypedIsOwn(name, value))
      TypedWrong(t, from, "%.60s: not for a file, which may come from others; allowed: on the command line", name);
    if (*t->error) return;
    value = TypedFileValue(from, name, value, path);
    if (!file)
      TypedAppend(t, name, value);
    else if (!value)
      TypedWrong(t, from, "%s: given without a value; allowed: a readable file of options", name);
    else if (files > 0)
      TypedReadFile(t, name, value, from);
  }
}

/* Cut a line into words where it is; returns their number, -1: a quote without its end. */
static int TypedCutLine(char *line, Word word[]) {
  int n = 0;
  for (char *p = line;;) {
    p += strspn(p, " \t\f\v");
    if (!*p || *p == '#') return n;
    word[n].quoted = *p == '"' || *p == '\'';
    if (word[n].quoted) {
      const char quote = *p++;
      word[n++].text = p;
      p = strchr(p, quote);
      if (!p) return -1;
    } else {
      word[n++].text = p;
      p += strcspn(p, " \t\f\v");
      if (!*p) return n;
    }
    *p++ = 0;
  }
}

/* Take all words of a line; the line is cut into words. */
static void TypedTakeLine(Typed *t, const Source *from, char *line) {
  Word *word = (Word *)malloc((strlen(line) / 2 + 1) * sizeof(*word));
  const int n = word ? TypedCutLine(line, word) : 0;
  if (n < 0)
    TypedWrong(t, from, "a quote without its end; allowed: \"...\" or '...' around a value");
  else
    TypedTakeWords(t, from, n, word, 1);
  free(word);
}

/* The file's text with a zero behind it, to be freed; NULL and why when it cannot be read. */
static char *TypedFileText(FILE *f, size_t *length, const char **why) {
  char *text = (char *)malloc(MOST_BYTES + 2);
  *why = text ? NULL : "needs too much memory";
  if (!text) return NULL;
  *length = fread(text, 1, MOST_BYTES + 1, f);
  if (ferror(f)) *why = "cannot be read";
  if (*length > MOST_BYTES) *why = "is longer than 16 MB";
  text[*length] = 0;
  if (!*why) return text;
  free(text);
  return NULL;
}

/* Lines of a text that ends with a zero. */
static void TypedTakeText(Typed *t, Source *from, char *text, size_t length) {
  char *copy = (char *)malloc(length + 1), *p = text;
  if (!strncmp(p, "\xef\xbb\xbf", 3)) p += 3;
  for (from->number = 1; copy && p <= text + length && !*t->error; from->number++) {
    char *line = p;
    from->line = NULL;
    while (*p && *p != '\n' && *p != '\r') {
      if (iscntrl((unsigned char)*p) && !isspace((unsigned char)*p)) break;
      p++;
    }
    if ((*p && *p != '\n' && *p != '\r') || (!*p && p < text + length)) {
      (void)snprintf(t->error, sizeof(t->error),
                     "-options_file %.200s: line %d has a byte 0x%02x, which is no text; allowed: a file of options",
                     from->name, from->number, (unsigned char)*p);
      break;
    }
    const PetscBool crlf = *p == '\r' && p[1] == '\n';
    *p = 0;
    p += crlf ? 2 : 1;
    from->line = line;
    TypedTakeLine(t, from, strcpy(copy, line));
  }
  free(copy);
}

/* Options of a text of YAML, as PETSc reads it: nested names are joined with _, lists with commas. */
static void TypedTakeYaml(Typed *t, Source *from, const char *text, size_t length) {
  PetscOptions options = NULL;
  char **name = NULL, **value = NULL;
  PetscInt n = 0;
  PetscErrorCode error = strlen(text) < length ? PETSC_ERR_FILE_READ : PETSC_SUCCESS;
  (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  if (!error) error = PetscOptionsCreate(&options);
  if (!error) error = PetscOptionsInsertStringYAML(options, text);
  if (!error) error = PetscOptionsLeftGet(options, &n, &name, &value);
  (void)PetscPopErrorHandler();
  if (error) TypedWrong(t, from, "cannot be read; allowed: names with values, lists or names of their own in YAML");
  for (PetscInt k = 0; k < 2 * n && !*t->error; k++) { /* the files that it includes, then what is its own */
    char option[MOST_NAME + 2];
    const Word word[2] = {{option, PETSC_FALSE}, {value[k % n], PETSC_TRUE}};
    (void)snprintf(option, sizeof(option), "-%s", name[k % n]);
    from->line = option;
    if (NameIsFile(option) == (k < n)) TypedTakeWords(t, from, word[1].text ? 2 : 1, word, 1);
  }
  if (!error) (void)PetscOptionsLeftRestore(options, &n, &name, &value);
  if (options) (void)PetscOptionsDestroy(&options);
}

/* A file is of YAML by the option that names it, or by its own name. */
static void TypedReadFile(Typed *t, const char *option, const char *path, const Source *outer) {
  const char *const end = strrchr(path, '.');
  const PetscBool named = end && (!strcmp(end, ".yaml") || !strcmp(end, ".yml"));
  Source from = {.outer = outer, .option = option, .name = path};
  const char *why = NULL;
  struct stat status;
  size_t length;
  char *text = NULL;
  FILE *f = fopen(path, "r");
  if (!f || fstat(fileno(f), &status)) {
    why = strerror(errno);
  } else {
    from.device = status.st_dev;
    from.file = status.st_ino;
    for (const Source *s = outer; s && !why; s = s->outer)
      if (s->line && s->device == from.device && s->file == from.file) why = "includes itself";
    if (!why && S_ISDIR(status.st_mode)) why = "is a folder";
    if (!why) text = TypedFileText(f, &length, &why);
  }
  if (!text && outer && outer->number)
    TypedWrong(t, outer, "%s (%s); allowed: a readable file of options", f ? "not read" : "cannot be opened", why);
  else if (!text)
    TypedWrong(t, outer ? outer : &(Source){0}, "%s %.300s: %s (%s); allowed: a readable file of options%s", option,
               path, f ? "not read" : "cannot be opened", why,
               strcmp(option, "-options_file") || strpbrk(path, "./") ? "" : ", or a scene that petves scenes lists");
  else if (named || strcasecmp(option, "-options_file"))
    TypedTakeYaml(t, &from, text, length);
  else
    TypedTakeText(t, &from, text, length);
  free(text);
  if (f) fclose(f);
  TypedAppend(t, "", NULL);
}

void TypedCall(Typed *t, const char path[], PetscInt n, const char *const word[]) {
  if (path) TypedReadFile(t, "-options_file", path, NULL);
  for (PetscInt k = 0; k < n; k++) TypedAppend(t, word[2 * k], word[2 * k + 1]);
}

/* PETSc's own file of the user, if there is one, unless the command line says -skip_petscrc. Those of the folder where
   the program starts are not read: it may come from others. */
static void TypedTakePetscFile(Typed *t, int n, char **word) {
  const char *const home = getenv("HOME");
  char path[PETSC_MAX_PATH_LEN];
  struct stat status;
  for (int k = 0; k < n; k++)
    if (!strcasecmp(word[k], "-skip_petscrc")) return;
  (void)snprintf(path, sizeof(path), "%s/.petscrc", home ? home : "");
  t->own = PETSC_TRUE;
  if (home && !stat(path, &status) && S_ISREG(status.st_mode)) TypedReadFile(t, "-options_file", path, NULL);
  t->own = PETSC_FALSE;
}

static void TypedTakeEnvironment(Typed *t) {
  const Source from = {.name = "PETSC_OPTIONS"};
  const char *const typed = getenv("PETSC_OPTIONS");
  char *line = typed && !*t->error ? strdup(typed) : NULL;
  for (char *p = line; p && *p; p++)
    if (*p == '\n' || *p == '\r') *p = ' ';
  if (line) TypedTakeLine(t, &from, line);
  TypedAppend(t, "", NULL);
  free(line);
}

/* Where the entry after this one begins. */
static size_t TypedNext(const Typed *t, size_t at) {
  const char *const value = t->text + at + strlen(t->text + at) + 1;
  return (size_t)(value + strlen(value) + 1 - t->text);
}

/* Blank the dash of an option of which a later source gives the alternative. */
static void TypedReplace(Typed *t, const char *name, const char *alternative) {
  size_t source = 0, end = 0;
  for (size_t at = 0; at < t->used; at = TypedNext(t, at)) {
    if (!t->text[at]) source = at;
    if (!strcasecmp(t->text + at, alternative)) end = source;
  }
  for (size_t at = 0; at < end; at = TypedNext(t, at))
    if (!strcasecmp(t->text + at, name)) t->text[at] = ' ';
}

void TypedCommand(Typed *t, int n, char **word) {
  const Source from = {.name = NULL};
  Word *words = (Word *)calloc((size_t)n + 1, sizeof(*words));
  if (!words) abort();
  for (int k = 0; k < n; k++) words[k] = (Word){.text = word[k]};
  TypedTakeWords(t, &from, n, words, -1); /* the command line's own mistakes first */
  t->used = 0;
  if (!*t->error) TypedTakePetscFile(t, n, word);
  TypedTakeEnvironment(t);
  for (int k = 0; k + 1 < n && !*t->error; k++)
    if (NameIsFile(word[k])) TypedReadFile(t, word[k], word[k + 1], NULL);
  if (!*t->error) TypedTakeWords(t, &from, n, words, -1);
  free(words);
}

int TypedShare(Typed *t, MPI_Comm comm) {
  unsigned long used = t->used;
  int rank, error;
  MPI_Comm_rank(comm, &rank);
  error = MPI_Bcast(t->error, sizeof(t->error), MPI_CHAR, 0, comm);
  if (!error) error = MPI_Bcast(&used, 1, MPI_UNSIGNED_LONG, 0, comm);
  if (error || *t->error || !used) return error;
  if (rank) {
    free(t->text);
    t->text = (char *)malloc(used);
    t->used = used;
  }
  return MPI_Bcast(t->text, (int)used, MPI_CHAR, 0, comm);
}

PetscErrorCode TypedInsert(Typed *t, const char *const alternatives[][2], PetscOptions options) {
  PetscFunctionBeginUser;
  for (; (*alternatives)[0]; alternatives++)
    for (int k = 0; k < 2; k++) TypedReplace(t, (*alternatives)[k], (*alternatives)[1 - k]);
  for (size_t at = 0; at < t->used; at = TypedNext(t, at)) {
    const char *name = t->text + at, *value = name + strlen(name) + 1;
    if (*name == '-') PetscCall(PetscOptionsSetValue(options, name, *value ? value + 1 : NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void TypedDestroy(Typed *t) {
  free(t->text);
  t->text = NULL;
  t->used = t->room = 0;
}
