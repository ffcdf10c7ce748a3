#include "krylov/kspoptions.h"

PetscErrorCode KSPWriteOptions(KSP ksp, PC pc, const char prefix[], FILE *file) {
  KSPType type;
  PCType pc_type;
  PetscReal rtol, atol, dtol;
  PetscInt max_it;
  PetscBool ilu, shell;
  PetscFunctionBeginUser;
  PetscCall(KSPGetType(ksp, &type));
  PetscCall(KSPGetTolerances(ksp, &rtol, &atol, &dtol, &max_it));
  if (!pc) PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCGetType(pc, &pc_type));
  fprintf(file, "-%sksp_type %s\n-%sksp_rtol %.17g\n-%sksp_atol %.17g\n-%sksp_max_it %" PetscInt_FMT "\n", prefix, type,
          prefix, (double)rtol, prefix, (double)atol, prefix, max_it);
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCSHELL, &shell));
  if (!shell) fprintf(file, "-%spc_type %s\n", prefix, pc_type);
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCILU, &ilu));
  if (ilu) {
    PetscInt levels;
    PetscCall(PCFactorGetLevels(pc, &levels));
    fprintf(file, "-%spc_factor_levels %" PetscInt_FMT "\n", prefix, levels);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
