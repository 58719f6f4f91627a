// A job and a calibration of it, in a directory that goes away.
#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <stdlib.h>

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

class CalibrationFolder {
public:
    CalibrationFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "feldspar-calibration-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary directory");
        path_ = name;
        std::ofstream(path_ / "rock.toml", std::ios::binary) << rock_job;
    }
    CalibrationFolder(const CalibrationFolder&) = delete;
    CalibrationFolder& operator=(const CalibrationFolder&) = delete;
    ~CalibrationFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    Calibration read(const std::string& text) const { return parse_calibration("job = \"rock.toml\"\n" + text, path_ / "targets.toml"); }

private:
    std::filesystem::path path_;
};

}  // namespace feldspar
