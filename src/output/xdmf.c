#define _GNU_SOURCE /* open_memstream */
#include "output/xdmf.h"
#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

/* The number of frames has a fixed width, so that it can be replaced where it stands. */
#define XDMF_HEAD "<?xml version=\"1.0\"?>\n<!DOCTYPE Xdmf [<!ENTITY frames \""
#define XDMF_COUNT_WIDTH 10
#define XDMF_OPENING                                                                                                   \
  XDMF_HEAD "         0\">]>\n<Xdmf Version=\"2.0\"><Domain>\n"                                                        \
            "<Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n"
#define XDMF_CLOSING "</Grid>\n</Domain></Xdmf>\n"

/* VTK keeps the points of a grid under the name of the comment, which is different for each slab. */
void XdmfPrintSlab(FILE *f, const char before[], const XdmfSlab *s) {
  const PetscInt start[3] = {s->frame, 0, s->column}, count[3] = {1, s->n, s->columns};
  const int end = s->width ? 3 : 2;
  fprintf(f, "<DataItem ItemType=\"HyperSlab\" Dimensions=\"%s%d", before, (int)s->n);
  if (s->columns > 1) fprintf(f, " %d", (int)s->columns);
  fprintf(f, "\"><!-- %s %d --><DataItem Dimensions=\"3 %d\" Format=\"XML\">", s->name, (int)s->frame, end);
  for (int row = 0; row < 3; row++) /* starts, strides, counts */
    for (int d = 0; d < end; d++) fprintf(f, "%s%d", row || d ? " " : "", row == 1 ? 1 : (int)(row ? count : start)[d]);
  fprintf(f, "</DataItem><DataItem Dimensions=\"&frames; %d", (int)s->n);
  if (s->width) fprintf(f, " %d", (int)s->width);
  fprintf(f, "\" NumberType=\"Float\" Precision=\"%d\" Format=\"HDF\">run.h5:%s</DataItem></DataItem>\n", s->bytes,
          s->name);
}

void XdmfPrintAttribute(FILE *f, const char name[], const char type[], const char before[], const XdmfSlab *s) {
  fprintf(f, "<Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"Node\">\n", name, type);
  XdmfPrintSlab(f, before, s);
  fprintf(f, "</Attribute>");
}

void XdmfPrintWhole(FILE *f, PetscInt n, PetscInt columns, const char group[], const char name[]) {
  fprintf(f,
          "<DataItem Dimensions=\"%d%s\" NumberType=\"Int\" Precision=\"%d\" Format=\"HDF\">run.h5:/%s/%s</DataItem>",
          (int)n, columns == 3 ? " 3" : "", (int)sizeof(PetscInt), group, name);
}

static PetscErrorCode PrintEmpty(FILE *f, const void *none) {
  fprintf(f, XDMF_OPENING XDMF_CLOSING);
  return PETSC_SUCCESS;
}

/* Make a document without frames. */
static PetscErrorCode XdmfBegin(Xdmf *x) {
  char path[PETSC_MAX_PATH_LEN];
  PetscFunctionBeginUser;
  PetscCall(FolderWriteText(x->folder, "run.xmf", PrintEmpty, NULL));
  FolderPath(x->folder, "run.xmf", path);
  if (!x->folder->rank) x->file = open(path, O_WRONLY);
  PetscCall(FolderCheck(x->folder, x->file >= 0, "run.xmf"));
  FolderWatch(x->folder, "run.xmf");
  x->end = (off_t)strlen(XDMF_OPENING);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Write text at `place` and spaces up to the old end of the file, then cut the file behind the text: the document is
   whole before the cut too. When the disk is full the closing tags, for which there is room, are written back. */
static PetscBool XdmfOverwrite(int file, off_t place, const char text[], size_t length, off_t old_end) {
  const off_t old_size = old_end + (off_t)strlen(XDMF_CLOSING), new_size = place + (off_t)length;
  const size_t all = (size_t)(PetscMax(old_size, new_size) - place);
  char *padded = malloc(all + 1);
  PetscBool done;
  if (!padded) return PETSC_FALSE;
  (void)snprintf(padded, all + 1, "%-*s", (int)all, text);
  done = pwrite(file, padded, all, place) == (ssize_t)all;
  free(padded);
  if (done) return new_size >= old_size || !ftruncate(file, new_size);
  if (pwrite(file, XDMF_CLOSING, strlen(XDMF_CLOSING), place) == (ssize_t)strlen(XDMF_CLOSING))
    (void)!ftruncate(file, place + (off_t)strlen(XDMF_CLOSING));
  return PETSC_FALSE;
}

/* Write a frame, the next one or the last one again, on rank 0. The number of frames is written first: run.h5 has as
 * many frames already. */
static PetscBool XdmfAppend(Xdmf *x, PetscInt frame, PetscReal time) {
  const off_t place = frame < x->frames ? x->last : x->end;
  char count[XDMF_COUNT_WIDTH + 8], *text = NULL;
  size_t size = 0;
  FILE *f = open_memstream(&text, &size);
  PetscBool done = PETSC_FALSE;
  if (!f) return PETSC_FALSE;
  x->print(x->context, f, frame, time);
  fprintf(f, XDMF_CLOSING);
  if (!fclose(f)) {
    (void)snprintf(count, sizeof(count), "%*d", XDMF_COUNT_WIDTH, (int)frame + 1);
    done = pwrite(x->file, count, XDMF_COUNT_WIDTH, (off_t)strlen(XDMF_HEAD)) == XDMF_COUNT_WIDTH;
    if (done) done = XdmfOverwrite(x->file, place, text, size, x->end);
    x->last = place;
    x->end = place + (off_t)(size - strlen(XDMF_CLOSING));
  }
  free(text);
  return done;
}

PetscErrorCode XdmfWrite(Xdmf *x, AppendedFile *frames) {
  PetscBool done = PETSC_TRUE;
  PetscReal time = 0;
  PetscFunctionBeginUser;
  if (!x->end) PetscCall(XdmfBegin(x));
  for (PetscInt t = PetscMin(x->frames, frames->count - 1); t < frames->count; t++) {
    PetscCall(H5ReadArray(&frames->file, "/time", t, 1, &time));
    if (done && !x->folder->rank) done = XdmfAppend(x, t, time);
    x->frames = t + 1;
  }
  PetscCall(FolderCheck(x->folder, done, "run.xmf"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool XdmfClose(Xdmf *x) {
  return !x->folder || x->file < 0 || !close(x->file);
}
