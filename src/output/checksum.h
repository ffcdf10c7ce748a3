/* The seal of a checkpoint: a checksum of all its bytes behind them (HDF5 does not read past its own end). */
#pragma once
#include "base/base.h"

#define CHECKPOINT_FORMAT 7
#define CHECKPOINT_TAIL "petves checkpoint, crc32 %08x\n"
#define CHECKPOINT_TAIL_LENGTH 34

/* ChecksumOfFile - CRC-32 of the file up to its last `tail` bytes, which are copied to `end`; false when it cannot be
   read or is shorter. Not collective. */
PETSC_EXTERN PetscBool ChecksumOfFile(const char path[], long tail, unsigned *crc, char *end);

/* ChecksumAppend - put the checksum behind the file's bytes; false when that fails. Not collective. */
PETSC_EXTERN PetscBool ChecksumAppend(const char path[]);
