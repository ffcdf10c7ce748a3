/* Where in a file HDF5 keeps the values of an entry. HDF5's own answer, H5Dget_chunk_info_by_coord, goes through all
   entries before it, so that asking for every frame of a run would take time in proportion to the square of their
   number. Here HDF5 reads the entry, which it finds by its tree, through a file driver that notes where it read. */
#pragma once
#include <hdf5.h>

/* H5PlaceLost - 1 when a write of this driver has failed since the last call, else 0. Not collective. */
int H5PlaceLost(void);

/* H5PlaceDriver - let files of these access properties be read through the driver; without effect where HDF5 refuses.
   Not collective. */
void H5PlaceDriver(hid_t access);

/* H5PlaceOf - byte of the file where the entry of a chunked dataset begins, which has one chunk an entry;
   HADDR_UNDEF when it has none. Not collective. */
haddr_t H5PlaceOf(hid_t set, int ndims, const hsize_t start[]);
