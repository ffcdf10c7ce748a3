#include "output/resolved.h"
#include "options/typed.h"
#include <ctype.h>

/* Whether resolved.opts has an option of the database already, or must not have it. */
static PetscBool Skip(const char *name) {
  const char *const never[] = {"-options_file", "-help"};
  for (size_t i = 0; i < sizeof(never) / sizeof(never[0]); i++)
    if (!strcmp(name, never[i])) return PETSC_TRUE;
  for (PetscInt i = 0; SceneOptionName(i); i++)
    if (!strcmp(name, SceneOptionName(i))) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The options of PETSc's own that the user gave: -tension_ksp_monitor, -log_view and so on. Words of values are no
   options of the database. Nor may a file have those that TypedIsOwn names. */
static PetscErrorCode PrintOthers(FILE *f) {
  char *all, *word, *end = NULL;
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetAll(NULL, &all));
  for (word = strtok_r(all, " \n", &end); word; word = strtok_r(NULL, " \n", &end)) {
    const char *value = NULL;
    PetscBool given = PETSC_FALSE;
    if (word[0] != '-' || !isalpha((unsigned char)word[1]) || Skip(word)) continue;
    PetscCall(PetscOptionsFindPair(NULL, NULL, word, &value, &given));
    if (given && !TypedIsOwn(word, value)) OptionPrint(f, word, value ? value : "");
  }
  PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Print(FILE *f, const void *what) {
  const Scheme scheme = (Scheme)what;
  PetscFunctionBeginUser;
  fprintf(f, "# every option in force: mpirun -n RANKS petves -options_file resolved.opts repeats the run\n");
  PetscCall(SceneWriteOptions(scheme->scene, f));
  if (scheme->ops.options) PetscCall(scheme->ops.options(scheme, f));
  PetscCall(PrintOthers(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ResolvedWrite(Folder *folder, Scheme scheme) {
  PetscFunctionBeginUser;
  PetscCall(FolderWriteText(folder, "resolved.opts", Print, scheme));
  PetscFunctionReturn(PETSC_SUCCESS);
}
