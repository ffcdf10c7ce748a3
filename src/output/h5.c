#define _GNU_SOURCE /* memfd_create */
#include "output/h5.h"
#include "output/h5place.h"
#include <sys/mman.h>
#include <unistd.h>

/* A call on rank 0's file, once all before it were good. */
#define Try(file, call)                                                                                                \
  do {                                                                                                                 \
    if (!(file)->failed && ((call) < 0 || H5PlaceLost())) (file)->failed = PETSC_TRUE;                                 \
  } while (0)

static PetscErrorCode Start(MPI_Comm comm, const char path[], H5File *f) {
  PetscFunctionBeginUser;
  f->comm = comm;
  f->id = -1;
  f->failed = PETSC_FALSE;
  PetscCallMPI(MPI_Comm_rank(comm, &f->rank));
  PetscCall(PetscStrncpy(f->path, path, sizeof(f->path)));
  if (!f->rank) (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* No cache of chunks: a write that fails does so in H5Dwrite, not when the dataset is closed, which HDF5
   cannot undo. */
static hid_t Access(void) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  (void)H5Pset_cache(access, 0, 0, 0, 0);
  H5PlaceDriver(access);
  return access;
}

PetscErrorCode H5FileCreate(MPI_Comm comm, const char path[], H5File *f) {
  PetscFunctionBeginUser;
  PetscCall(Start(comm, path, f));
  if (!f->rank) {
    const hid_t access = Access();
    (void)unlink(path); /* a link: what it leads to is not the run's */
    Try(f, f->id = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access));
    (void)H5Pclose(access);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5FileOpen(MPI_Comm comm, const char path[], PetscBool write, H5File *f) {
  PetscFunctionBeginUser;
  PetscCall(Start(comm, path, f));
  if (!f->rank) {
    const hid_t access = Access();
    Try(f, f->id = H5Fopen(path, write ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access));
    (void)H5Pclose(access);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5FileFlush(H5File *f) {
  PetscFunctionBeginUser;
  if (!f->rank) Try(f, H5Fflush(f->id, H5F_SCOPE_GLOBAL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* HDF5 cannot give up a file whose disk is full: closing it fails, and the library crashes at the end. So what it still
   wants to write to a failed file goes into memory instead. */
static void Redirect(hid_t file) {
  void *handle;
  const int memory = memfd_create("petves", 0);
  if (memory >= 0 && H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) >= 0) (void)dup2(memory, *(int *)handle);
  if (memory >= 0) (void)close(memory);
}

PetscErrorCode H5FileClose(H5File *f) {
  PetscFunctionBeginUser;
  if (f->id < 0) PetscFunctionReturn(PETSC_SUCCESS);
  if (H5Fflush(f->id, H5F_SCOPE_GLOBAL) < 0 || H5PlaceLost()) f->failed = PETSC_TRUE;
  if (f->failed) Redirect(f->id);
  if (H5Fclose(f->id) < 0 || H5PlaceLost()) f->failed = PETSC_TRUE;
  f->id = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5FileFailed(const H5File *f, PetscBool *failed) {
  PetscMPIInt bad = f->failed;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&bad, 1, MPI_INT, 0, f->comm));
  *failed = bad ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static hid_t IntType(void) {
  return sizeof(PetscInt) == 8 ? H5T_NATIVE_INT64 : H5T_NATIVE_INT32;
}

/* Numbers that an attribute may have: HDF5 keeps no more than 64 KiB with an object. More are a dataset of the name. */
#define ATTRIBUTE_NUMBERS 8000

static void PutDataset(H5File *f, const char name[], hid_t type, int ndims, const hsize_t size[], const void *values) {
  const hid_t link = H5Pcreate(H5P_LINK_CREATE);
  hid_t space = -1, set = -1;
  Try(f, H5Pset_create_intermediate_group(link, 1));
  Try(f, space = H5Screate_simple(ndims, size, NULL));
  Try(f, set = H5Dcreate2(f->id, name, type, space, link, H5P_DEFAULT, H5P_DEFAULT));
  Try(f, H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
  if (set >= 0) Try(f, H5Dclose(set));
  if (space >= 0) Try(f, H5Sclose(space));
  (void)H5Pclose(link);
}

static void GetDataset(H5File *f, const char name[], hid_t type, PetscInt n, void *values) {
  hid_t set = -1, space = -1;
  Try(f, set = H5Dopen2(f->id, name, H5P_DEFAULT));
  Try(f, space = H5Dget_space(set));
  Try(f, H5Sget_simple_extent_npoints(space) == n ? 0 : -1);
  Try(f, H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
  if (space >= 0) (void)H5Sclose(space);
  if (set >= 0) (void)H5Dclose(set);
}

static PetscErrorCode PutAttribute(H5File *f, const char name[], hid_t type, PetscInt n, const void *values) {
  const hsize_t size = (hsize_t)n;
  hid_t space = -1, attribute = -1;
  PetscFunctionBeginUser;
  if (f->rank || f->failed) PetscFunctionReturn(PETSC_SUCCESS);
  if (n > ATTRIBUTE_NUMBERS) {
    PutDataset(f, name, type, 1, &size, values);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  Try(f, space = n == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, NULL));
  Try(f, attribute = H5Acreate2(f->id, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
  Try(f, H5Awrite(attribute, type, values));
  if (attribute >= 0) Try(f, H5Aclose(attribute));
  if (space >= 0) Try(f, H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5PutReals(H5File *f, const char name[], PetscInt n, const PetscReal values[]) {
  return PutAttribute(f, name, H5T_NATIVE_DOUBLE, n, values);
}

PetscErrorCode H5PutInts(H5File *f, const char name[], PetscInt n, const PetscInt values[]) {
  return PutAttribute(f, name, IntType(), n, values);
}

PetscErrorCode H5PutRows(H5File *f, const char name[], PetscInt rows, PetscInt n, const PetscReal values[]) {
  const hsize_t size[2] = {(hsize_t)rows, (hsize_t)n};
  if (!f->rank && !f->failed) PutDataset(f, name, H5T_NATIVE_DOUBLE, 2, size, values);
  return PETSC_SUCCESS;
}

PetscErrorCode H5PutString(H5File *f, const char name[], const char value[]) {
  hid_t type;
  PetscFunctionBeginUser;
  if (f->rank || f->failed) PetscFunctionReturn(PETSC_SUCCESS);
  type = H5Tcopy(H5T_C_S1);
  Try(f, H5Tset_size(type, strlen(value) + 1));
  PetscCall(PutAttribute(f, name, type, 1, value));
  (void)H5Tclose(type);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An attribute of n numbers of the given type, on rank 0. */
static void GetAttribute(H5File *f, const char name[], hid_t type, PetscInt n, void *values) {
  hid_t attribute = -1, space = -1;
  if (f->rank || f->failed) return;
  if (n > ATTRIBUTE_NUMBERS) {
    GetDataset(f, name, type, n, values);
    return;
  }
  Try(f, attribute = H5Aopen(f->id, name, H5P_DEFAULT));
  Try(f, space = H5Aget_space(attribute));
  Try(f, H5Sget_simple_extent_npoints(space) == n ? 0 : -1);
  Try(f, H5Aread(attribute, type, values));
  if (space >= 0) (void)H5Sclose(space);
  if (attribute >= 0) (void)H5Aclose(attribute);
}

PetscErrorCode H5GetReals(H5File *f, const char name[], PetscInt n, PetscReal values[]) {
  PetscFunctionBeginUser;
  GetAttribute(f, name, H5T_NATIVE_DOUBLE, n, values);
  PetscCallMPI(MPI_Bcast(values, (PetscMPIInt)n, MPIU_REAL, 0, f->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5GetInts(H5File *f, const char name[], PetscInt n, PetscInt values[]) {
  PetscFunctionBeginUser;
  GetAttribute(f, name, IntType(), n, values);
  PetscCallMPI(MPI_Bcast(values, (PetscMPIInt)n, MPIU_INT, 0, f->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5GetString(H5File *f, const char name[], size_t length, char value[]) {
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(value, (PetscInt)length));
  if (!f->rank && !f->failed && H5Aexists(f->id, name) > 0) {
    hid_t type = H5Tcopy(H5T_C_S1);
    Try(f, H5Tset_size(type, length));
    GetAttribute(f, name, type, 1, value);
    (void)H5Tclose(type);
  }
  PetscCallMPI(MPI_Bcast(value, (PetscMPIInt)length, MPI_CHAR, 0, f->comm));
  value[length - 1] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Characters in one attribute of a text: HDF5 allows 64 KiB. The pieces are name, name_1, name_2 and so on. */
#define PIECE 32000

static PetscErrorCode PieceName(const char name[], int k, char piece[64]) {
  PetscFunctionBeginUser;
  PetscCall(k ? PetscSNPrintf(piece, 64, "%s_%d", name, k) : PetscStrncpy(piece, name, 64));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5PutText(H5File *f, const char name[], const char value[]) {
  const size_t length = strlen(value);
  char part[PIECE + 1], piece[64];
  PetscFunctionBeginUser;
  for (int k = 0; !k || (size_t)k * PIECE < length; k++) {
    PetscCall(PieceName(name, k, piece));
    PetscCall(PetscStrncpy(part, value + (size_t)k * PIECE, sizeof(part)));
    PetscCall(H5PutString(f, piece, part));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5GetText(H5File *f, const char name[], char **value) {
  char part[PIECE + 1], piece[64];
  size_t length = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, value));
  for (int k = 0; length == (size_t)k * PIECE; k++) {
    PetscCall(PieceName(name, k, piece));
    PetscCall(H5GetString(f, piece, sizeof(part), part));
    PetscCall(PetscRealloc(length + strlen(part) + 1, value));
    PetscCall(PetscStrncpy(*value + length, part, strlen(part) + 1));
    length += strlen(part);
    if (!*part) break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(H5File *f, const char name[], hid_t type, int ndims, const PetscInt dims[]) {
  hsize_t size[3] = {0, 1, 1}, limit[3] = {H5S_UNLIMITED, 1, 1}, chunk[3] = {1, 1, 1};
  hid_t space, create, link, set = -1;
  PetscFunctionBeginUser;
  if (f->rank || f->failed) PetscFunctionReturn(PETSC_SUCCESS);
  for (int d = 0; d < ndims; d++) size[d + 1] = limit[d + 1] = chunk[d + 1] = (hsize_t)dims[d];
  if (!ndims) chunk[0] = 64;
  space = H5Screate_simple(ndims + 1, size, limit);
  create = H5Pcreate(H5P_DATASET_CREATE);
  link = H5Pcreate(H5P_LINK_CREATE);
  Try(f, H5Pset_chunk(create, ndims + 1, chunk));
  Try(f, H5Pset_create_intermediate_group(link, 1));
  Try(f, set = H5Dcreate2(f->id, name, type, space, link, create, H5P_DEFAULT));
  if (set >= 0) Try(f, H5Dclose(set));
  (void)H5Pclose(link);
  (void)H5Pclose(create);
  (void)H5Sclose(space);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5CreateSeries(H5File *f, const char name[], int ndims, const PetscInt dims[]) {
  return Create(f, name, H5T_NATIVE_DOUBLE, ndims, dims);
}

PetscErrorCode H5CreateSingleSeries(H5File *f, const char name[], int ndims, const PetscInt dims[]) {
  return Create(f, name, H5T_NATIVE_FLOAT, ndims, dims);
}

/* A series, and its size, on rank 0; -1 when there is none. */
static hid_t OpenSeries(H5File *f, const char name[], int *ndims, hsize_t size[3]) {
  hid_t set = -1, space = -1;
  Try(f, set = H5Dopen2(f->id, name, H5P_DEFAULT));
  Try(f, space = H5Dget_space(set));
  Try(f, *ndims = H5Sget_simple_extent_ndims(space));
  Try(f, *ndims >= 1 && *ndims <= 3 ? 0 : -1);
  Try(f, H5Sget_simple_extent_dims(space, size, NULL));
  if (space >= 0) (void)H5Sclose(space);
  if (f->failed && set >= 0) (void)H5Dclose(set);
  return f->failed ? -1 : set;
}

PetscErrorCode H5SeriesLength(H5File *f, const char name[], PetscInt *length) {
  hsize_t size[3] = {0, 0, 0};
  int ndims;
  PetscFunctionBeginUser;
  if (!f->rank && !f->failed) {
    const hid_t set = OpenSeries(f, name, &ndims, size);
    if (set >= 0) (void)H5Dclose(set);
  }
  *length = (PetscInt)size[0];
  PetscCallMPI(MPI_Bcast(length, 1, MPIU_INT, 0, f->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5TruncateSeries(H5File *f, const char name[], PetscInt length) {
  hsize_t size[3];
  int ndims;
  PetscFunctionBeginUser;
  if (f->rank || f->failed) PetscFunctionReturn(PETSC_SUCCESS);
  const hid_t set = OpenSeries(f, name, &ndims, size);
  if (set < 0) PetscFunctionReturn(PETSC_SUCCESS);
  size[0] = PetscMin(size[0], (hsize_t)length);
  Try(f, H5Dset_extent(set, size));
  Try(f, H5Dclose(set));
  PetscFunctionReturn(PETSC_SUCCESS);
}

unsigned long long H5FramePlace(H5File *f, const char name[], PetscInt index) {
  hsize_t size[3], start[3] = {(hsize_t)index, 0, 0};
  haddr_t place;
  int ndims = 1;
  if (f->failed) return 0;
  const hid_t set = OpenSeries(f, name, &ndims, size);
  if (set < 0) return 0;
  place = H5PlaceOf(set, ndims, start);
  Try(f, place == HADDR_UNDEF ? -1 : 0);
  Try(f, H5Dclose(set));
  return f->failed ? 0 : (unsigned long long)place;
}

/* Rows first .. first + rows - 1 of entry `index`, n values in all, to or from rank 0's array; rows 0: the whole entry.
   A series whose rows have another size is an error. */
static void Transfer(H5File *f, PetscBool write, const char name[], PetscInt index, PetscInt first, PetscInt rows,
                     PetscInt n, void *values) {
  hsize_t size[3] = {0, 1, 1}, start[3] = {(hsize_t)index, (hsize_t)first, 0}, part[3], count = 1;
  hid_t space = -1, memory = -1;
  int ndims;
  if (f->failed) return;
  const hid_t set = OpenSeries(f, name, &ndims, size);
  if (set < 0) return;
  if (write && size[0] <= (hsize_t)index) {
    size[0] = (hsize_t)index + 1;
    Try(f, H5Dset_extent(set, size));
  }
  for (int d = 0; d < 3; d++) part[d] = !d ? 1 : (d == 1 && rows ? (hsize_t)rows : size[d]);
  for (int d = 0; d < ndims; d++) count *= part[d];
  Try(f, count == (hsize_t)n && (hsize_t)index < size[0] ? 0 : -1);
  Try(f, space = H5Dget_space(set));
  Try(f, memory = H5Screate_simple(ndims, part, NULL));
  Try(f, H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, part, NULL));
  if (write)
    Try(f, H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values));
  else
    Try(f, H5Dread(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values));
  if (memory >= 0) (void)H5Sclose(memory);
  if (space >= 0) (void)H5Sclose(space);
  Try(f, H5Dclose(set));
}

PetscErrorCode H5WriteArray(H5File *f, const char name[], PetscInt index, PetscInt n, const PetscReal values[]) {
  PetscFunctionBeginUser;
  if (!f->rank) Transfer(f, PETSC_TRUE, name, index, 0, 0, n, (void *)values);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5ReadArray(H5File *f, const char name[], PetscInt index, PetscInt n, PetscReal values[]) {
  PetscFunctionBeginUser;
  if (!f->rank) Transfer(f, PETSC_FALSE, name, index, 0, 0, n, values);
  PetscCallMPI(MPI_Bcast(values, (PetscMPIInt)n, MPIU_REAL, 0, f->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of a field on a rank: blocks of the same size on all but the last. */
static PetscInt RowsOf(Grid g, Field field, PetscInt rank) {
  return rank < g->size - 1 ? g->block : g->all_rows[field] - (g->size - 1) * g->block;
}

/* Rank by rank, so that rank 0 holds one slab at a time besides its own. */
static PetscErrorCode TransferRows(H5File *f, PetscBool write, const char name[], PetscInt index, Grid g, Field field,
                                   PetscInt columns, PetscScalar values[]) {
  const PetscInt own = columns * g->rows[field];
  PetscScalar *slab = NULL;
  PetscFunctionBeginUser;
  if (g->rank && write) PetscCallMPI(MPI_Send(values, (PetscMPIInt)own, MPIU_SCALAR, 0, 0, g->comm));
  if (g->rank && !write)
    PetscCallMPI(MPI_Recv(values, (PetscMPIInt)own, MPIU_SCALAR, 0, 0, g->comm, MPI_STATUS_IGNORE));
  if (g->rank) PetscFunctionReturn(PETSC_SUCCESS);
  Transfer(f, write, name, index, 0, g->rows[field], own, values);
  PetscCall(PetscMalloc1(columns * g->block, &slab));
  for (PetscMPIInt r = 1; r < g->size; r++) {
    const PetscInt rows = RowsOf(g, field, r), n = columns * rows;
    if (write) PetscCallMPI(MPI_Recv(slab, (PetscMPIInt)n, MPIU_SCALAR, r, 0, g->comm, MPI_STATUS_IGNORE));
    if (rows) Transfer(f, write, name, index, r * g->block, rows, n, slab);
    if (!write) PetscCallMPI(MPI_Send(slab, (PetscMPIInt)n, MPIU_SCALAR, r, 0, g->comm));
  }
  PetscCall(PetscFree(slab));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5WriteRows(H5File *f, const char name[], PetscInt index, Grid g, Field field, PetscInt each,
                           const PetscScalar values[]) {
  return TransferRows(f, PETSC_TRUE, name, index, g, field, each, (PetscScalar *)values);
}

PetscErrorCode H5ReadRows(H5File *f, const char name[], PetscInt index, Grid g, Field field, PetscInt each,
                          PetscScalar values[]) {
  return TransferRows(f, PETSC_FALSE, name, index, g, field, each, values);
}
