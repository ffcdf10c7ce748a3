#include "output/h5series.h"

void H5CreateSeries(H5File *f, const char name[], PetscBool single, int ndims, const PetscInt dims[]) {
  const hid_t type = single ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
  hsize_t size[3] = {0, 1, 1}, limit[3] = {H5S_UNLIMITED, 1, 1}, chunk[3] = {1, 1, 1};
  hid_t space, create, link, set = -1;
  if (f->rank || f->failed) return;
  for (int d = 0; d < ndims; d++) size[d + 1] = limit[d + 1] = chunk[d + 1] = (hsize_t)dims[d];
  if (!ndims) chunk[0] = 64;
  space = H5Screate_simple(ndims + 1, size, limit);
  create = H5Pcreate(H5P_DATASET_CREATE);
  link = H5Pcreate(H5P_LINK_CREATE);
  H5Try(f, H5Pset_chunk(create, ndims + 1, chunk));
  H5Try(f, H5Pset_create_intermediate_group(link, 1));
  H5Try(f, set = H5Dcreate2(f->id, name, type, space, link, create, H5P_DEFAULT));
  if (set >= 0) H5Try(f, H5Dclose(set));
  (void)H5Pclose(link);
  (void)H5Pclose(create);
  (void)H5Sclose(space);
}

/* Rank 0 opens a series: its number of dimensions and their sizes; -1 when there is no such series. */
static hid_t SeriesOpen(H5File *f, const char name[], int *ndims, hsize_t size[3]) {
  hid_t set = -1, space = -1;
  H5Try(f, set = H5Dopen2(f->id, name, H5P_DEFAULT));
  H5Try(f, space = H5Dget_space(set));
  H5Try(f, *ndims = H5Sget_simple_extent_ndims(space));
  H5Try(f, *ndims >= 1 && *ndims <= 3 ? 0 : -1);
  H5Try(f, H5Sget_simple_extent_dims(space, size, NULL));
  if (space >= 0) (void)H5Sclose(space);
  if (f->failed && set >= 0) (void)H5Dclose(set);
  return f->failed ? -1 : set;
}

PetscErrorCode H5SeriesLength(H5File *f, const char name[], PetscInt *length) {
  hsize_t size[3] = {0, 0, 0};
  int ndims;
  PetscFunctionBeginUser;
  if (!f->rank && !f->failed) {
    const hid_t set = SeriesOpen(f, name, &ndims, size);
    if (set >= 0) (void)H5Dclose(set);
  }
  *length = (PetscInt)size[0];
  PetscCallMPI(MPI_Bcast(length, 1, MPIU_INT, 0, f->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void H5TruncateSeries(H5File *f, const char name[], PetscInt length) {
  hsize_t size[3];
  int ndims;
  if (f->rank || f->failed) return;
  const hid_t set = SeriesOpen(f, name, &ndims, size);
  if (set < 0) return;
  size[0] = PetscMin(size[0], (hsize_t)length);
  H5Try(f, H5Dset_extent(set, size));
  H5Try(f, H5Dclose(set));
}

unsigned long long H5EntryPlace(H5File *f, const char name[], PetscInt index) {
  const hsize_t start[3] = {(hsize_t)index, 0, 0}, one[3] = {1, 1, 1};
  hsize_t size[3];
  haddr_t place = HADDR_UNDEF;
  hsize_t bytes;
  unsigned filters;
  double value;
  int ndims;
  const hid_t set = f->failed ? -1 : SeriesOpen(f, name, &ndims, size);
  if (set < 0) return 0;
  const hid_t space = H5Dget_space(set), memory = H5Screate(H5S_SCALAR);
  (void)H5LastRead();
  H5Try(f, H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, one, NULL));
  H5Try(f, H5Dread(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, &value));
  place = H5LastRead();
  if (place == HADDR_UNDEF) H5Try(f, H5Dget_chunk_info_by_coord(set, start, &filters, &place, &bytes));
  H5Try(f, place == HADDR_UNDEF ? -1 : 0);
  (void)H5Sclose(memory);
  (void)H5Sclose(space);
  (void)H5Dclose(set);
  return f->failed ? 0 : place;
}

void H5Transfer(H5File *f, PetscBool write, const char name[], PetscInt index, PetscInt n, PetscReal values[]) {
  hsize_t size[3] = {0, 1, 1}, start[3] = {(hsize_t)index, 0, 0}, part[3] = {1, 1, 1}, count = 1;
  hid_t space = -1, memory = -1;
  int ndims;
  if (f->rank || f->failed) return;
  const hid_t set = SeriesOpen(f, name, &ndims, size);
  if (set < 0) return;
  if (write && size[0] <= (hsize_t)index) {
    size[0] = (hsize_t)index + 1;
    H5Try(f, H5Dset_extent(set, size));
  }
  for (int d = 1; d < ndims; d++) count *= part[d] = size[d];
  H5Try(f, count == (hsize_t)n && (hsize_t)index < size[0] ? 0 : -1);
  H5Try(f, space = H5Dget_space(set));
  H5Try(f, memory = H5Screate_simple(ndims, part, NULL));
  H5Try(f, H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, part, NULL));
  H5Try(f, write ? H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values)
                 : H5Dread(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values));
  if (memory >= 0) (void)H5Sclose(memory);
  if (space >= 0) (void)H5Sclose(space);
  H5Try(f, H5Dclose(set));
}

PetscErrorCode H5ReadArray(H5File *f, const char name[], PetscInt index, PetscInt n, PetscReal values[]) {
  PetscFunctionBeginUser;
  H5Transfer(f, PETSC_FALSE, name, index, n, values);
  PetscCallMPI(MPI_Bcast(values, (PetscMPIInt)n, MPIU_REAL, 0, f->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether there is one entry of these dims, in one chunk, without filters, and nothing of it outside of the file. */
static PetscBool EntryIsPlain(H5File *f, const char name[], int ndims, const PetscInt dims[]) {
  hsize_t size[3], chunk[3] = {0, 0, 0};
  int found = 0;
  const hid_t set = SeriesOpen(f, name, &found, size), how = set < 0 ? -1 : H5Dget_create_plist(set);
  int plain = how >= 0 && found == ndims + 1 && H5Pget_layout(how) == H5D_CHUNKED && !H5Pget_external_count(how) &&
              !H5Pget_nfilters(how) && H5Pget_chunk(how, 3, chunk) == found;
  for (int d = 0; d <= ndims && plain; d++) plain = chunk[d] == size[d] && size[d] == (d ? (hsize_t)dims[d - 1] : 1);
  if (how >= 0) (void)H5Pclose(how);
  if (set >= 0) (void)H5Dclose(set);
  return plain;
}

void H5BeginEntry(H5File *f, PetscBool write, const char name[], int ndims, const PetscInt dims[]) {
  if (write)
    H5CreateSeries(f, name, PETSC_FALSE, ndims, dims);
  else if (!f->rank && !f->failed)
    H5Try(f, EntryIsPlain(f, name, ndims, dims) ? 0 : -1);
}
