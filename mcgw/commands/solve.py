"""``mcgw solve``: answers at a given load."""

from typing import Annotated

from mcgw.commands.kinds import JUST_ONE, Cautioned, Table, quantity, values
from mcgw.commands.voice import ALL, news, says, tell_cautions


def solve(
    scene: Cautioned,
    *,
    pressure: Annotated[list[float] | None, values("Pa"), JUST_ONE] = None,
    load: Annotated[list[float] | None, values("N"), JUST_ONE] = None,
    area: Annotated[list[float] | None, values("m^2"), JUST_ONE] = None,
    area_fraction: Annotated[list[float] | None, values("1"), JUST_ONE] = None,
    nominal_separation: Annotated[list[str] | None, values(""), JUST_ONE] = None,
    surfaces: int | None = None,
    scatter: Annotated[float | None, quantity("1")] = None,
    csv: Table = None,
) -> None:
    """Find separation, area, stiffness, contacts and conductance at given loads.

    Parameters
    ----------
    pressure : P
        load per nominal area: Pa, kPa, MPa, GPa
    load : F
        mN, N, kN, MN
    area : A
        real area: um^2, mm^2, cm^2
    area_fraction : A
        real over nominal area: 0.01 or 1%
    nominal_separation : D
        separation of the bodies with an interaction, over sigma
    surfaces : M
        number of surfaces to solve; default: that of the scene
    scatter : S
        also find the number of asperities for this scatter of specimens: 1%

    Examples
    --------
    mcgw solve runs/demo.toml --pressure 100kPa 1MPa --csv solved.csv
    """
    from analytic import quantity_of
    from mcgw.ensemble.solution import solve as solved
    from mcgw.machine.progress import told
    from mcgw.reports.solved_loads import solutions_table, solutions_text

    if scatter is not None and scatter >= 1:
        raise ValueError(f"--scatter {scatter:g}: give a number between 0 and 1, such as 1%")
    changes = {} if surfaces is None else {"n_surfaces": surfaces}
    with told(None, "surfaces") as tell:
        found = solved(
            scene, pressure=pressure, load=load, area=area, area_fraction=area_fraction,
            nominal_separation=nominal_separation, progress=tell, **changes,
        )  # fmt: skip
        assert isinstance(found, list)
        if says(ALL):  # it shows specimens
            found[0].loaded.draw(tell)
    print(solutions_text(scene, found, scatter, full=says(ALL)))
    h = sorted({each.theory["separation"] for each in found})  # in place of the loads
    loading = [q for q in scene.quantities if not quantity_of(q).unloading] or ["load"]
    tell_cautions(scene.replace(separations=h, unload_from=None, quantities=loading), "add -v")
    if csv:
        solutions_table(scene, found).write(csv)
        news(f"{csv}: the table")
