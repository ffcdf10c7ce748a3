#include "base/base.h"
#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

FILE *FileOpen(const char path[]) {
  struct stat what;
  if (stat(path, &what)) return NULL;
  if (S_ISREG(what.st_mode)) return fopen(path, "r");
  errno = S_ISDIR(what.st_mode) ? EISDIR : ENOTSUP;
  return NULL;
}

FILE *FileNew(const char path[]) {
  (void)unlink(path);
  return fopen(path, "wx");
}
