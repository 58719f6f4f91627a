// Cells of another program, up to the specimen that they make. The first line is the ending of the file's name, and behind a
// blank "cut" if the outline is to be cut out of the cells.
#include "feldspar/specimen/cells_of_file.hpp"
#include "feldspar/specimen/fit_cells.hpp"
#include "feldspar/specimen/specimen.hpp"
#include "feldspar/specimen/weld_cells.hpp"
#include "fuzz.hpp"

namespace feldspar::fuzz {

void cells(std::string_view input) {
    const std::string_view how = first_line(input);
    const std::string file = how.starts_with("msh") ? "cells.msh" : how.starts_with("csv") ? "cells.csv" : "cells.tess";
    read_or_refuse([&] {
        const CellsOfFile read = read_cells(input, file);
        if (read.cells.size() > 200 || read.vertices.size() > 5000) return;  // read, but no specimen that is made in no time
        SpecimenSpec spec;
        spec.given_cells.file = file;
        spec.given_cells.unit_m = read.unit_m > 0.0 ? read.unit_m : 1e-3;
        spec.given_cells.cells =
            std::make_shared<const GivenCells>(weld_cells(read, spec.given_cells.unit_m, spec.given_cells.tolerance, file));
        spec.given_cells.cut = how.ends_with("cut");
        if (spec.given_cells.cut)
            spec.outline.width_m = spec.outline.height_m = 0.7e-3;
        else
            spec.outline = outline_of_cells(*spec.given_cells.cells, spec.given_cells.tolerance);
        spec.grain_sizes.kind = GrainSizeKind::log_normal;  // as a job has them: by these it is judged
        spec.grain_sizes.minimum_m = spec.given_cells.cells->smallest_diameter_m;
        spec.grain_sizes.median_m = spec.given_cells.cells->mean_diameter_m;
        spec.grain_sizes.maximum_m = spec.given_cells.cells->largest_diameter_m;
        (void)make_specimen(spec, 1);
    });
}

}  // namespace feldspar::fuzz
