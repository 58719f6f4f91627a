// Cells of another program in a job, up to the specimen that they make. The first line is the ending of the file's name, and behind a blank "cut" if the outline is to be cut out of the cells.
#include "feldspar/job/job.hpp"
#include "fuzz.hpp"

namespace feldspar::fuzz {

void cells(std::string_view input) {
    const std::string_view how = first_line(input);
    std::string ending = how.starts_with("msh") ? "msh" : how.starts_with("csv") ? "csv" : "tess";
    const std::filesystem::path file = file_with("cells." + ending, input);
    const std::string outline = how.ends_with("cut") ? "shape = \"rectangle\"\nwidth = \"0.7 mm\"\nheight = \"0.7 mm\"\n" : "shape = \"from-file\"\n";
    read_or_refuse([&] {
        const Job job = parse_job("[specimen]\n" + outline + "[specimen.grains]\nfile = \"" + file.string() + "\"\n" +
                                      (input.find("_mm") != std::string_view::npos ? "" : "unit = \"mm\"\n") + "[material]\nelastic_preset = \"augig-flexible\"\nstrength_preset = \"augig-table7\"\n[[test]]\nkind = \"uniaxial-compression\"\n",
                                  "job.toml");
        if (job.specimen.given_cells.cells->cells.size() <= 200) (void)make_specimen(job.specimen, 1);
    });
}

}  // namespace feldspar::fuzz
