/* What a checkpoint has of a space. */
#include "space/space.h"

SpaceNumbers SpaceGetNumbers(Space s) {
  SpaceNumbers n = {.step = s->state.step,
                    .past = s->past,
                    .order = s->order,
                    .solved = s->state.solved,
                    .level = s->plan.level,
                    .t = s->state.t,
                    .made = s->made.a0};
  n.dt_last[0] = s->state.dt_last;
  for (int j = 1; j < BDF_MOST; j++) n.dt_last[j] = s->old[j - 1].dt_last;
  AgeGetMemory(&s->age, n.age);
  return n;
}

void SpaceSetNumbers(Space s, const SpaceNumbers *n) {
  s->state.step = n->step;
  s->state.solved = n->solved ? PETSC_TRUE : PETSC_FALSE;
  s->state.t = n->t;
  s->state.dt_last = n->dt_last[0];
  s->past = n->past;
  s->order = n->order;
  s->plan.level = n->level;
  for (int j = 1; j < BDF_MOST; j++) s->old[j - 1].dt_last = n->dt_last[j];
  s->made.a0 = n->made;
  s->age = AgeSetMemory(n->age);
}

PetscInt SpaceArrays(Space s, SpaceArray array[SPACE_ARRAYS]) {
  static const char *const groups[] = {"", "/previous", "/previous_1", "/solver"};
  PetscInt n = 0;
  for (PetscInt j = 0; j <= BDF_MOST; j++) {
    const SpaceState made = {.X = s->made.X, .sigma = s->made.sigma}, *q = j == BDF_MOST ? &made
                                                                           : j           ? &s->old[j - 1]
                                                                                         : &s->state;
    const struct {
      const char *name;
      PetscInt each;
      PetscReal *own;
    } all[] = {{"shape", s->size, q->X}, {"velocity", s->size, q->U}, {"tension", s->count, q->sigma}};
    if (j == BDF_MOST ? s->made.a0 <= 0 : j > s->past) continue;
    for (int k = 0; k < 3; k++) {
      if (j == BDF_MOST && k == 1) continue; /* factors have no velocity */
      (void)snprintf(array[n].name, sizeof(array[n].name), "%s/vesicle/%s", groups[j], all[k].name);
      array[n].each = all[k].each;
      array[n++].own = all[k].own;
    }
  }
  return n;
}
