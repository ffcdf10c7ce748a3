/* Arrays that grow, and the memory that the BLAS takes for itself. */
#include "base/base.h"
#include <petscblaslapack.h>
#include <sys/mman.h>

/* MiB that must be free: OpenBLAS 0.3.21 maps 128 MiB at its first call and keeps them. */
#define BLAS_MIB 160

PetscErrorCode ArrayReserveBytes(size_t count, size_t bytes, size_t *capacity, void *array) {
  PetscFunctionBeginUser;
  if (count <= *capacity) PetscFunctionReturn(PETSC_SUCCESS);
  *capacity = count + count / 4 + 8;
  PetscCall(PetscRealloc(*capacity * bytes, (void **)array));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PetvesWarmUpBlas(MPI_Comm comm) {
  static PetscBool done = PETSC_FALSE;
  const PetscBLASInt n = 16;
  const PetscScalar zero = 0;
  PetscScalar a[256] = {0}, c[256];
  PetscMPIInt lacking = 0;
  PetscFunctionBeginUser;
  if (done) PetscFunctionReturn(PETSC_SUCCESS);
  void *const room = mmap(NULL, (size_t)BLAS_MIB << 20, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  lacking = room == MAP_FAILED;
  if (!lacking) (void)munmap(room, (size_t)BLAS_MIB << 20);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &lacking, 1, MPI_INT, MPI_MAX, comm));
  PetvesCheck(!lacking, comm,
              "out of memory: no %d MiB for the BLAS on a rank; allowed: a larger limit (ulimit -v), or fewer ranks",
              BLAS_MIB);
  PetscCallBLAS("BLASgemm", BLASgemm_("N", "N", &n, &n, &n, &zero, a, &n, a, &n, &zero, c, &n));
  done = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
