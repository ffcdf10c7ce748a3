#include "output/checksum.h"
#include <stdio.h>

PetscBool ChecksumOfFile(const char path[], long tail, unsigned *crc, char *end) {
  static unsigned table[256];
  unsigned char block[65536];
  FILE *f = fopen(path, "rb");
  long left;
  unsigned sum = 0xffffffffu;
  if (!f) return PETSC_FALSE;
  for (unsigned i = 0; i < 256 && !table[255]; i++) { /* the reflected polynomial of zlib's crc32 */
    unsigned c = i;
    for (int k = 0; k < 8; k++) c = c & 1 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    table[i] = c;
  }
  left = fseek(f, 0, SEEK_END) ? -1 : ftell(f) - tail;
  rewind(f);
  while (left > 0) {
    const size_t want = PetscMin((size_t)left, sizeof(block)), got = fread(block, 1, want, f);
    if (got != want) break;
    for (size_t i = 0; i < got; i++) sum = table[(sum ^ block[i]) & 255] ^ (sum >> 8);
    left -= (long)got;
  }
  const PetscBool read = left == 0 && fread(end, 1, (size_t)tail, f) == (size_t)tail ? PETSC_TRUE : PETSC_FALSE;
  fclose(f);
  *crc = ~sum;
  return read;
}

PetscBool ChecksumAppend(const char path[]) {
  unsigned crc;
  char none[1];
  FILE *f;
  if (!ChecksumOfFile(path, 0, &crc, none)) return PETSC_FALSE;
  f = fopen(path, "ab");
  if (!f) return PETSC_FALSE;
  const PetscBool printed = fprintf(f, CHECKPOINT_TAIL, crc) == CHECKPOINT_TAIL_LENGTH ? PETSC_TRUE : PETSC_FALSE;
  return !fclose(f) && printed ? PETSC_TRUE : PETSC_FALSE;
}
