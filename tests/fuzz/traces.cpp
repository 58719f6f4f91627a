// Traces of joints, CSV or DXF. The first line is the ending of the file's name, a unit and a layer, each perhaps empty, with
// blanks between them.
#include <cmath>

#include "feldspar/job/rock_files.hpp"
#include "fuzz.hpp"

namespace feldspar::fuzz {

void traces(std::string_view input) {
    const std::string_view how = first_line(input);
    const std::string file = how.starts_with("dxf") ? "joints.dxf" : "joints.csv",
                      unit = how.find("mm") != std::string_view::npos ? "mm" : "",
                      layer = how.ends_with("joints") ? "joints" : "";
    read_or_refuse([&] {
        for (const auto& line : read_traces(std::string(input), file, unit, layer).lines_m) {
            if (line.size() < 2) throw Fault("a trace of one point");
            for (const Vec2 at : line)
                if (!std::isfinite(at.x) || !std::isfinite(at.y)) throw Fault("a trace goes through a place that is no number");
        }
    });
}

}  // namespace feldspar::fuzz
