// A complete job that reads well, and small edits of it.
#pragma once

#include <stdexcept>
#include <string>

namespace feldspar {

inline const std::string sample_job = R"([specimen]
shape = "rectangle"
width = "80 mm"
height = "160 mm"
thickness = "80 mm"
[specimen.grains]
diameter = { distribution = "uniform", minimum = "2 mm", maximum = "4 mm" }
porosity = 0.10
merge_length = "auto"
[model]
kind = "flexible"
contact = "lobatto3"
normal = "centres"
plane = "stress"
[material.grain]
E = "25.8 GPa"
nu = 0.23
density = "2650 kg/m3"
[material.contact]
law = "bilinear"
Kn = "18.00e4 GPa/m"
eta = 0.28
sigma_nt = "8.5 MPa"
tau = "29.75 MPa"
mu = 0.40
Gfn = "20 N/m"
Gfs = "800 N/m"
[numerics]
kind = "adaptive"
accuracy = "0.5 %"
[[test]]
kind = "uniaxial-compression"
[run]
seeds = [1, 2, 3, 4, 5]
[laboratory]
UCS = "122.1 MPa"
)";

/// In place of the test of sample_job: one of the user's own.
inline const std::string custom_test = R"(kind = "custom"
name = "pull"
until = { gauge = "gap", at = "0.2 mm" }
[[test.fixture]]
name = "lower end"
kind = "boundary"
on = "bottom"
[[test.fixture]]
name = "upper end"
kind = "plate"
on = "top"
normal = [0, 1]
motion = [0, 1]
glued = true
[[test.gauge]]
name = "gap"
kind = "extension"
from = ["40 mm", "70 mm"]
to = ["40 mm", "90 mm"]
)";

/// A test of a user's own under dead loads of every kind: pressures, plates under a force and behind a spring, weight.
inline const std::string pressed_test = R"(kind = "custom"
name = "press"
gravity = "9.81 m/s2"
stages = [{ kind = "load", until = "stress", at = "5 MPa" }, { kind = "confine", fixture = "lid", sigma3 = "2 MPa", keep = "load" }, { kind = "load" }]
[[test.fixture]]
name = "floor"
kind = "plate"
on = "bottom"
normal = [0, -1]
mu = 0.3
[[test.fixture]]
name = "lid"
kind = "plate"
on = "top"
normal = [0, 1]
pressure = "1 MPa"
spring = "2 GPa/m"
[[test.fixture]]
name = "ram"
kind = "plate"
on = "left"
normal = [-1, 0]
motion = [1, 0]
[[test.fixture]]
name = "wall"
kind = "plate"
on = "right"
normal = [1, 0]
force = "12 kN"
[[test.fixture]]
name = "water"
kind = "pressure"
on = "right"
pressure = "0.5 MPa"
[[test.gauge]]
name = "lift"
kind = "displacement"
fixture = "lid"
direction = [0, 1]
)";

/// Stages of every kind that such a test can take.
inline const std::string stages = R"(stages = [
  { kind = "load", until = "stress", at = "2 MPa" },
  { kind = "hold", travel_times = 5 },
  { kind = "hold" },
  { kind = "unload", until = "load", at = "1 kN" },
  { kind = "load", until = "axial-strain", at = "0.01 %" },
  { kind = "unload" },
  { kind = "load", until = "lateral-strain", by = "0.001 %" },
  { kind = "unload", until = "share-of-peak", at = "10 %" },
  { kind = "cycle", times = 3, stages = [{ kind = "load", until = "gap", beyond = "0.01 mm" }, { kind = "unload", until = "gap", by = "0.005 mm" }] },
  { kind = "cycle", stages = [{ kind = "load", until = "stress", beyond = "1 MPa" }, { kind = "unload" }] },
]
)";
inline const std::string custom_test_in_stages = [] {
    std::string text = custom_test;
    const std::string before = "[[test.fixture]]";
    return text.insert(text.find(before), stages);
}();

/// A job of variants: the same packings modelled in several ways.
inline const std::string variant_job = R"([specimen]
shape = "rectangle"
width = "80 mm"
height = "160 mm"
[specimen.grains]
diameter = { distribution = "uniform", minimum = "2 mm", maximum = "4 mm" }
[material]
elastic_preset = "augig-rigid"
strength_preset = "augig-table2-bilinear"
[numerics]
accuracy = "1 %"
[[variant]]
name = "Rigid, bilinear"
[variant.model]
kind = "rigid"
[[variant]]
name = "flexible 25.8"
seeds = [2]
tests = ["uniaxial-compression", "biaxial"]
[variant.model]
kind = "flexible"
[variant.material]
elastic_preset = "augig-flexible"
[variant.material.grain]
nu = 0.25
[variant.numerics]
kind = "paper"
[[variant]]
name = "inner particles, edge"
[variant.model]
kind = "inner-particles"
normal = "edge"
[variant.material]
elastic_preset = "augig-inner-particles"
strength_preset = "augig-table2-brittle"
[variant.material.contact]
mu = 0.45
[[test]]
kind = "uniaxial-compression"
[[test]]
kind = "direct-tension"
[[test]]
kind = "biaxial"
sigma3 = "4 MPa"
membrane_plates = 12
[run]
seeds = [1, 2]
)";

/// What makes a rock uneven, to stand before [numerics] of sample_job.
inline const std::string uneven_material = R"([[material.phase]]
name = "quartz"
share = "60 %"
E = "94.5 GPa"
nu = 0.08
colour = "#d9d4c7"
[[material.phase]]
name = "biotite"
share = 0.4
density = "3050 kg/m3"
value = 7
[[material.pair]]
phases = ["quartz", "biotite"]
sigma_nt = "3 MPa"
Kn = "9e4 GPa/m"
eta = 0.2
tau = "11 MPa"
mu = 0.3
Gfn = "7 N/m"
Gfs = "300 N/m"
[[material.pair]]
phases = ["quartz", "quartz"]
inside = true
sigma_nt = "44 MPa"
[material.crystal]
sigma_nt = "33 MPa"
tau = "99 MPa"
Kn = "30e4 GPa/m"
eta = 0.3
mu = 0.2
Gfn = "55 N/m"
Gfs = "2000 N/m"
[material.minerals]
unlike = "mean"
unlike_strength = 0.6
cluster_length = "7 mm"
[material.scatter]
strength = { modulus = 1.6, lowest = 0.1, highest = 4 }
stiffness = { distribution = "log-normal", variation = "20 %", correlation_length = "9 mm" }
E = { distribution = "normal", variation = 0.1 }
energy_power = 1.5
[material.initial_cracks]
broken = "12 %"
opening = "0.5 um"
weakened = "7 %"
weakened_strength = 0.4
[[material.joint]]
name = "fault"
trace = [["0 mm", "20 mm"], ["40 mm", "60 mm"], ["80 mm", "70 mm"]]
mu = 0.5
opening = "1 um"
[[material.joint]]
name = "bedding"
set = { dip = "30 deg", dip_deviation = "3 deg", spacing = "15 mm", spacing_variation = "20 %", length = "30 mm", length_variation = 0.3, persistence = "70 %" }
Kn = "5e4 GPa/m"
eta = 0.4
sigma_nt = "1 MPa"
tau = "2 MPa"
Gfn = "3 N/m"
Gfs = "90 N/m"
[numerics])";

/// The sample with one line (or part of one) replaced.
inline std::string edited(const std::string& from, const std::string& to, std::string text = sample_job) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("the sample job has no '" + from + "'");
    return text.replace(at, from.size(), to);
}

}  // namespace feldspar
