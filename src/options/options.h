/* A table of options, each once with its type, default, range, help and what it needs to mean something, and a table of
   the defaults that depend on other options. -help, the checks of single values, the text of a value in force, the
   refusal of an option without use and the "did you mean" of a misspelt name all come from them. What the options mean
   is not known here: their values go into a struct of the caller's, at the offsets of the rows. */
#pragma once
#include "base/base.h"

#define OPTION_MAX_NAME 32

/* Lists of any length. */
typedef struct {
  PetscInt n;
  PetscReal *v; /* [n] */
} RealList;
typedef struct {
  PetscInt n;
  PetscInt *v; /* [n] */
} IntList;

/* ListEntry - number `component` of entry `entry` of a list with `each` numbers an entry, or the same for all.
   ListLargest - the largest number of a list, at least 0. Not collective. */
PETSC_EXTERN PetscReal ListEntry(const RealList *list, PetscInt each, PetscInt entry, PetscInt component);
PETSC_EXTERN PetscReal ListLargest(const RealList *list);

/* What a row's offset holds: PetscReal, PetscInt, PetscBool, PetscInt (index in the range's list),
   char[OPTION_MAX_NAME], char[PETSC_MAX_PATH_LEN] (a file, or any text), RealList, IntList (where the range is
   a list, of indices in it). */
typedef enum { OPT_REAL, OPT_INT, OPT_BOOL, OPT_ENUM, OPT_NAME, OPT_PATH, OPT_TEXT, OPT_REALS, OPT_INTS } OptionType;

/* What has to be there for an option to mean something: an enum in the values that is one of some, a condition, or a
   number above 0. */
typedef struct {
  const char *what; /* for a message: "-flow_type shear or extension" */
  size_t offset;    /* of a PetscInt, and */
  unsigned any_of;  /* bit k: the value k is one of those; where it is 0: */
  PetscBool (*met)(const void *values);
  size_t positive; /* where it is NULL: the offset of a PetscReal */
} OptionNeed;

typedef struct {
  const char *name; /* with its dash */
  OptionType type;
  size_t offset;
  const char *value; /* default, as a user would write it */
  const char *range; /* ">0", ">=0", "(0,1)", "any"; for enums and names "a|b|c"; for lists the same for each entry */
  const char *help;
  const OptionNeed *need; /* NULL: none */
  PetscBool may_change;   /* between a run and one that goes on from its checkpoint */
  PetscInt group;         /* for OptionTable.missing */
} OptionRow;

/* A default that depends on other options, in place of its row's. A table of them ends with a row without a name. */
typedef struct {
  const char *name;                                              /* of the option, with its dash */
  PetscBool (*when)(const void *values);                         /* the condition */
  const char *value;                                             /* as a user would write it, or NULL: */
  void (*find)(const void *values, char value[OPTION_MAX_NAME]); /* empty: the row's default stays */
  const char *why;                                               /* the reason */
  const char *help;                                              /* behind the row's, %s: the value; NULL: none */
} OptionDefault;

typedef struct {
  MPI_Comm comm;
  PetscInt n;
  const OptionRow *row;           /* [n], borrowed */
  const OptionDefault *dependent; /* borrowed */
  PetscBool *given;               /* [n], whether the user gave it */
  /* what has to be there for a whole group of rows, for a message, or NULL: it is there. NULL: no groups */
  const char *(*missing)(const OptionRow *row, const void *values);
} OptionTable;

/* OptionsRead - make the table of n rows and read each option of the options database, or its default, into values.
   Fills in -help under the title. Collective. A value that cannot be read or is out of its range is the user's mistake.
   OptionsDestroy - free the table and the lists in values. */
PETSC_EXTERN PetscErrorCode OptionsRead(MPI_Comm comm, const char title[], PetscInt n, const OptionRow row[],
                                        const OptionDefault dependent[], OptionTable *table, void *values);
PETSC_EXTERN PetscErrorCode OptionsDestroy(OptionTable *table, void *values);

/* OptionFind - index of the option ("-name"), or -1. OptionGiven - whether the user gave it. Not collective. */
PETSC_EXTERN PetscInt OptionFind(const OptionTable *table, const char name[]);
PETSC_EXTERN PetscBool OptionGiven(const OptionTable *table, const char name[]);

