/* run.xmf: what VTK and ParaView need to read run.h5. A frame is written over the closing tags, and the closing tags
   behind it, in one write: so a frame costs the same at any time of a run, and the document is whole in between. How
   many frames run.h5 has stands once, in an entity at the beginning. */
#pragma once
#include "output/folder.h"
#include "scheme/scheme.h"
#include <sys/types.h>

typedef struct {
  Folder *folder;  /* borrowed */
  Scheme scheme;   /* borrowed */
  int file;        /* rank 0, when open; else -1 */
  PetscInt frames; /* in the document */
  off_t last, end; /* where the last frame begins, and where it ends: there the closing tags begin */
} Xdmf;

/* XdmfCreate - nothing is written yet: a document begins with its first frame. XdmfGoOn - the document anew, of the
   frames that a run goes on after, with their times[frames] and markers[frames][2 M], by which membranes are shown in
   a periodic box. Collective; stops with one line when it cannot be written. */
PETSC_EXTERN PetscErrorCode XdmfCreate(Xdmf *xdmf, Folder *folder, Scheme scheme);
PETSC_EXTERN PetscErrorCode XdmfGoOn(Xdmf *xdmf, PetscInt frames, const PetscReal times[], const PetscReal markers[]);

/* XdmfWrite - frame number `frame`, which run.h5 has already: a further one, or the last one anew. Collective; stops
   with one line when it cannot be written, and leaves the document as it was. */
PETSC_EXTERN PetscErrorCode XdmfWrite(Xdmf *xdmf, PetscInt frame, PetscReal time, const PetscReal markers[]);

/* XdmfClose - close the file; good: all of it was written. Rank 0 closes, and good is TRUE elsewhere. */
PETSC_EXTERN PetscErrorCode XdmfClose(Xdmf *xdmf, PetscBool *good);
