/* run.xmf: the document by which VTK and ParaView read run.h5.

   A frame is written over the closing tags, with new closing tags behind it, in one write: the document is whole at
   every moment, and a frame costs the same at any time of a run. The number of frames stands once, in an entity at the
   beginning. Rank 0 writes the file. A run that goes on writes the document anew.

   Order: XdmfWrite for each frame, XdmfClose. */
#pragma once
#include "output/appendedfile.h"

/* Filled in by the caller: folder, scheme, number of tracers, file = -1; else zero. */
typedef struct {
  Folder *folder; /* borrowed */
  Scheme scheme;  /* borrowed */
  PetscInt tracers;
  int file;        /* rank 0, when open; else -1 */
  PetscInt frames; /* in the document */
  off_t last;      /* where the last frame begins */
  off_t end;       /* where the last frame ends and the closing tags begin */
} Xdmf;

/* XdmfWrite - bring the document up to run.h5, whose last frame is new: all frames at the first call, then the last
   one. Collective; stops with one line when a frame cannot be written, and leaves the document as it was. */
PETSC_EXTERN PetscErrorCode XdmfWrite(Xdmf *xdmf, AppendedFile *frames);

/* XdmfClose - close the file; whether all of it was written, TRUE on ranks other than 0. Not collective. */
PETSC_EXTERN PetscBool XdmfClose(Xdmf *xdmf);
