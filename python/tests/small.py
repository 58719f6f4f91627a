"""A small rock that the tests share: seventy grains or so, run to a rough accuracy."""

import copy

ROCK = {
    "name": "small",
    "specimen": {"shape": "rectangle", "width": "18 mm", "height": "36 mm", "thickness": "20 mm", "grains": {"diameter": {"distribution": "uniform", "minimum": "2 mm", "maximum": "4 mm"}}},
    "material": {"grain": {"E": "25.8 GPa", "nu": 0.23}, "contact": {"law": "bilinear", "Kn": "18e4 GPa/m", "eta": 0.28, "sigma_nt": "8.5 MPa", "tau": "29.75 MPa", "mu": 0.4, "Gfn": "20 N/m", "Gfs": "800 N/m"}},
    "numerics": {"accuracy": "5 %"},
    "test": [{"kind": "uniaxial-compression"}],
    "run": {"seeds": [1]},
}


def rock(**changes):
    """The job with other tables in place of its own."""
    return {**copy.deepcopy(ROCK), **changes}


def pressed(**keys):
    """A custom test: the top goes down, the bottom is held, a pressure acts on the sides."""
    return {
        "kind": "custom",
        "name": "pressed",
        "fixture": [
            {"name": "top", "kind": "boundary", "on": "top", "motion": [0, -1], "holds_x": False},
            {"name": "bottom", "kind": "boundary", "on": "bottom", "holds_x": False, "pin": True},
            {"name": "left", "kind": "pressure", "on": "left", "pressure": "2 MPa"},
            {"name": "right", "kind": "pressure", "on": "right", "pressure": "2 MPa"},
        ],
        **keys,
    }
