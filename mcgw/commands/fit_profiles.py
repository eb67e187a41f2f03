"""``mcgw fit`` of profiles: what stylus data tell of the surface, and a scene of it."""

import argparse
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mcgw.maps.profile_fit import ProfileFit

__all__ = ["fit_of_profiles"]

_UNITS = {"m0": " m^2", "m4": " 1/m^2", "eta": " 1/m^2", "radius": " m", "sigma": " m"}
_ASSUMED = (
    "of a surface alike in all directions, with Gaussian heights (Nayak, McCool), after the areal filter"
)


def fit_of_profiles(
    args: argparse.Namespace, cutoff: float | None, E_star: float, on: dict[str, float]
) -> int:
    """Print what the profiles tell, with warnings, write the scene, and say where it is."""
    from mcgw.commands.outputs import TOML, Output, check_outputs
    from mcgw.formats.units import parse
    from mcgw.maps.fit_cautions import profile_cautions
    from mcgw.maps.fitted_scene import fitted_scene, write_scene
    from mcgw.maps.profile_files import read_profile
    from mcgw.maps.profile_fit import fit_profiles

    for option, given in (("--summits", args.summits), ("--tiles", args.tiles), ("--picture", args.picture)):
        if given is not None:
            raise ValueError(
                f"{option} {given}: a profile shows no summits, and has no sub-areas; give a map"
            )
    for option in ("long_cutoff", "missing", "spikes", "step", "lines", "trim"):
        if getattr(args, option) not in (None, "auto", "keep", 0):
            raise ValueError(f"--{option.replace('_', '-')}: is for maps; prepare a profile before")
    spacing = None if args.pixel is None else parse(args.pixel, "m", "--pixel")
    profiles = [read_profile(path, spacing=spacing, unit=args.unit) for path in args.map]
    check_outputs([Output(args.output, TOML)], inputs=args.map)
    fit = fit_profiles(profiles, cutoff=cutoff, form=args.form)
    filtered = "none" if cutoff is None else f"{cutoff:g} m (Gaussian)"
    names = ", ".join(path.name for path in args.map)
    taken = {"none": "mean", "plane": "line", "quadratic": "parabola"}[args.form]
    head = f"{names}: profile; taken off: {taken}; cutoff: {filtered}"
    if unit := next((p.assumed_unit for p in profiles if p.assumed_unit), ""):
        head += f"; lengths taken in {unit} where the file tells no unit"
    text = [head, *_table(fit), *(f"warning: {line}" for line in profile_cautions(fit, profiles, cutoff))]
    print("\n".join(text))
    title = f"Fitted to {head}"
    scene = fitted_scene(fit, use=args.use, heights=args.heights, E_star=E_star, title=title, **on)
    for path in write_scene(scene, args.output, None, text):
        print(path)
    return 0


def _table(fit: "ProfileFit") -> list[str]:
    """What the profiles are, and what they tell of the surface, one number a line."""
    counted, expected = fit.peaks
    number = len(fit.lengths)
    lines = [
        f"{number} profile{'s' if number > 1 else ''}, {sum(fit.lengths):.4g} m together; filtered along the "
        f"line: {fit.roughness.text('P')} (primary profile; they are Ra, Rq, Rsk if waves beyond a cutoff "
        "lambda_c were taken off before)",
        f"{counted:.4g} peaks a metre of profile; its own moments let expect {expected:.4g}",
        _ASSUMED + ":",
        f"{'':8}{'value':26}95 % interval",
    ]
    for name in fit.errors:
        low, high = fit.interval(name)
        value = f"{getattr(fit.moments, name):.4g}{_UNITS.get(name, '')}"
        lines.append(f"{name:8}{value:26}{low:.3g} to {high:.3g}")
    mean = fit.moments.mean_height
    lines.append(
        f"summits lie {mean:.3g} m above the mean plane on average; sigma is theirs, about that mean"
    )
    return lines
