#include "output/h5plain.h"

static herr_t Look(hid_t group, const char *name, const H5L_info_t *info, void *plain) {
  if (info->type != H5L_TYPE_HARD) *(PetscBool *)plain = PETSC_FALSE;
  return 0;
}

PetscErrorCode H5CheckLinks(H5File *f, PetscBool *plain) {
  PetscMPIInt good = 1;
  PetscFunctionBeginUser;
  *plain = PETSC_TRUE;
  if (!f->rank && !f->failed && H5Lvisit(f->id, H5_INDEX_NAME, H5_ITER_NATIVE, Look, plain) < 0) *plain = PETSC_FALSE;
  good = *plain ? 1 : 0;
  PetscCallMPI(MPI_Bcast(&good, 1, MPI_INT, 0, f->comm));
  *plain = good ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chunks of whole entries, without filters and with nothing outside of the file. */
static PetscBool StoredPlainly(hid_t set, int ndims, const hsize_t size[]) {
  const hid_t how = H5Dget_create_plist(set);
  hsize_t chunk[3] = {0, 0, 0};
  PetscBool plain = how >= 0 && H5Pget_layout(how) == H5D_CHUNKED && !H5Pget_external_count(how) &&
                            !H5Pget_nfilters(how) && H5Pget_chunk(how, 3, chunk) == ndims + 1
                        ? PETSC_TRUE
                        : PETSC_FALSE;
  for (int d = 0; d <= ndims && plain; d++) plain = chunk[d] == size[d] ? PETSC_TRUE : PETSC_FALSE;
  if (how >= 0) (void)H5Pclose(how);
  return plain;
}

void H5CheckEntry(H5File *f, const char name[], int ndims, const PetscInt dims[]) {
  hsize_t size[3] = {0, 0, 0};
  PetscBool fits = PETSC_FALSE;
  if (f->rank || f->failed) return;
  const hid_t set = H5Dopen2(f->id, name, H5P_DEFAULT), space = set < 0 ? -1 : H5Dget_space(set);
  if (space >= 0 && H5Sget_simple_extent_ndims(space) == ndims + 1 &&
      H5Sget_simple_extent_dims(space, size, NULL) == ndims + 1)
    fits = size[0] == 1 ? StoredPlainly(set, ndims, size) : PETSC_FALSE;
  for (int d = 0; d < ndims && fits; d++) fits = size[d + 1] == (hsize_t)dims[d] ? PETSC_TRUE : PETSC_FALSE;
  if (space >= 0) (void)H5Sclose(space);
  if (set >= 0) (void)H5Dclose(set);
  if (!fits) f->failed = PETSC_TRUE;
}
