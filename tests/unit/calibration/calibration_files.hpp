// A job and a calibration of it, in a folder that goes away.
#pragma once

#include <string>

#include "../../temporary_folder.hpp"
#include "feldspar/calibration/calibration.hpp"

namespace feldspar {

inline const std::string rock_job = R"([specimen]
shape = "rectangle"
width = "40 mm"
height = "80 mm"
[specimen.grains]
diameter = { distribution = "uniform", minimum = "2 mm", maximum = "4 mm" }
[material]
elastic_preset = "augig-flexible"
strength_preset = "augig-table7"
[[test]]
kind = "uniaxial-compression"
[[test]]
kind = "direct-tension"
[[test]]
kind = "brazilian"
[[test]]
kind = "biaxial"
sigma3 = "10 MPa"
[run]
seeds = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]
)";

inline const std::string strength_unknowns = R"(
[[unknown]]
key = "material.contact.sigma_nt"
[[unknown]]
name = "tau/sigma_nt"
key = "material.contact.tau"
times = "material.contact.sigma_nt"
[[unknown]]
key = "material.contact.mu"
[[unknown]]
key = "material.contact.Gfn"
[[unknown]]
name = "Gfs/Gfn"
key = "material.contact.Gfs"
times = "material.contact.Gfn"
)";

/// With the job in it.
class CalibrationFolder : public TemporaryFolder {
public:
    CalibrationFolder() { write("rock.toml", rock_job); }

    Calibration read(const std::string& text) const {
        return parse_calibration("job = \"rock.toml\"\n" + text, path() / "targets.toml");
    }
};

}  // namespace feldspar
