/* What the user typed: options of the command line, of PETSC_OPTIONS and of option files. One rank reads them, checks
   every word and gives the others what it found, before PETSc starts: a mistake ends with one line, never inside PETSc.

   A file has an option a line, its value behind it. A value with blanks or # in it stands in quotes, "..." or '...'.
   # at the beginning of a word starts a comment. Lines end with LF, CR LF or CR; a byte-order mark is skipped.
   -options_file includes another file. The files that a file names are looked for where the program was started, then
   beside the file. Files of YAML (-options_file_yaml, or named .yaml or .yml) are read by PETSc's own rules. A file may
   come from others: options of PETSc that start programs, load code or write files are refused in it (TypedIsOwn). */
#pragma once
#include "base/base.h"

typedef struct {
  char *text; /* "-name\0=value\0" or "-name\0\0", one after the other, "\0\0" at the end of a source; NULL: nothing */
  size_t used, room;
  PetscBool own;                  /* what is read is the user's own, as the command line is */
  char error[PETVES_MAX_MESSAGE]; /* what is wrong; empty when nothing is */
} Typed;

/* TypedCommand - what a program starts with, later words before earlier ones: PETSc's file in the user's home
   (.petscrc), PETSC_OPTIONS, option files of the command line, the rest of its n words. Not collective, and before
   PETSc starts. TypedCall - an option file (NULL: none) and what it includes, then n pairs of name and value (NULL:
   without) of a caller. Not collective. TypedIsOwn - whether an option, with
   its dash, and its value (or NULL) are for the user's own words only. */
PETSC_EXTERN void TypedCommand(Typed *typed, int n, char **word);
PETSC_EXTERN void TypedCall(Typed *typed, const char path[], PetscInt n, const char *const word[]);
PETSC_EXTERN PetscBool TypedIsOwn(const char *name, const char *value);

/* TypedShare - what rank 0 has read, or its error, becomes everybody's; returns an MPI error code. Collective.
   TypedInsert - put it into an options database (NULL: the default one), without the options of which a later source
   gives an alternative: pairs of names, the last ones NULL. TypedDestroy - free it. */
PETSC_EXTERN int TypedShare(Typed *typed, MPI_Comm comm);
PETSC_EXTERN PetscErrorCode TypedInsert(Typed *typed, const char *const alternatives[][2], PetscOptions options);
PETSC_EXTERN void TypedDestroy(Typed *typed);
