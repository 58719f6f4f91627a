// A packing file for a specimen, up to its cells and mesh. The first line says for which: "rectangle", "disc", "flats" or "hole".
#include "feldspar/specimen/outline.hpp"
#include "feldspar/specimen/specimen.hpp"
#include "fuzz.hpp"

namespace feldspar::fuzz {
namespace {

SpecimenSpec specimen_named(std::string_view name) {
    SpecimenSpec spec;
    spec.grain_sizes.minimum_m = 0.002;
    spec.grain_sizes.maximum_m = 0.004;
    spec.outline.width_m = spec.outline.height_m = spec.outline.diameter_m = 0.02;
    if (name == "disc" || name == "flats") spec.outline.shape = Shape::disc;
    if (name == "flats") spec.outline.flat_angle_rad = 0.4;
    if (name == "hole") spec.outline.holes.push_back({{0.01, 0.01}, 0.008, {}, {}});
    return spec;
}

}  // namespace

void packing(std::string_view input) {
    SpecimenSpec spec = specimen_named(first_line(input));
    spec.packing_file = file_with("packing.txt", input);
    read_or_refuse([&] {
        if (load_packing(spec.packing_file, make_outline(spec)).centres.size() <= 200) (void)make_specimen(spec, 1);
    });
}

}  // namespace feldspar::fuzz
