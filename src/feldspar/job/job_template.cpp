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

namespace feldspar {
namespace {

constexpr std::array<std::string_view, 9> kinds{"uniaxial-compression", "direct-tension", "biaxial", "brazilian", "three-point-bend", "semi-circular-bend", "hole-compression", "custom", "laboratory"};

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
# maximum_steps = 2000000           # stop there with what there is (no limit unless given)
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

std::string uniaxial_test() {
    return std::string(R"(
[[test]]
kind = "uniaxial-compression"       # gives E, nu, UCS, crack initiation and crack damage stress
)") + compression_control + common_test;
}

std::string tension_test() {
    return std::string(R"(
[[test]]
kind = "direct-tension"             # gives the direct tensile strength DTS
)") + other_control + common_test;
}

std::string biaxial_test() {
    return std::string(R"(
[[test]]
kind = "biaxial"                    # isotropic consolidation, then axial loading at constant sigma3
sigma3 = ["4 MPa", "10 MPa"]        # one test for each; with a uniaxial test they give cohesion, friction angle and mi
)") + compression_control + common_test;
}

std::string brazilian_test() {
    return std::string(R"(
[[test]]
kind = "brazilian"                  # a disc pressed between two jaws: gives the indirect tensile strength BTS
# diameter = "80 mm"                # of the disc; the specimen's width unless given
# plates = "curved"                 # jaws of 1.5 times the disc's radius (jaw_radius), as ISRM suggests; or "flat"
# plate_Kn = "1600 GPa/m"           # of what lies between jaw and disc: a layer of masking tape. Flat plates are as hard as the contacts unless it is given
# disc = "whole"                    # or "flattened": two flats, each of flat_angle = "20 deg" seen from the centre (10 to 40 deg), between flat plates
# plate_mu = 0.4                    # friction between plates and disc
)") + other_control + common_test;
}

std::string bending_test() {
    return std::string(R"(
[[test]]
kind = "three-point-bend"           # a beam that lies along x: flexural strength and modulus; with a notch K_Ic and work of fracture
# span = "200 mm"                   # distance of the two supports; 4 times the height unless given, at most 0.9 of the length
# roller_radius = "5 mm"            # of the three rollers; a tenth of the height unless given
# control = "dissipation"           # behind the peak; also "displacement", or a gauge: "CMOD" of a notched beam, "deflection"
# until = { gauge = "CMOD", at = "0.3 mm" }   # ends the test there
)") + common_test;
}

std::string half_disc_test() {
    return std::string(R"(
[[test]]
kind = "semi-circular-bend"         # a notched half disc on two rollers: K_Ic and work of fracture
# span = "48 mm"                    # distance of the two supports; 1.2 radii unless given (ISRM: 0.5 to 0.8 diameters)
# roller_radius = "4 mm"            # of the three rollers; a tenth of the radius unless given
# control = "dissipation"           # behind the peak; also "displacement", or the gauge "CMOD", the opening of the notch's mouth
# until = { gauge = "CMOD", at = "0.2 mm" }   # ends the test there
)") + common_test;
}

std::string hole_test() {
    return std::string(R"(
[[test]]
kind = "hole-compression"           # a plate with a round hole: stress at its edge, first cracks, breakouts
# sigma3 = "4 MPa"                  # pressure on the sides of the plate, or a list; none unless given
# control = "dissipation"           # behind the peak; also "displacement", or a gauge: "side-stress", "pole-stress"
# until = { gauge = "side-stress", at = "200 MPa" }   # ends the test there
)") + common_test;
}

std::string custom_test() {
    return std::string(R"(
[[test]]
kind = "custom"                     # a test of your own: curves, cracks, fields, energies, and no property of the rock
name = "four-point-bend"            # names its results
# length = "50 mm"                  # strain = loading motion / length: the specimen's extent along the loading unless given
# width = "220 mm"                  # stress = load / (width x thickness): its extent across the loading unless given
# control = "dissipation"           # behind the peak; also "displacement", or a gauge
# until = { gauge = "deflection", at = "0.5 mm" }
)") + common_test + R"(
[[test.fixture]]                    # what loads the specimen: "roller", flat "plate", hollow "jaw", or "boundary", which its own nodes follow
name = "left load"
kind = "roller"
at = ["80 mm", "50 mm"]             # where it touches
radius = "5 mm"
normal = [0, 1]                     # from the specimen into the roller: up
motion = [0, -1]                    # it comes down; without motion it is at rest
mu = 0.4                            # keeps the beam from sliding away

[[test.fixture]]
name = "right load"
kind = "roller"
at = ["140 mm", "50 mm"]
radius = "5 mm"
normal = [0, 1]
motion = [0, -1]
mu = 0.4

[[test.fixture]]
name = "left support"
kind = "roller"
at = ["20 mm", "0 mm"]
radius = "5 mm"
normal = [0, -1]

[[test.fixture]]
name = "right support"
kind = "roller"
at = ["200 mm", "0 mm"]
radius = "5 mm"
normal = [0, -1]

[[test.gauge]]                      # what is read: "extension" or "strain" between two points, "displacement" of a point, "force" on a fixture
name = "deflection"
kind = "displacement"
at = ["110 mm", "0 mm"]
direction = [0, -1]                 # downwards
)";
}

// The common head with some lines in place of others, each known by its beginning.
std::string head_with(std::initializer_list<std::pair<std::string_view, std::string_view>> lines) {
    std::string head = common_head;
    for (const auto& [line, by] : lines) {
        const std::size_t at = head.find(line);
        head.replace(at, head.find('\n', at) - at, by);
    }
    return head;
}

std::string half_disc_head() {
    return head_with({{"shape = \"rectangle\"", "shape = \"half-disc\"                 # stands on its flat, whose middle is (0, 0)"},
                      {"width = \"80 mm\"", "diameter = \"80 mm\"                  # ISRM: at least 76 mm, or ten grains"},
                      {"height = \"160 mm\"", "notches = [{ from = [\"0 mm\", \"0 mm\"], to = [\"0 mm\", \"20 mm\"], width = \"1 mm\" }]   # 0.4 to 0.6 of the radius"}});
}

std::string hole_head() {
    return head_with({{"height = \"160 mm\"", "height = \"160 mm\"                   # the direction of loading\n"
                                               "holes = [{ centre = [\"40 mm\", \"80 mm\"], diameter = \"24 mm\" }]"}});
}

// An upright specimen becomes a beam.
std::string beam_head() {
    return head_with({{"width = \"80 mm\"", "width = \"220 mm\"                    # along the beam"},
                      {"height = \"160 mm\"", "height = \"50 mm\"                    # the load acts downwards\n"
                                     "# notches = [{ from = [\"110 mm\", \"0 mm\"], to = [\"110 mm\", \"15 mm\"], width = \"1 mm\" }]   # sawn slits; \"0 mm\": a cut"}});
}

constexpr std::size_t comment_column = 36;

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
    if (kind == "uniaxial-compression") return "# A uniaxial compression test.\n" + std::string(common_head) + uniaxial_test() + common_end;
    if (kind == "direct-tension") return "# A direct tension test.\n" + std::string(common_head) + tension_test() + common_end;
    if (kind == "brazilian") return "# A Brazilian test.\n" + std::string(common_head) + brazilian_test() + common_end;
    if (kind == "biaxial")  // the envelope needs the uniaxial point
        return "# Biaxial tests at two confining stresses and a uniaxial one: the strength envelope.\n" + std::string(common_head) + uniaxial_test() + biaxial_test() + common_end;
    if (kind == "three-point-bend") return "# Three-point bending of a beam on the packing of each seed.\n" + beam_head() + bending_test() + common_end;
    if (kind == "semi-circular-bend") return "# Semi-circular bending of a notched half disc on the packing of each seed.\n" + half_disc_head() + half_disc_test() + common_end;
    if (kind == "hole-compression") return "# A plate with a round hole in compression.\n" + hole_head() + hole_test() + common_end;
    if (kind == "custom") return "# A test of your own: here a beam on four rollers.\n" + beam_head() + custom_test() + common_end;
    if (kind == "laboratory")
        return "# A whole laboratory: compression, tension, Brazilian and biaxial tests of one rock.\n" + std::string(common_head) + uniaxial_test() + tension_test() + brazilian_test() +
               biaxial_test() + common_end;
    throw InputError({}, "'" + std::string(kind) + "' is not a kind of job", listed(kinds), did_you_mean(kind, kinds));
}

}  // namespace

std::vector<std::string_view> job_template_kinds() { return {kinds.begin(), kinds.end()}; }

std::string job_template(std::string_view kind) { return with_defaults(unfinished_template(kind)); }

}  // namespace feldspar
