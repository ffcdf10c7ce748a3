/* When a factor that is kept from solve to solve is made again. One policy for all factors: a factor is over

   - when none has been made yet, or the coefficient of the time step (a0, or alpha of H) has changed by more than a
     ratio since it was made;
   - when the iterations above the fewest of a solve with it have cost as much as a new factor would;
   - when it has served as many solves as a factor may. A factor that has gone bad within a solve sets that number for
     later ones (AgeShorten), and every 16th factor raises it by one.

   Costs are counted in iterations, not in seconds, so that a run depends neither on the machine nor on its load. */
#pragma once
#include "base/base.h"

typedef struct {
  PetscReal made_for; /* coefficient of the time step; negative: no factor yet */
  PetscInt made;      /* number of factors so far */
  PetscInt solves;    /* solves that the factor has served */
  PetscInt most;      /* solves that a factor may serve */
  PetscInt fewest;    /* iterations of a solve with the factor, the least; -1: not known yet */
  PetscReal excess;   /* iterations above the fewest in all of its solves */
} Age;

/* AgeNone - no factor yet. AgeRenew - a factor has been made for this coefficient. AgeSolved - a solve with the factor
   has ended after `its` iterations. AgeShorten - factors serve no more solves than this one has. Not collective. */
static inline Age AgeNone(void) {
  return (Age){.made_for = -1, .fewest = -1, .most = 1000};
}
static inline void AgeRenew(Age *a, PetscReal coefficient) {
  const PetscInt made = a->made + 1;
  *a = (Age){.made_for = coefficient, .made = made, .most = made % 16 ? a->most : a->most + 1, .fewest = -1};
}
static inline void AgeSolved(Age *a, PetscInt its) {
  a->solves++;
  if (a->fewest < 0) {
    a->fewest = its;
    return;
  }
  a->fewest = PetscMin(a->fewest, PetscMax(its, 1)); /* the first solve's guess may have been a bad one */
  a->excess += PetscMax(its - a->fewest, 0);
}
static inline void AgeShorten(Age *a) {
  a->most = a->solves;
}

/* AgeStepChanged - whether two coefficients of the time step, of the factor and of the present step, differ by more
   than this ratio, or one of them is zero. AgeIsOver - whether a new factor, which costs so many iterations, is to
   be made. AgeIsFar - whether a solve that has come to so many iterations is to be ended with a new factor. Not
   collective. */
static inline PetscBool AgeStepChanged(PetscReal made, PetscReal now, PetscReal ratio) {
  return made == now || (now < ratio * made && made < ratio * now) ? PETSC_FALSE : PETSC_TRUE;
}
static inline PetscBool AgeIsOver(const Age *a, PetscReal now, PetscReal ratio, PetscReal cost) {
  return a->excess > cost || a->solves >= a->most || AgeStepChanged(a->made_for, now, ratio);
}
static inline PetscBool AgeIsFar(const Age *a, PetscInt its) {
  return a->solves > 0 && its == a->fewest + 5;
}

/* AgeCost - of so many dense blocks of n markers each, made anew, in iterations on so many cells; w: markers of the
   obstacles that the block knows. From the operation counts and the speeds of one core. Not collective. */
static inline PetscReal AgeCost(PetscReal blocks, PetscReal n, PetscReal w, PetscReal cells) {
  const PetscReal own = blocks * n * n, cross = n * w;
  return (own * (4e-9 * n + 6e-7) + cross * (4e-10 * w + 6e-7)) /
         (1.5e-8 * cells + 1e-8 * (own + 2 * cross + w * w) + 5e-5);
}

/* AgeGetMemory, AgeSetMemory - as numbers for a checkpoint, the first one made_for. Not collective. */
#define AGE_MEMORY 6
static inline void AgeGetMemory(const Age *a, PetscReal memory[AGE_MEMORY]) {
  const PetscReal own[] = {a->made_for, a->fewest, a->solves, a->excess, a->most, a->made};
  for (int k = 0; k < AGE_MEMORY; k++) memory[k] = own[k];
}
static inline Age AgeSetMemory(const PetscReal memory[AGE_MEMORY]) {
  return (Age){.made_for = memory[0],
               .fewest = (PetscInt)memory[1],
               .solves = (PetscInt)memory[2],
               .excess = memory[3],
               .most = (PetscInt)memory[4],
               .made = (PetscInt)memory[5]};
}
