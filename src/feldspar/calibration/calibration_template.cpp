#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "feldspar/calibration/calibration.hpp"
#include "feldspar/job/first_job.hpp"

namespace feldspar {

std::string calibration_template() {
    return R"(# From laboratory numbers to contact parameters: with which values of the unknowns does the model show the targets (docs/calibration.md)?
#
#   feldspar calibrate CALIBRATION.toml     learns, chooses, confirms on fresh packings. It may be interrupted: the same command goes on
#
# The numbers are those of the Augig granite (Monteiro Azevedo, Farinha, Oliveira 2022, Geotechnics 2, 523-548, Table 3): replace them with yours.
# A line that begins with '#' shows a key that may be left out.

job = "rock.toml"                   # specimen, kind of grains, tests; to start from: feldspar new laboratory --out rock.toml
budget = 300                        # runs at most; one run is one test on one packing: seconds each
# seeds = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]     # packings to learn from; 1 to 20 unless given
# confirm_seeds = [1001, 1002, 1003, 1004, 1005]   # fresh ones, which confirm the answer; 1001 to 1010 unless given

[targets]                           # means over packings; leave out what you have not. The search ends when the mean of the confirming packings
                                    # will lie within each tolerance with 95 %: a tolerance below their scatter takes the whole budget
E = "25.8 GPa"
nu = 0.23
UCS = { value = "122.1 MPa", tolerance = "5 %" }    # met within its tolerance; or standard_deviation = "5 MPa"
# DTS = "8 MPa"
BTS = "8.8 MPa"                     # scatters from packing to packing, and least between the usual curved jaws (docs/job.md, plates)
# cohesion = "21 MPa"               # of a straight envelope through the uniaxial and all biaxial tests of the job
friction_angle = "53 deg"
# sigma1 = [{ sigma3 = "10 MPa", value = "210 MPa" }]

[[unknown]]                         # keys of the job; a range that is not given follows from the targets
key = "material.grain.E"
[[unknown]]
key = "material.grain.nu"
[[unknown]]
key = "material.contact.sigma_nt"
# range = ["4 MPa", "20 MPa"]
[[unknown]]
name = "tau/sigma_nt"
key = "material.contact.tau"
times = "material.contact.sigma_nt" # a multiple of what this key has
[[unknown]]
key = "material.contact.mu"
[[unknown]]
key = "material.contact.Gfn"
[[unknown]]
name = "Gfs/Gfn"
key = "material.contact.Gfs"
times = "material.contact.Gfn"
)";
}

std::string calibration_template(const ReadRock& rock) {
    // A laboratory's numbers as targets; the tolerances of the template stay, and what is no target is left out.
    constexpr std::array<std::string_view, 7> shown{"E", "nu", "UCS", "DTS", "BTS", "cohesion", "friction_angle"};
    std::vector<std::pair<std::string, std::string>> targets;
    bool friction = false, nu = false;
    for (const auto& [key, value] : rock.laboratory) {
        if (std::find(shown.begin(), shown.end(), key) == shown.end()) continue;
        friction = friction || key == "friction_angle" || key == "cohesion";
        nu = nu || key == "nu";
        targets.emplace_back(key, key == "UCS" ? fmt::format("{{ value = {}, tolerance = \"5 %\" }}", value) : value);
    }
    std::string text = with_values(calibration_template(), "targets", targets, shown);
    const std::size_t numbers = text.find("# The numbers are those of"), end = text.find('\n', numbers);
    text.replace(
        numbers, end - numbers,
        "# " + (rock.source.empty()
                    ? std::string(
                          "The targets are the numbers that were given; the job: feldspar new laboratory with the same options.")
                    : "Laboratory: " + rock.source + "."));
    // What no target tells of is no unknown.
    const auto leave_out = [&](const std::string& key, const char* wants) {
        const std::string unknown = "[[unknown]]\nkey = \"" + key + "\"\n";
        const std::size_t at = text.find(unknown);
        if (at != std::string::npos)
            text.replace(
                at, unknown.size(),
                "# [[unknown]]                       # wants a target: " + std::string(wants) + "\n# key = \"" + key + "\"\n");
    };
    if (!nu) leave_out("material.grain.nu", "nu");
    if (!friction) leave_out("material.contact.mu", "friction_angle or cohesion");
    return text;
}

}  // namespace feldspar
