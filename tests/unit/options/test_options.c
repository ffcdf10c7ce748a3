/* The option table, with rows that mean nothing: values of the user and defaults, lists of any length, text that reads
   back as the value; and a scene of more vesicles than fit in a short list. */
#include "facts.h"

#define MANY 2000 /* numbers, more text than a path may have */
#define VESICLES 40

typedef struct {
  PetscReal real;
  PetscInt integer, choice;
  PetscBool truth;
  char name[OPTION_MAX_NAME], path[PETSC_MAX_PATH_LEN];
  RealList reals;
  IntList ints, words;
} Values;

static const OptionRow rows[] = {{"-t_real", OPT_REAL, offsetof(Values, real), "0.1", ">0", "a number"},
                                 {"-t_integer", OPT_INT, offsetof(Values, integer), "7", ">=0", "an integer"},
                                 {"-t_choice", OPT_ENUM, offsetof(Values, choice), "b", "a|b|c", "a choice"},
                                 {"-t_truth", OPT_BOOL, offsetof(Values, truth), "false", "true|false", "a truth"},
                                 {"-t_name", OPT_NAME, offsetof(Values, name), "one", "one|two", "a name"},
                                 {"-t_path", OPT_PATH, offsetof(Values, path), "", "", "a path"},
                                 {"-t_reals", OPT_REALS, offsetof(Values, reals), "1,2", "any", "numbers"},
                                 {"-t_ints", OPT_INTS, offsetof(Values, ints), "3", "any", "integers"},
                                 {"-t_words", OPT_INTS, offsetof(Values, words), "b,c,a,b", "a|b|c", "words"}};
#define ROWS ((PetscInt)(sizeof(rows) / sizeof(rows[0])))

static PetscBool IsTrue(const void *values) {
  return ((const Values *)values)->truth;
}

static void NameOfChoice(const void *values, char value[OPTION_MAX_NAME]) {
  (void)snprintf(value, OPTION_MAX_NAME, "%s", ((const Values *)values)->choice == 0 ? "two" : "");
}

static const OptionDefault dependent[] = {{"-t_integer", IsTrue, "9", NULL, "it is true", "%s when true"},
                                          {"-t_choice", IsTrue, "a", NULL, "it is true", "%s when true"},
                                          {"-t_name", IsTrue, NULL, NameOfChoice, "the choice is a", NULL},
                                          {NULL}};

/* " -t_reals x,x,..." with 17 digits each. */
static void LongList(PetscReal x[MANY], char **text) {
  unsigned state = 3;
  char *end;
  TestCall(PetscMalloc1(32 * MANY, text));
  end = *text + sprintf(*text, "-t_integer 5 -t_truth -t_reals ");
  for (PetscInt k = 0; k < MANY; k++) {
    x[k] = TestRandom(&state);
    end += sprintf(end, "%s%.17g", k ? "," : "", x[k]);
  }
}

/* Every value as text, read again, is the same text. */
static void CheckText(const OptionTable *table, Values *values) {
  for (PetscInt i = 0; i < ROWS; i++) {
    char *text, *again, part[8];
    void *place = (char *)values + rows[i].offset;
    PetscBool same;
    TestCall(OptionText(table, values, i, &text));
    TestCall(OptionValue(table, values, i, part, sizeof(part)));
    CHECK(!strncmp(part, text, 7) && strlen(part) == PetscMin(strlen(text), (size_t)7), "%s: its value, cut: %s",
          rows[i].name, part);
    if (*text) TestCall(OptionParse(PETSC_COMM_WORLD, &rows[i], text, place));
    TestCall(OptionText(table, values, i, &again));
    TestCall(PetscStrcmp(text, again, &same));
    CHECK(same, "%s: %zu characters read back to the same text", rows[i].name, strlen(text));
    TestCall(PetscFree(text));
    TestCall(PetscFree(again));
  }
}

static void CheckTable(void) {
  Values v = {0};
  OptionTable table;
  PetscReal x[MANY];
  char *text, help[OPTION_HELP];
  LongList(x, &text);
  TestCall(PetscOptionsClear(NULL));
  TestCall(PetscOptionsInsertString(NULL, text));
  TestCall(PetscFree(text));
  TestCall(OptionsRead(PETSC_COMM_WORLD, "test", ROWS, rows, dependent, &table, &v));
  CHECK(v.real == 0.1 && v.choice == 1 && !strcmp(v.name, "one") && !*v.path && v.ints.n == 1 && v.ints.v[0] == 3,
        "defaults where nothing is given");
  CHECK(v.words.n == 4 && v.words.v[0] == 1 && v.words.v[1] == 2 && !v.words.v[2] && v.words.v[3] == 1,
        "a list of words is their indices");
  CHECK(v.integer == 5 && v.truth, "the user's values");
  CHECK(v.reals.n == MANY && TestFar(MANY, v.reals.v, x) == 0, "a list of %d numbers, to the bit", MANY);
  CHECK(OptionGiven(&table, "-t_reals") && !OptionGiven(&table, "-t_real") && !OptionGiven(&table, "-t_other"),
        "what is given and what is not");
  CHECK(OptionFind(&table, "-t_path") == 5 && OptionFind(&table, "-t_pat") < 0, "found by the whole name");
  TestCall(OptionChoose(&table, &v, "-t_integer", "9"));
  TestCall(OptionChoose(&table, &v, "-t_choice", "c"));
  CHECK(v.integer == 5 && v.choice == 2, "a choice takes the place of a default, not of what is given");
  TestCall(OptionsDepend(&table, &v));
  CHECK(v.integer == 5 && v.choice == 0 && !strcmp(v.name, "two"), "dependent defaults, one after another");
  OptionHelpText(&rows[2], dependent, help);
  CHECK(!strcmp(help, "a choice; a when true"), "help with a dependent default: %s", help);
  CheckText(&table, &v);
  TestCall(OptionsDestroy(&table, &v));
}

/* A row of vesicles, each where its own pair of numbers puts it. */
static void CheckScene(void) {
  Scene scene;
  char *options, *end;
  PetscReal off = 0;
  TestCall(PetscMalloc1(64 * VESICLES, &options));
  end = options + sprintf(options,
                          "-domain_box 0,%d,0,1 -domain_cells %d,32 -vesicle_semi_axes 0.3,0.2 -vesicle_count %d "
                          "-vesicle_center ",
                          VESICLES, 32 * VESICLES, VESICLES);
  for (int v = 0; v < VESICLES; v++) end += sprintf(end, "%s%g,0.5", v ? "," : "", v + 0.5);
  TestScene(&scene, "%s", options);
  TestCall(PetscFree(options));
  for (PetscInt v = 0; v < scene->shape.vesicles; v++) {
    const PetscReal *X = scene->shape.X + 2 * scene->shape.start[v]; /* the end of the first semi-axis */
    TestWorse(&off, PetscAbsReal(X[0] - (v + 0.8)) + PetscAbsReal(X[1] - 0.5));
  }
  CHECK(scene->shape.vesicles == VESICLES && off < 1e-12, "%d vesicles in their places, %.1e", VESICLES, off);
  TestCall(SceneDestroy(&scene));
}

void Facts(void) {
  CheckTable();
  CheckScene();
}
