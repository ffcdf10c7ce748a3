/* Defaults that depend on the scene, each with its condition and its reason: chosen by OptionsDepend where the user
   gives no value, shown by -help and -view. */
#pragma once
#include "options/options.h"

PETSC_EXTERN const OptionDefault scene_defaults[];
