/* A table of options, each once with its type, default, range and help. -help, the checks of single values, the text of
   a value in force and the "did you mean" of a misspelt name all come from it. What the options mean is not known here:
   their values go into a struct of the caller's, at the offsets of the rows. */
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

/* What a row's offset holds: PetscReal, PetscInt, PetscBool, PetscInt (index in the range's list),
   char[OPTION_MAX_NAME], char[PETSC_MAX_PATH_LEN], RealList, IntList. */
typedef enum { OPT_REAL, OPT_INT, OPT_BOOL, OPT_ENUM, OPT_NAME, OPT_PATH, OPT_REALS, OPT_INTS } OptionType;

typedef struct {
  const char *name; /* with its dash */
  OptionType type;
  size_t offset;
  const char *value; /* default, as a user would write it */
  const char *range; /* ">0", ">=0", "(0,1)", "any"; for enums and names "a|b|c"; for lists the same for each entry */
  const char *help;
} OptionRow;

typedef struct {
  MPI_Comm comm;
  PetscInt n;
  const OptionRow *row; /* [n], borrowed */
  PetscBool *given;     /* [n], whether the user gave it */
} OptionTable;

/* OptionsRead - make the table of n rows and read each option of the options database, or its default, into values.
   Fills in -help under the title. Collective. A value that cannot be read or is out of its range is the user's mistake.
   OptionsDestroy - free the table and the lists in values. */
PETSC_EXTERN PetscErrorCode OptionsRead(MPI_Comm comm, const char title[], PetscInt n, const OptionRow row[],
                                        OptionTable *table, void *values);
PETSC_EXTERN PetscErrorCode OptionsDestroy(OptionTable *table, void *values);

/* OptionFind - index of the option ("-name"), or -1. OptionGiven - whether the user gave it. Not collective. */
PETSC_EXTERN PetscInt OptionFind(const OptionTable *table, const char name[]);
PETSC_EXTERN PetscBool OptionGiven(const OptionTable *table, const char name[]);

/* OptionChoose - give an option a value that the user has not given: what was given stays. */
PETSC_EXTERN PetscErrorCode OptionChoose(const OptionTable *table, void *values, const char name[], const char text[]);

/* OptionText - the i-th option's value in force as text, to be freed with PetscFree. OptionValue - the same, cut to
   length - 1 characters. Not collective. */
PETSC_EXTERN PetscErrorCode OptionText(const OptionTable *table, const void *values, PetscInt i, char **text);
PETSC_EXTERN PetscErrorCode OptionValue(const OptionTable *table, const void *values, PetscInt i, char text[],
                                        size_t length);

/* OptionPrint - one line of an options file, "-name value"; a value with blanks, # or ' goes between double quotes. A
   value that no options file can hold is no value of a table (OptionParse refuses it). Not collective. */
PETSC_EXTERN void OptionPrint(FILE *file, const char name[], const char value[]);

/* OptionHelp - a row for a reader: "  -name default  [range]", and its help below in lines that begin with six blanks.
   Not collective. */
PETSC_EXTERN void OptionHelp(FILE *file, const OptionRow *row);

/* OptionsWrite - write every option in force that has a value, defaults included, one "-name value" a line; but not
   those in skip, whose last entry is NULL. */
PETSC_EXTERN PetscErrorCode OptionsWrite(const OptionTable *table, const void *values, const char *const skip[],
                                         FILE *file);

/* Options of a solver begin with its prefix ("-tension_"); `need` is the option of the table, and its value, with which
   the solver is there. A list ends with NULL. */
typedef struct {
  const char *prefix, *need;
} OptionOwner;

/* What a name asks for that is none: the whole name ("-dt"), or words in it ("*inflow"), and what to say. Where words
   are in the name of an option too, that option is meant. A list ends with NULL. */
typedef struct {
  const char *name, *say;
} OptionWish;

/* OptionsCheckUnused - stop when the options database holds an option that nothing has read: one of a solver that is
   not there, by `owners` and the values in force, or one that there is not, with what `wishes` say, or the name of the
   table or of `others` (last entry NULL) that is meant, if one is near.
   Call when everything is set up. Collective. */
PETSC_EXTERN PetscErrorCode OptionsCheckUnused(const OptionTable *table, const void *values, const char *const others[],
                                               const OptionOwner owners[], const OptionWish wishes[]);

/* OptionParse - text into the place of a row's value. Collective: a text that does not fit is the user's mistake.
   OptionFormat - the value as text, to be freed with PetscFree. */
PETSC_EXTERN PetscErrorCode OptionParse(MPI_Comm comm, const OptionRow *row, const char text[], void *place);
PETSC_EXTERN PetscErrorCode OptionFormat(const OptionRow *row, const void *place, char **text);

/* OptionsTryLate - read now what PETSc reads when a run is over (-log_view, -options_left, -options_view): a mistake in
   it would be found only then. Collective. Errors: no such viewer, a file that cannot be written. */
PETSC_EXTERN PetscErrorCode OptionsTryLate(const OptionTable *table);
