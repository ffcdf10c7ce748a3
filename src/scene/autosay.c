/* -scheme_auto: how a setting is said. */
#include "scene/auto.h"

/* Numbers, with commas between them, to six digits. */
static void Shorten(char value[], size_t length) {
  char text[128];
  size_t used = 0;
  if (!strchr(value, '.')) return;
  (void)snprintf(text, sizeof(text), "%s", value);
  for (char *at = text, *end = NULL; *at; at = *end ? end + 1 : end) {
    const double number = strtod(at, &end);
    if (end == at || (*end && *end != ',')) return;
    used += (size_t)snprintf(value + used, length - used, "%s%.6g", used ? "," : "", number);
  }
}

PetscErrorCode SceneSaySetting(Scene scene, const char name[], const char why[]) {
  char value[128] = "";
  PetscBool given = SceneGiven(scene, name);
  const PetscInt i = OptionFind(&scene->options, name);
  PetscFunctionBeginUser;
  if (i >= 0) PetscCall(SceneOptionValue(scene, i, value, sizeof(value)));
  if (!strcmp(name, "-coupled_ksp_rtol")) {
    PetscCall(PetscSNPrintf(value, sizeof(value), "%.0e", (double)scene->coupling.ksp_rtol));
    PetscCall(PetscOptionsGetString(NULL, NULL, name, value, sizeof(value), &given));
  }
  Shorten(value, sizeof(value));
  PetscCall(PetvesSay(scene->comm, "  %-20s %-8s %s\n", name, value, given ? "yours" : why));
  PetscFunctionReturn(PETSC_SUCCESS);
}
