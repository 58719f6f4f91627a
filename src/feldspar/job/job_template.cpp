#include "feldspar/job/job_template.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <sstream>
#include <utility>

#include "feldspar/base/error.hpp"
#include "feldspar/job/keys.hpp"
#include "feldspar/job/toml_reader.hpp"
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

constexpr std::string_view whole_laboratory = "laboratory";  // what the tests of one rock are called together
constexpr std::size_t comment_column = 36;

// A line "#= key" shows a key that may be left out, with the default and the sentence of its row (keys.hpp).
constexpr const char* common_head = R"(#
#   feldspar check JOB.toml     builds everything, prints counts, memory and expected time, and stops
#   feldspar run   JOB.toml     runs it; results go to a new directory
#
# Every quantity is text with its unit; udunits2 knows most of them (mm, m, MPa, GPa, GPa/m, N/m, kg/m3, deg, %).
# The numbers are those of the Augig granite (Monteiro Azevedo, Farinha, Oliveira 2022, Geotechnics 2, 523-548, Table 7):
# replace them with yours. A line that begins with '#' shows a key that may be left out, with its default.

[specimen]
shape = "rectangle"                 # also "disc" (diameter) and "polygon" (vertices, edge_labels)
width = "80 mm"                     # the Brazilian test cuts its own disc of this diameter
height = "160 mm"                   # the direction of loading
thickness = "80 mm"                 # out of plane; scales forces, not stresses

[specimen.grains]
diameter = { distribution = "uniform", minimum = "2 mm", maximum = "4 mm" }
# diameter = { distribution = "log-normal", median = "3 mm", log_standard_deviation = 0.2, minimum = "2 mm", maximum = "5 mm" }
# diameter = { distribution = "sieve", curve = [["2 mm", "0 %"], ["3 mm", "40 %"], ["4 mm", "100 %"]] }   # by mass passing
porosity = 0.10                     # sets the number of grains only: the grains fill the plane
#= merge_length
#= triangles_per_grain

[model]
kind = "flexible"                   # grains of elastic triangles; also "rigid" and "inner-particles", which take no E and nu
contact = "lobatto3"                # three contact points on a grain edge; "point": one in the middle
plane = "stress"                    # or "strain"

[material.grain]
E = "25.8 GPa"                      # Young's modulus of the grains
nu = 0.23                           # Poisson's ratio of the grains: above -1, below 0.5
density = "2650 kg/m3"

[material.contact]
law = "bilinear"                    # softens in two lines, dissipating Gfn, Gfs; also "bilinear-literal", "linear", "brittle"
Kn = "18.00e4 GPa/m"                # normal stiffness per area
eta = 0.28                          # shear over normal stiffness ks/kn; or kratio = kn/ks
sigma_nt = "8.5 MPa"                # tensile strength
tau = "29.75 MPa"                   # cohesion
mu = 0.40                           # friction coefficient
Gfn = "20 N/m"                      # fracture energy in tension (leave out for "brittle")
Gfs = "800 N/m"                     # fracture energy in shear (leave out for "brittle")
#= shear_measure
#= tension_unloading

[numerics]
kind = "adaptive"                   # finds its own loading rate; also "paper" (fixed speed, local damping), "dynamic" (real masses)
accuracy = "1 %"                    # wanted of a strength: 0.05 % to 10 %; looser is faster
#= confirm
# maximum_steps = 2000000           # stop there with what there is (unless given: 2000 times what such a test usually takes)
)";

constexpr const char* common_test =
    R"(#= stop_fraction
#= maximum_strain
# maximum_stress = "300 MPa"        # ... or at this stress, if one is given: the strength is then known to be higher
#= snapshots
# seeds = [1, 2, 3]                 # the packings of this test, if not all of [run]
)";

constexpr const char* compression_control =
    R"(# control = "dissipation"           # behind the peak: the platens follow a rock that fails by itself; also "displacement", "lateral-strain"
)";

