/* run.xmf: the document by which VTK and ParaView read run.h5.

   A frame is written over the closing tags, with new closing tags behind it, in one write: the document is whole at
   every moment, and a frame costs the same at any time of a run. The number of frames stands once, in an entity at the
   beginning. Rank 0 writes the file. A run that goes on writes the document anew.

   Order: XdmfWrite for each frame, XdmfClose. */
#pragma once
#include "output/appendedfile.h"

/* Filled in by the caller: folder, print with its context, file = -1; else zero. */
typedef struct {
  Folder *folder;                                                                 /* borrowed */
  void (*print)(const void *context, FILE *file, PetscInt frame, PetscReal time); /* one frame, a grid of XDMF */
  const void *context;
  int file;        /* rank 0, when open; else -1 */
  PetscInt frames; /* in the document */
  off_t last;      /* where the last frame begins */
  off_t end;       /* where the last frame ends and the closing tags begin */
} Xdmf;

/* XdmfWrite - bring the document up to run.h5, whose last frame is new: all frames at the first call, then the last
   one. Collective; stops with one line when a frame cannot be written, and leaves the document as it was. */
PETSC_EXTERN PetscErrorCode XdmfWrite(Xdmf *xdmf, AppendedFile *frames);

/* A list of numbers in run.h5 of frame after frame: n rows of `columns` columns from `column` on. */
typedef struct {
  const char *name;
  int bytes; /* bytes of a number */
  PetscInt frame, n, column, columns;
  PetscInt width; /* columns of an entry; 0: an entry is a list */
} XdmfSlab;

/* XdmfPrintSlab - a slab as an XDMF item with the dimensions before, n, columns. XdmfPrintAttribute - a slab as an
   attribute of the grid's points, of the type "Scalar" or "Vector". XdmfPrintWhole - the dataset
   /group/name of n whole numbers, or of n triangles (columns 3), the same for all frames, as an item. Not collective.
 */
PETSC_EXTERN void XdmfPrintSlab(FILE *file, const char before[], const XdmfSlab *slab);
PETSC_EXTERN void XdmfPrintAttribute(FILE *file, const char name[], const char type[], const char before[],
                                     const XdmfSlab *slab);
PETSC_EXTERN void XdmfPrintWhole(FILE *file, PetscInt n, PetscInt columns, const char group[], const char name[]);

/* XdmfClose - close the file; whether all of it was written, TRUE on ranks other than 0. Not collective. */
PETSC_EXTERN PetscBool XdmfClose(Xdmf *xdmf);
