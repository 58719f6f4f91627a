// Where the minerals of a rock lie: a PNG picture, or a list of names.
#include "feldspar/job/rock_files.hpp"
#include "fuzz.hpp"

namespace feldspar::fuzz {

void minerals(std::string_view input) {
    std::vector<Mineral> phases(2);
    phases[0].name = "quartz";
    phases[0].colour = 0xff0000;
    phases[1].name = "feldspar";
    phases[1].colour = 0x00ff00;
    const std::string contents(input);
    read_or_refuse([&] { (void)read_phase_list(contents, "minerals.txt", phases); });
    read_or_refuse([&] { (void)read_phase_map(contents, "minerals.png", phases); });
    phases[0].value = 1;
    phases[1].value = 2;
    read_or_refuse([&] { (void)read_phase_map(contents, "minerals.png", phases); });
}

}  // namespace feldspar::fuzz
