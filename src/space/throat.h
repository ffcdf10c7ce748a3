/* A throat in a circular tube of radius R about the axis x: along a mouth, of length w, the radius falls to R_t, which
   it keeps over a length, and along a second mouth it rises again,

       R(x) = R - (R - R_t) (1 + cos(pi s))/2,      s from 0 to 1 along a mouth.

   The wall there is made of rings within the tube, whose forces f on the fluid hold it at rest: A f = -u, A the
   mobility of rings in the tube, of the free Stokeslets of rings (Pozrikidis 1992) and of T^T S T of tube.h, and u what
   the vesicles and the flow make at the rings. The rings are equally spaced in x; that a ring acts on itself is the
   midpoint rule's correction of a logarithm. With A = L L^T and the velocities C at the rings by forces on a vesicle,
   the throat adds

       -(L^-1 C)^T (L^-1 C)

   to its mobility: L^-1 C are more rows of the vesicle's T. Rings nearer to the tube than 0.6 of their
   spacing are left out. */
#pragma once
#include "space/tube.h"

typedef struct {
  PetscReal radius, center, length, mouth; /* R_t (0: no throat), x of the middle, of the narrow part, w (lengths) */
} ThroatSetting;

typedef struct _p_Throat *Throat;

/* ThroatCreate - of a tube, whose rows T it will extend; the tube is borrowed. ThroatMeasure - the film of a body of
   revolution that has been placed, as TubeMeasure. ThroatLeastFilm: thinner films take more rings than there may be.
   ThroatPlace - the tube's nodes and rings (TubePlace), and rings of the throat no farther apart than the film. Not
   collective. Errors: memory; matrices that are not positive definite. */
PETSC_EXTERN PetscErrorCode ThroatCreate(const ThroatSetting *setting, Tube tube, Throat *throat);
PETSC_EXTERN PetscErrorCode ThroatDestroy(Throat *throat);
PETSC_EXTERN void ThroatMeasure(Throat throat, Surface surface, TubeExtent *extent);
PETSC_EXTERN PetscReal ThroatLeastFilm(Throat throat);
PETSC_EXTERN PetscErrorCode ThroatPlace(Throat throat, PetscInt p, const TubeExtent *extent);

/* ThroatFactor - the throat's rows of T[size][rows], whose other rows TubeFactor has set, and flow[size], what the
   throat adds to the tube's flow u_1 of mean velocity 1. ThroatResistance - |L^-1 u_1|^2: where the flux is given, pi
   R^2 times the pressure drop of the throat at the mean velocity 1; with a period P, 8 pi nu P times the part of the
   flux that the throat takes. Not collective. */
PETSC_EXTERN PetscErrorCode ThroatFactor(Throat throat, const PetscReal c[], PetscReal T[], PetscReal flow[]);
PETSC_EXTERN PetscReal ThroatResistance(Throat throat);
