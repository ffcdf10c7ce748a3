#include "output/h5.h"
#include <unistd.h>

/* HDF5's drivers belong to the whole program, and their calls have no context. */
static struct {
  hid_t id;
  H5FD_class_t class;
  herr_t (*read)(H5FD_t *, H5FD_mem_t, hid_t, haddr_t, size_t, void *);
  herr_t (*write)(H5FD_t *, H5FD_mem_t, hid_t, haddr_t, size_t, const void *);
  haddr_t last_read;
  PetscBool lost; /* a write has failed */
} driver = {.id = -1, .last_read = HADDR_UNDEF};

static herr_t DriverRead(H5FD_t *file, H5FD_mem_t type, hid_t transfer, haddr_t place, size_t size, void *values) {
  if (type == H5FD_MEM_DRAW) driver.last_read = place;
  return driver.read(file, type, transfer, place, size, values);
}

static herr_t DriverWrite(H5FD_t *file, H5FD_mem_t type, hid_t transfer, haddr_t place, size_t size,
                          const void *values) {
  if (driver.write(file, type, transfer, place, size, values) < 0) driver.lost = PETSC_TRUE;
  return 0;
}

PetscBool H5WriteLost(void) {
  const PetscBool lost = driver.lost;
  driver.lost = PETSC_FALSE;
  return lost;
}

haddr_t H5LastRead(void) {
  const haddr_t place = driver.last_read;
  driver.last_read = HADDR_UNDEF;
  return place;
}

/* HDF5's own driver of plain files, with DriverRead and DriverWrite in place of two functions. An open file is the only
   way to these functions. */
static void DriverRegister(void) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5FD_t *file = H5Pset_fapl_sec2(access) < 0 ? NULL : H5FDopen("/dev/null", H5F_ACC_RDONLY, access, HADDR_UNDEF);
  if (file) {
    driver.class = *file->cls;
    driver.read = driver.class.read;
    driver.class.read = DriverRead;
    driver.write = driver.class.write;
    driver.class.write = DriverWrite;
    driver.id = H5FDregister(&driver.class);
    (void)H5FDclose(file);
  }
  (void)H5Pclose(access);
}

/* Rank 0's file has the driver above. Without a cache of chunks a write that fails does so in H5Dwrite, not when the
   dataset is closed, which HDF5 cannot undo. */
PetscErrorCode H5FileOpen(MPI_Comm comm, const char path[], H5Mode mode, H5File *f) {
  PetscFunctionBeginUser;
  f->comm = comm;
  f->id = -1;
  f->failed = PETSC_FALSE;
  PetscCallMPI(MPI_Comm_rank(comm, &f->rank));
  PetscCall(PetscStrncpy(f->path, path, sizeof(f->path)));
  if (f->rank) PetscFunctionReturn(PETSC_SUCCESS);
  (void)H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  if (driver.id < 0) DriverRegister();
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  (void)H5Pset_cache(access, 0, 0, 0, 0);
  if (driver.id >= 0) (void)H5Pset_driver(access, driver.id, NULL); /* negative: HDF5 has refused the driver */
  if (mode == H5_NEW) (void)unlink(path);                           /* a link leads to a file that is not the run's */
  H5Try(f, f->id = mode == H5_NEW ? H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, access)
                                  : H5Fopen(path, mode == H5_READ ? H5F_ACC_RDONLY : H5F_ACC_RDWR, access));
  (void)H5Pclose(access);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void H5FileFlush(H5File *f) {
  if (!f->rank) H5Try(f, H5Fflush(f->id, H5F_SCOPE_GLOBAL));
}

void H5FileClose(H5File *f) {
  if (f->id < 0) return;
  if (H5Fflush(f->id, H5F_SCOPE_GLOBAL) < 0 || H5WriteLost()) f->failed = PETSC_TRUE;
  if (H5Fclose(f->id) < 0 || H5WriteLost()) f->failed = PETSC_TRUE;
  f->id = -1;
}

