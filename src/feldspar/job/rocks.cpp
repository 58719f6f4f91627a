#include "feldspar/job/rocks.hpp"

#include <array>
#include <string>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/job/toml_reader.hpp"

namespace feldspar {
namespace {

constexpr double unknown = LiteratureRock::unknown;
constexpr std::string_view goodman =
    "Goodman, Introduction to Rock Mechanics, 2nd ed., Wiley 1989, Tables 3.1 (UCS, and UCS over tensile strength) and 6.1 (E "
    "over UCS, nu)";

// Tensile strengths and moduli of Goodman's tables are products of his ratios, written to three digits.
constexpr auto rocks = std::to_array<LiteratureRock>({
    {"augig-granite", "Monteiro Azevedo, Farinha, Oliveira 2022, Geotechnics 2, 523-548, Table 3", 25.8, 0.23, 122.1, 8.8, 21.0,
     53.0},
    {"lac-du-bonnet-granite", "Potyondy, Cundall 2004, Int. J. Rock Mech. Min. Sci. 41, 1329-1364 (after Martin 1993)", 69.0,
     0.26, 200.0, 9.3, 30.0, 59.0},
    {"nevada-granite", goodman, 73.8, 0.22, 141.1, 11.7, unknown, unknown},
    {"cedar-city-tonalite", goodman, 19.2, 0.17, 101.5, 6.38, unknown, unknown},
    {"basalt", "Schultz 1995, Rock Mech. Rock Engng. 28, 1-15: typical values of intact basalt", 78.0, 0.25, 266.0, 14.5, unknown,
     unknown},
    {"nevada-basalt", goodman, 34.9, 0.32, 148.0, 13.1, unknown, unknown},
    {"transjurane-sandstone", "UPCal experimental database, as in examples/calibration/transjurane.toml", 12.5, 0.30, 40.0, 2.8,
     8.5, 41.0},
    {"oneota-dolomite", goodman, 43.9, 0.34, 86.9, 4.41, unknown, unknown},
    {"tavernalle-limestone", goodman, 55.8, 0.30, 97.9, 3.92, unknown, unknown},
    {"cherokee-marble", goodman, 55.8, 0.25, 66.9, 1.79, unknown, unknown},
    {"micaceous-shale", goodman, 11.1, 0.29, 75.2, 2.07, unknown, unknown},
});

std::string_view kind_of(std::string_view name) {
    return name.substr(name.rfind('-') == std::string_view::npos ? 0 : name.rfind('-') + 1);
}

}  // namespace

std::span<const LiteratureRock> literature_rocks() { return rocks; }

const LiteratureRock& literature_rock(std::string_view name) {
    std::vector<std::string_view> words;
    for (const LiteratureRock& rock : rocks) {
        if (rock.name == name) return rock;
        words.push_back(rock.name);
    }
    for (const LiteratureRock& rock : rocks)
        if (kind_of(rock.name) == name) return rock;
    std::vector<std::string_view> near = words;
    for (const LiteratureRock& rock : rocks) near.push_back(kind_of(rock.name));
    throw InputError({.key = "--rock"}, "'" + std::string(name) + "' is no rock of the list",
                     listed(words) + "; or a kind of rock, such as granite", did_you_mean(name, near));
}

}  // namespace feldspar
