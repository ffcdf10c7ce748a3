"""Solver study: the coupled solve of one step by different Krylov methods, through its KSP."""

from common import settings

import petves
from petves.views.plot import new_figure, save_figure

chosen = settings(__doc__)
CASES = {
    "FGMRES": {},
    "GCR": {},
    "FGMRES restarted every 5": dict(coupled_ksp_gmres_restart=5),
    "FGMRES restarted every 2": dict(coupled_ksp_gmres_restart=2),
}


def residuals(name: str, options: dict[str, str]) -> list[float]:
    """Return the residual norms of the first step's solve to 1e-8."""
    norms: list[float] = []
    cells = 40 if chosen.short else 96
    with petves.Simulation(
        domain_cells=(cells, cells), flow_type="shear", scheme_startup="euler", output_every=100, **options
    ) as sim:
        ksp = sim.ksp["coupled"]
        if name.startswith("GCR"):
            ksp.setType("gcr")
        ksp.setTolerances(rtol=1e-8, max_it=100)
        ksp.setMonitor(lambda _ksp, _its, norm: norms.append(norm))
        try:
            sim.step()
        except petves.Error as error:
            print(f"{name}: {str(error).split(';')[0]}")
    return norms


figure, (axes,) = new_figure(6, 4)
for name, options in CASES.items():
    norms = residuals(name, options)
    print(f"{name:32s} {len(norms) - 1:3d} iterations, residual {norms[-1] / norms[0]:.1e} of the first")
    axes.semilogy([norm / norms[0] for norm in norms], ".--" if "GCR" in name else ".-", label=name)
axes.set(xlabel="iteration", ylabel="residual over the first")
axes.grid(alpha=0.3)
axes.legend(frameon=False)
print(save_figure(figure, chosen.folder / "solver_study.png"))