PetscErrorCode H5FileFailed(const H5File *f, PetscBool *failed) {
  PetscFunctionBeginUser;
  *failed = f->failed;
  PetscCallMPI(MPI_Bcast(failed, 1, MPIU_BOOL, 0, f->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The most numbers of an attribute: HDF5 keeps no more than 64 KiB with an object. */
#define ATTRIBUTE_NUMBERS 8000

void H5PutRows(H5File *f, const char name[], hid_t type, PetscInt rows, PetscInt columns, const void *values) {
  const hsize_t size[2] = {(hsize_t)rows, (hsize_t)columns};
  hid_t space = -1, set = -1;
  if (f->rank || f->failed) return;
  const hid_t link = H5Pcreate(H5P_LINK_CREATE);
  H5Try(f, H5Pset_create_intermediate_group(link, 1));
  H5Try(f, space = H5Screate_simple(columns ? 2 : 1, size, NULL));
  H5Try(f, set = H5Dcreate2(f->id, name, type, space, link, H5P_DEFAULT, H5P_DEFAULT));
  H5Try(f, H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
  if (set >= 0) H5Try(f, H5Dclose(set));
  if (space >= 0) H5Try(f, H5Sclose(space));
  (void)H5Pclose(link);
}

/* object: "." is the root. */
static void AttributePut(H5File *f, const char object[], const char name[], hid_t type, PetscInt n,
                         const void *values) {
  const hsize_t size = (hsize_t)n;
  hid_t space = -1, attribute = -1;
  if (f->rank || f->failed) return;
  H5Try(f, space = n == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, NULL));
  H5Try(f, attribute = H5Acreate_by_name(f->id, object, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Try(f, H5Awrite(attribute, type, values));
  if (attribute >= 0) H5Try(f, H5Aclose(attribute));
  if (space >= 0) H5Try(f, H5Sclose(space));
}

void H5Put(H5File *f, const char name[], hid_t type, PetscInt n, const void *values) {
  if (n > ATTRIBUTE_NUMBERS)
    H5PutRows(f, name, type, n, 0, values);
  else
    AttributePut(f, ".", name, type, n, values);
}

/* Rank 0 reads the n values of an attribute or, of many, of a dataset. */
static void RootGet(H5File *f, const char name[], hid_t type, PetscInt n, void *values) {
  const PetscBool many = n > ATTRIBUTE_NUMBERS;
  hid_t item = -1, space = -1;
  if (f->rank || f->failed) return;
  H5Try(f, item = many ? H5Dopen2(f->id, name, H5P_DEFAULT) : H5Aopen(f->id, name, H5P_DEFAULT));
  H5Try(f, space = many ? H5Dget_space(item) : H5Aget_space(item));
  H5Try(f, H5Sget_simple_extent_npoints(space) == n ? 0 : -1);
  H5Try(f, many ? H5Dread(item, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) : H5Aread(item, type, values));
  if (space >= 0) (void)H5Sclose(space);
  if (item >= 0) (void)(many ? H5Dclose(item) : H5Aclose(item));
}

PetscErrorCode H5Get(H5File *f, const char name[], hid_t type, PetscInt n, void *values) {
  PetscFunctionBeginUser;
  RootGet(f, name, type, n, values);
  PetscCallMPI(MPI_Bcast(values, (PetscMPIInt)(H5Tget_size(type) * (size_t)n), MPI_BYTE, 0, f->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode H5GetString(H5File *f, const char name[], size_t length, char value[]) {
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(value, (PetscInt)length));
  if (!f->rank && !f->failed && H5Aexists(f->id, name) > 0) {
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Try(f, H5Tset_size(type, length));
    RootGet(f, name, type, 1, value);
    (void)H5Tclose(type);
  }
  PetscCallMPI(MPI_Bcast(value, (PetscMPIInt)length, MPI_CHAR, 0, f->comm));
  value[length - 1] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Characters of a text in one attribute. The attributes of a text are name, name_1, name_2 and so on. */
#define TEXT_PIECE 32000

static void TextPieceName(const char name[], int k, char piece[64]) {
  (void)(k ? PetscSNPrintf(piece, 64, "%s_%d", name, k) : PetscStrncpy(piece, name, 64));
}

/* A text that HDF5 holds in one attribute. */
static void WordPut(H5File *f, const char object[], const char name[], const char value[]) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Try(f, H5Tset_size(type, strlen(value) + 1));
  AttributePut(f, object, name, type, 1, value);
  (void)H5Tclose(type);
}

void H5PutUnit(H5File *f, const char dataset[], const char unit[]) {
  if (!f->rank) WordPut(f, dataset, "units", unit);
}

void H5PutText(H5File *f, const char name[], const char value[]) {
  const size_t length = strlen(value);
  char part[TEXT_PIECE + 1], piece[64];
  for (int k = 0; !f->rank && (!k || (size_t)k * TEXT_PIECE < length); k++) {
    TextPieceName(name, k, piece);
    (void)PetscStrncpy(part, value + (size_t)k * TEXT_PIECE, sizeof(part));
    WordPut(f, ".", piece, part);
  }
}

PetscErrorCode H5GetText(H5File *f, const char name[], char **value) {
  char part[TEXT_PIECE + 1], piece[64];
  size_t length = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(1, value));
  for (int k = 0; length == (size_t)k * TEXT_PIECE; k++) {
    TextPieceName(name, k, piece);
    PetscCall(H5GetString(f, piece, sizeof(part), part));
    PetscCall(PetscRealloc(length + strlen(part) + 1, value));
    PetscCall(PetscStrncpy(*value + length, part, strlen(part) + 1));
    length += strlen(part);
    if (!*part) break;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* plain becomes false at a link that is not hard. */
static herr_t LinkIsHard(hid_t group, const char *name, const H5L_info_t *info, void *plain) {
  if (info->type != H5L_TYPE_HARD) *(PetscBool *)plain = PETSC_FALSE;
  return 0;
}

PetscErrorCode H5CheckLinks(H5File *f, PetscBool *plain) {
  PetscFunctionBeginUser;
  *plain = PETSC_TRUE;
  if (!f->rank && !f->failed && H5Lvisit(f->id, H5_INDEX_NAME, H5_ITER_NATIVE, LinkIsHard, plain) < 0)
    *plain = PETSC_FALSE;
  PetscCallMPI(MPI_Bcast(plain, 1, MPIU_BOOL, 0, f->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
