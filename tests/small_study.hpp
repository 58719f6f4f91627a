// A job of a few dozen grains whose tests take a fraction of a second, and a study of it, in a folder that goes away.
#pragma once

#include <string>

#include "temporary_folder.hpp"

namespace feldspar {

inline const std::string small_job = R"([specimen]
shape = "rectangle"
width = "12 mm"
height = "24 mm"
[specimen.grains]
diameter = { distribution = "uniform", minimum = "2 mm", maximum = "4 mm" }
[material]
elastic_preset = "augig-flexible"
strength_preset = "augig-table7"
[numerics]
accuracy = "5 %"
[[test]]
kind = "uniaxial-compression"
[[test]]
kind = "direct-tension"
[run]
seeds = [1, 2]
threads = 1
[laboratory]
UCS = "120 MPa"
)";

/// With the job in it.
class StudyFolder : public TemporaryFolder {
public:
    StudyFolder() { write("job.toml", small_job); }
};

}  // namespace feldspar
