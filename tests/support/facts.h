/* What a C test includes: its Facts() are main() of a program. */
#pragma once
#include "world.h"

void Facts(void);

int main(int argc, char **argv) {
  return CheckMain(argc, argv, Facts);
}
