/* A simulation as the run (src/app) and the writers of this folder see it: how a step is taken, and what the files have
   of the state. A kind of simulation fills in one Model: src/plane, src/space. Nothing here knows what it computes.

   Every operation gets the model's context. An operation is collective, and all ranks fail alike, unless its comment
   says otherwise. */
#pragma once
#include "output/appendedfile.h"
#include "output/record.h"
#include "scheme/stepcontrol.h"

/* Of the points of membranes: markers in the plane, points of surfaces in space. */
typedef enum { MODEL_POINTS, MODEL_VELOCITY, MODEL_TENSION, MODEL_PARTS } ModelPart;

typedef struct {
  /* The run. start: solve the first state; does nothing after a step, and where the solve fails, as the first step will
     say why. step: one time step, to the time `until` at most; else model->failure says why there is none, and the
     state is the one before. view: the solvers. */
  PetscErrorCode (*start)(void *context);
  PetscErrorCode (*step)(void *context, PetscReal until);
  PetscErrorCode (*view)(void *context, PetscViewer viewer);
  PetscErrorCode (*destroy)(void *context);

  /* series.csv and vesicles.h5. row: the numbers of the run alone, last[columns + extras], which are zero, from the
     present state and the last step, which is added to the totals of the run. measure: the columns
     each[vesicles][columns] of the own vesicles in the present state, which are zero, and those of all vesicles that
     are apart (RECORD_APART). watch: warn of what the row shows; may be NULL. warning: the i-th warning so far, NULL
     past the last; not collective. */
  PetscErrorCode (*row)(void *context, PetscReal last[]);
  PetscErrorCode (*measure)(void *context, PetscReal each[], PetscReal last[]);
  PetscErrorCode (*watch)(void *context, const PetscReal last[]);
  const char *(*warning)(const void *context, PetscInt i);

  /* run.h5 and run.xmf. series: what frames hold (AppendedAddSeries). describe: what else the file has. frame: set
     every series of the next frame. print: a frame of run.h5 as a grid of XDMF; not collective. */
  PetscErrorCode (*series)(void *context, AppendedKind *kind);
  PetscErrorCode (*describe)(const void *context, H5File *file);
  PetscErrorCode (*frame)(void *context, AppendedFile *file);
  void (*print)(const void *context, FILE *file, PetscInt frame, PetscReal time);

  /* checkpoint.h5: write or read the state and the number of frames. What a run cannot have had is refused with a line
     that names -restart. */
  PetscErrorCode (*checkpoint)(void *context, H5File *file, PetscBool write, PetscInt *frames);

  /* resolved.opts: the solvers' options; NULL: none. summary.json: members, each with a comma and a line end. The lines
     of the table on the terminal. Rank 0 alone has the files; the table is collective. */
  PetscErrorCode (*options)(void *context, FILE *file);
  void (*summary)(const void *context, FILE *file);
  PetscErrorCode (*table)(const void *context, const PetscReal last[]);

  /* Callers. gather: a ModelPart of all vesicles on every rank, numbers[points][dim], of the tension numbers[points].
     object: a PETSc object by its name, borrowed, NULL: there is none of this name. */
  PetscErrorCode (*gather)(void *context, ModelPart part, PetscReal numbers[]);
  PetscErrorCode (*object)(void *context, const char name[], PetscObject *object);
} ModelOps;

typedef struct {
  ModelOps ops;
  void *context;
  Scene scene; /* borrowed */
  /* where the simulation keeps what the present state and the last step have of these */
  const PetscInt *step;
  const PetscReal *t, *dt;
  const char *failure; /* why the step was not taken; empty: it was taken */
  const StepPolicy *policy;
  RecordSetting columns;
  PetscInt dim;          /* coordinates of a point */
  const PetscInt *first; /* [vesicles + 1] first point of each vesicle */
} Model;