/* OptionChoose - give an option a value that the user has not given: what was given stays. OptionsDepend - choose all
   dependent defaults whose condition holds. OptionDepends - whether one of them is in force, and its value. Collective.
 */
PETSC_EXTERN PetscErrorCode OptionChoose(const OptionTable *table, void *values, const char name[], const char text[]);
PETSC_EXTERN PetscErrorCode OptionsDepend(const OptionTable *table, void *values);
PETSC_EXTERN PetscBool OptionDepends(const OptionTable *table, const void *values, const OptionDefault *dependent,
                                     char value[OPTION_MAX_NAME]);

/* OptionMissing - what an option needs and is not there, for a message; NULL: nothing. Not collective. OptionsCheckUsed
   - stop when the user gave one that needs something. Collective. */
PETSC_EXTERN const char *OptionMissing(const OptionTable *table, const OptionRow *row, const void *values);
PETSC_EXTERN PetscErrorCode OptionsCheckUsed(const OptionTable *table, const void *values);

/* OptionText - the i-th option's value in force as text, to be freed with PetscFree. OptionValue - the same, cut to
   length - 1 characters. Not collective. */
PETSC_EXTERN PetscErrorCode OptionText(const OptionTable *table, const void *values, PetscInt i, char **text);
PETSC_EXTERN PetscErrorCode OptionValue(const OptionTable *table, const void *values, PetscInt i, char text[],
                                        size_t length);

/* OptionPrint - one line of an options file, "-name value"; a value with blanks, # or ', or with a dash that would
   begin an option, goes between double quotes. A value that no options file can hold is no value of a table
   (OptionParse refuses it). Not collective. */
PETSC_EXTERN void OptionPrint(FILE *file, const char name[], const char value[]);

/* OptionHelp - a row for a reader: "  -name default  [range]", and its help below in lines that begin with six blanks.
   OptionHelpText - the help of a row and of its dependent defaults. Not collective, and also before PETSc starts. */
#define OPTION_HELP 512
PETSC_EXTERN void OptionHelp(FILE *file, const OptionRow *row, const OptionDefault dependent[]);
PETSC_EXTERN void OptionHelpText(const OptionRow *row, const OptionDefault dependent[], char text[OPTION_HELP]);

/* OptionsWrite - write every option in force that is used and has a value, defaults included, one "-name value" a line;
   but not those in skip, whose last entry is NULL. */
PETSC_EXTERN PetscErrorCode OptionsWrite(const OptionTable *table, const void *values, const char *const skip[],
                                         FILE *file);

/* Options of a solver begin with its prefix ("-tension_"); the solver is there when the option `name` of the table has
   the value. A list ends with NULL. */
typedef struct {
  const char *prefix, *name, *value;
} OptionOwner;

/* What names ask for that are none, and what to say. Between blanks: a whole name ("-dt"), or words in it ("*inflow").
   Where words are in the name of an option too, that option is meant. A list ends with NULL. */
typedef struct {
  const char *names, *say;
} OptionSuggestion;

/* OptionsCheckUnused - stop when the options database holds an option that nothing has read: one of a solver that is
   not there, by `owners` and the values in force, or one that there is not, with what `suggestions` say, or the name of
   the table or of `others` (last entry NULL) that is meant, if one is near.
   Call when everything is set up. Collective. */
PETSC_EXTERN PetscErrorCode OptionsCheckUnused(const OptionTable *table, const void *values, const char *const others[],
                                               const OptionOwner owners[], const OptionSuggestion suggestions[]);

/* OptionParse - text into the place of a row's value. Collective: a text that does not fit is the user's mistake. */
PETSC_EXTERN PetscErrorCode OptionParse(MPI_Comm comm, const OptionRow *row, const char text[], void *place);

/* OptionsTryLate - read now what PETSc reads when a run is over (-log_view, -options_left, -options_view): a mistake in
   it would be found only then. Collective. Errors: no such viewer, a file that cannot be written. */
PETSC_EXTERN PetscErrorCode OptionsTryLate(const OptionTable *table);
