// A job of a few dozen grains whose tests take a fraction of a second, and a study of it, in a directory that goes away.
#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <stdlib.h>

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

class StudyFolder {
public:
    StudyFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "feldspar-study-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary directory");
        path_ = name;
        write("job.toml", small_job);
    }
    StudyFolder(const StudyFolder&) = delete;
    StudyFolder& operator=(const StudyFolder&) = delete;
    ~StudyFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name, std::ios::binary) << text; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

}  // namespace feldspar