constexpr const char* other_control =
    R"(# control = "displacement"          # behind the peak; "dissipation": the platens follow a rock that fails by itself
)";

constexpr const char* common_end = R"(
[run]
seeds = [1, 2, 3]                   # one packing each: the scatter between packings is part of the answer
threads = "auto"                    # as many as there are cores; the results do not depend on it
# at_once = "auto"                  # tests side by side: as many as there are threads, large specimens one after the other

[laboratory]                        # measured values, shown beside the results; leave out what you have not
E = "25.8 GPa"
nu = 0.23
UCS = "122.1 MPa"                   # uniaxial compressive strength
# DTS = "8 MPa"                     # direct tensile strength
BTS = "8.8 MPa"                     # Brazilian tensile strength
cohesion = "21.0 MPa"               # Mohr-Coulomb
friction_angle = "53.0 deg"
# hoek_brown_mi = 25                # Hoek-Brown
)";

// The [[test]] of a method.
std::string test_of(const TestMethod& method) {
    std::string kind = fmt::format("kind = \"{}\"", method.name);
    kind.resize(std::max(kind.size() + 1, comment_column), ' ');
    const char* control = method.build.gauges != nullptr ? ""
                          : method.loading.widens        ? compression_control
                                                         : other_control;  // else among its own keys
    return "\n[[test]]\n" + kind + "# " + method.job.gives + "\n" + method.job.keys + control + common_test + method.job.tables;
}

// The common head, with the method's own measures of the specimen.
std::string head_for(const TestMethod& method) {
    std::string head = common_head;
    const auto replace = [&](std::string_view line, std::string_view by) {
        if (by.empty()) return;
        const std::size_t at = head.find(line);
        head.replace(at, head.find('\n', at) - at, by);
    };
    replace("shape = \"rectangle\"", method.job.shape);
    replace("width = \"80 mm\"", method.job.width);
    replace("height = \"160 mm\"", method.job.height);
    return head;
}

std::string shown_default(const JobKey& key) {
    std::string line = fmt::format("# {} = {}", key.name, usual_text(key));
    line.resize(std::max(line.size() + 1, comment_column), ' ');
    return line + "# " + without_markup(key.meaning);
}

// The lines "#= key" written out.
std::string with_defaults(const std::string& text) {
    std::istringstream lines(text);
    std::string written;
    const KeyTable* table = &job_table("");
    for (std::string line; std::getline(lines, line);) {
        for (const KeyTable& one : job_tables())
            if (line.starts_with(one.head)) table = &one;
        written += (line.starts_with("#= ") ? shown_default(table->key(line.substr(3))) : line) + "\n";
    }
    return written;
}

std::string unfinished_template(std::string_view kind) {
    if (kind == whole_laboratory) {
        std::string tests;
        for (const std::string_view strength : {"UCS", "DTS", "BTS"}) tests += test_of(method_of_strength(strength).definition());
        return "# A whole laboratory: compression, tension, Brazilian and biaxial tests of one rock.\n" +
               std::string(common_head) + tests + test_of(method_of_confined_strength().definition()) + common_end;
    }
    const auto id = find_method(kind);
    if (!id)
        throw InputError({}, "'" + std::string(kind) + "' is not a kind of job", listed(job_template_kinds()),
                         did_you_mean(kind, job_template_kinds()));
    const TestMethod& method = id->definition();
    const std::string before = method.job.behind != nullptr ? test_of(*method.job.behind) : "";
    return fmt::format("# {}\n", method.job.title) + head_for(method) + before + test_of(method) + common_end;
}

}  // namespace

std::vector<std::string_view> job_template_kinds() {
    std::vector<std::string_view> kinds;
    for (const MethodId id : test_methods()) kinds.emplace_back(name(id));
    kinds.push_back(whole_laboratory);
    return kinds;
}

std::string job_template(std::string_view kind) { return with_defaults(unfinished_template(kind)); }

}  // namespace feldspar
