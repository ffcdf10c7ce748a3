#include "output/h5.h"

/* Errors inside this file are reported as PETSC_ERR_LIB with the call; the callers' files name the path. */
#define H5Call(call)                                                                                                   \
  do {                                                                                                                 \
    if ((call) < 0) SETERRQ(PETSC_COMM_SELF, PETSC_ERR_LIB, "HDF5: %s failed", #call);                                 \
  } while (0)

PetscErrorCode H5Create(MPI_Comm comm, const char path[], hid_t *file) {
  hid_t access;
  PetscFunctionBeginUser;
  H5Call(H5Eset_auto2(H5E_DEFAULT, NULL, NULL));
  access = H5Pcreate(H5P_FILE_ACCESS);
  H5Call(H5Pset_fapl_mpio(access, comm, MPI_INFO_NULL));
  *file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access);
  H5Call(H5Pclose(access));
  H5Check(*file, comm, path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5Close(MPI_Comm comm, const char path[], hid_t *file) {
  PetscFunctionBeginUser;
  H5Check(H5Fclose(*file), comm, path);
  *file = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PutAttribute(hid_t file, const char name[], hid_t type, PetscInt n, const void *values) {
  const hsize_t size = (hsize_t)n;
  const hid_t space = n == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, NULL);
  hid_t attribute;
  PetscFunctionBeginUser;
  attribute = H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Call(attribute);
  H5Call(H5Awrite(attribute, type, values));
  H5Call(H5Aclose(attribute));
  H5Call(H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5PutReals(hid_t file, const char name[], PetscInt n, const PetscReal values[]) {
  return PutAttribute(file, name, H5T_NATIVE_DOUBLE, n, values);
}

PetscErrorCode H5PutInts(hid_t file, const char name[], PetscInt n, const PetscInt values[]) {
  return PutAttribute(file, name, sizeof(PetscInt) == 8 ? H5T_NATIVE_INT64 : H5T_NATIVE_INT32, n, values);
}

PetscErrorCode H5PutString(hid_t file, const char name[], const char value[]) {
  hid_t type = H5Tcopy(H5T_C_S1);
  PetscFunctionBeginUser;
  H5Call(H5Tset_size(type, strlen(value) + 1));
  PetscCall(PutAttribute(file, name, type, 1, value));
  H5Call(H5Tclose(type));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5CreateSeries(hid_t file, const char name[], int ndims, const PetscInt dims[], PetscInt chunk_rows) {
  hsize_t size[3] = {0, 1, 1}, limit[3] = {H5S_UNLIMITED, 1, 1}, chunk[3] = {1, 1, 1};
  hid_t space, create, link, set;
  PetscFunctionBeginUser;
  for (int d = 0; d < ndims; d++) size[d + 1] = limit[d + 1] = chunk[d + 1] = (hsize_t)dims[d];
  if (!ndims) chunk[0] = 64;
  if (chunk_rows > 0) chunk[1] = PetscMin((hsize_t)chunk_rows, size[1]);
  space = H5Screate_simple(ndims + 1, size, limit);
  create = H5Pcreate(H5P_DATASET_CREATE);
  link = H5Pcreate(H5P_LINK_CREATE);
  H5Call(H5Pset_chunk(create, ndims + 1, chunk));
  H5Call(H5Pset_create_intermediate_group(link, 1));
  set = H5Dcreate2(file, name, H5T_NATIVE_DOUBLE, space, link, create, H5P_DEFAULT);
  H5Call(set);
  H5Call(H5Dclose(set));
  H5Call(H5Pclose(link));
  H5Call(H5Pclose(create));
  H5Call(H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Grow a series to hold entry `index` and write this rank's rows of it (count 0: nothing). */
static PetscErrorCode Append(hid_t file, const char name[], PetscInt index, PetscInt first, PetscInt count,
                             const PetscReal values[]) {
  hsize_t size[3], start[3] = {(hsize_t)index, 0, 0}, part[3];
  hid_t set, space, memory, transfer;
  int ndims;
  PetscFunctionBeginUser;
  set = H5Dopen2(file, name, H5P_DEFAULT);
  H5Call(set);
  space = H5Dget_space(set);
  ndims = H5Sget_simple_extent_dims(space, size, NULL);
  H5Call(H5Sclose(space));
  size[0] = PetscMax(size[0], (hsize_t)index + 1);
  H5Call(H5Dset_extent(set, size));
  space = H5Dget_space(set);
  for (int d = 0; d < 3; d++) part[d] = d < ndims ? size[d] : 1;
  part[0] = 1;
  if (count >= 0 && ndims > 1) {
    start[1] = (hsize_t)first;
    part[1] = (hsize_t)PetscMax(count, 1);
  }
  memory = H5Screate_simple(ndims, part, NULL);
  if (count == 0) {
    H5Call(H5Sselect_none(space));
    H5Call(H5Sselect_none(memory));
  } else
    H5Call(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, part, NULL));
  transfer = H5Pcreate(H5P_DATASET_XFER);
  H5Call(H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE));
  H5Call(H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, space, transfer, values));
  H5Call(H5Pclose(transfer));
  H5Call(H5Sclose(memory));
  H5Call(H5Sclose(space));
  H5Call(H5Dclose(set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5AppendArray(MPI_Comm comm, hid_t file, const char name[], PetscInt index, const PetscReal values[]) {
  PetscMPIInt rank;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(Append(file, name, index, 0, rank ? 0 : -1, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5AppendRows(hid_t file, const char name[], PetscInt index, PetscInt first, PetscInt rows,
                            const PetscReal values[]) {
  PetscFunctionBeginUser;
  PetscCall(Append(file, name, index, first, rows, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}
