/* run.xmf: the document by which VTK and ParaView read run.h5.

   A frame is written over the closing tags, with new closing tags behind it, in one write: the document is whole at
   every moment, and a frame costs the same at any time of a run. The number of frames stands once, in an entity at the
   beginning. Rank 0 writes the file.

   Order: XdmfGoOn after a restart, XdmfWrite for each frame, XdmfClose. */
#pragma once
#include "output/folder.h"
#include "scheme/scheme.h"
#include <sys/types.h>

/* Filled in by the caller: folder, scheme, file = -1; else zero. */
typedef struct {
  Folder *folder;  /* borrowed */
  Scheme scheme;   /* borrowed */
  int file;        /* rank 0, when open; else -1 */
  PetscInt frames; /* in the document */
  off_t last;      /* where the last frame begins */
  off_t end;       /* where the last frame ends and the closing tags begin */
} Xdmf;

/* XdmfGoOn - write the document anew, of the frames that a run goes on after, with their times[frames]. Collective;
   stops with one line when the document cannot be written. */
PETSC_EXTERN PetscErrorCode XdmfGoOn(Xdmf *xdmf, PetscInt frames, const PetscReal times[]);

/* XdmfWrite - write frame number `frame`, which run.h5 has already: one more frame, or the last one again. Collective;
   stops with one line when the frame cannot be written, and leaves the document as it was. */
PETSC_EXTERN PetscErrorCode XdmfWrite(Xdmf *xdmf, PetscInt frame, PetscReal time);

/* XdmfClose - close the file; whether all of it was written, TRUE on ranks other than 0. Not collective. */
PETSC_EXTERN PetscBool XdmfClose(Xdmf *xdmf);
