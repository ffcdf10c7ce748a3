/* Defaults that depend on the scene. */
#pragma once
#include "scene/spec.h"

/* Each with its condition and its reason: chosen by OptionsDepend where the user gives no value, shown by -help and
   -view. */
PETSC_EXTERN const OptionDefault scene_defaults[];
