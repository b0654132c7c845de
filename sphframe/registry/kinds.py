"""Registry: the kinds of components, and which version of the plugin interface they are written for."""

API_VERSION = (1, 0)
"""version of the plugin interface that this sphframe offers"""
OLDEST_API_VERSION = (1, 0)
"""oldest version of the plugin interface that this sphframe still supports"""

LABELS = {
    "interpolators": "interpolator",
    "wall_treatments": "wall treatment",
    "kernels": "kernel",
    "equations_of_state": "equation of state",
    "integrators": "integrator",
    "rigid_bodies": "rigid body",
    "body_forces": "body force",
    "cases": "case",
    "studies": "study",
    "hooks": "hook",
    "devices": "device",
}
"""the kinds of components, each with its name in the singular for messages"""
INTERFACES = {
    "interpolators": "sphframe.BoundaryInterpolator",
    "wall_treatments": "sphframe.WallTreatment",
    "kernels": "sphframe.Kernel",
    "equations_of_state": "sphframe.EquationOfState",
    "integrators": "sphframe.Integrator",
    "rigid_bodies": "sphframe.RigidBody",
    "body_forces": "sphframe.BodyForce",
    "cases": "sphframe.Case",
    "studies": "sphframe.studies.Study",
    "devices": "sphframe.devices.FluidSystem",
}
"""the public name of the class that components of a kind extend; hooks may be any object"""
KINDS = tuple(LABELS)
"""the kinds of components; kind K is entry-point group ``sphframe.K``"""
COMPONENT_KINDS = {
    "interpolator": "interpolators",
    "wall_treatment": "wall_treatments",
    "kernel": "kernels",
    "equation_of_state": "equations_of_state",
    "integrator": "integrators",
}
"""the parameters of a case that choose a component by name, with the kind of that component"""

DISTRIBUTIONS = {
    ("interpolators", "improved-shepard"): "sphframe-shepard",
    ("interpolators", "shepard"): "sphframe-shepard",
    ("interpolators", "normalized"): "sphframe-normalized",
    ("interpolators", "sfdi"): "sphframe-sfdi",
    ("interpolators", "mls-linear"): "sphframe-mls",
    ("interpolators", "mls-quadratic"): "sphframe-mls",
    ("interpolators", "mdbc"): "sphframe-mdbc",
    ("interpolators", "adami"): "sphframe-adami",
    ("wall_treatments", "adami-2012"): "sphframe-adami",
    ("wall_treatments", "hashemi-2012"): "sphframe-hashemi",
    ("wall_treatments", "band-2018"): "sphframe-band",
    ("wall_treatments", "akinci-2012"): "sphframe-akinci",
    ("wall_treatments", "dynamic-2007"): "sphframe-dynamic",
    ("wall_treatments", "lennard-jones"): "sphframe-lennard-jones",
    ("wall_treatments", "monaghan-kajtar-2009"): "sphframe-monaghan-kajtar",
    ("wall_treatments", "mirror-images"): "sphframe-mirror-images",
    ("wall_treatments", "riemann-2017"): "sphframe-riemann",
    ("wall_treatments", "pair-mirror"): "sphframe-pair-mirror",
    ("wall_treatments", "distance-ratio"): "sphframe-distance-ratio",
    ("wall_treatments", "edge-integrals"): "sphframe-edge-integrals",
    ("wall_treatments", "usaw-2013"): "sphframe-semi-analytical",
    ("wall_treatments", "mdbc-2022"): "sphframe-mdbc",
    ("wall_treatments", "mdbc-2025"): "sphframe-mdbc",
    ("rigid_bodies", "solitary-wave-paddle"): "sphframe-waves",
    ("rigid_bodies", "regular-wave-paddle"): "sphframe-waves",
    **{("cases", f"solitary-wave-{k}"): "sphframe-waves" for k in ("column", "fixed-wall", "movable-wall")},
    ("rigid_bodies", "oscillating"): "sphframe-flows",
    ("rigid_bodies", "smooth-start"): "sphframe-flows",
    ("rigid_bodies", "spinning"): "sphframe-flows",
    ("body_forces", "roll"): "sphframe-flows",
    ("body_forces", "rotating-frame"): "sphframe-flows",
    ("body_forces", "surge"): "sphframe-flows",
    **{
        ("cases", name): "sphframe-flows"
        for name in (
            "accelerated-tank",
            "ceiling-release",
            "circular-sill",
            "column-impact",
            "couette",
            "cylinder-array",
            "cylinder-in-channel",
            "dam-break-3d",
            "dam-break-impact",
            "drum",
            "hydrostatic-wedge",
            "jet-on-plate",
            "lid-driven-cavity",
            "manufactured",
            "moving-square",
            "oblique-jet",
            "oscillating-cylinder",
            "poiseuille",
            "rotating-bucket",
            "sloshing-tank",
            "standing-wave",
            "stokes-plate",
            "submerged-box",
            "taylor-couette",
            "taylor-green",
            "tilted-tank",
            "two-basins",
        )
    },
    ("studies", "huang2019"): "sphframe-huang2019",
    ("devices", "cuda"): "sphframe-cuda",
}
"""the distribution to install for the name of a component of this project that is missing"""
