/* petves: the program is in the library, so that Python can start it too. */
#include "petves.h"

int main(int argc, char **argv) {
  return PetvesMain(argc, argv);
}
