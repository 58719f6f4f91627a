// A test of the user's own: the fixtures and gauges of the job. It defines no property of the rock, only its curves, cracks,
// fields and energies.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "feldspar/base/error.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/methods/beam.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/platens.hpp"

namespace feldspar::methods {
namespace {

std::vector<FixtureSpec> fixtures(const MethodInput& in) {
    std::vector<FixtureSpec> fixtures = in.test.custom.fixtures;
    const PlateContact usual = plate_contact(in);
    for (FixtureSpec& fixture : fixtures) {
        if (fixture.contact.Kn_Pa_m == 0.0) fixture.contact.Kn_Pa_m = usual.Kn_Pa_m;
        if (fixture.contact.eta == 0.0) fixture.contact.eta = usual.eta;
    }
    return fixtures;
}

// Extent of the specimen along the sum of the motions, or across it.
double extent_m(const MethodInput& in, bool across) {
    Vec2 motion;
    for (const FixtureSpec& fixture : in.test.custom.fixtures) motion += fixture.motion;
    if (across) motion = rot90(motion);
    const Box box = bounding_box(in.specimen.mesh.nodes);
    const Vec2 size = box.upper - box.lower;
    const double length = norm(motion);
    return length > 0.0 ? (std::abs(motion.x) * size.x + std::abs(motion.y) * size.y) / length : std::max(size.x, size.y);
}

double length_m(const MethodInput& in) { return in.test.custom.length_m.value_or(extent_m(in, false)); }

double section_m2(const MethodInput& in) {
    return in.test.custom.width_m.value_or(extent_m(in, true)) * in.specimen.spec.thickness_m;
}

void check(const Outline& outline, double, const TestSpec& test) {
    bool moves = false;
    Vec2 held;  // components in which something is held
    for (const FixtureSpec& fixture : test.custom.fixtures) {
        const std::string& label = fixture.part.label;
        if (!label.empty() && std::ranges::find(outline.edge_labels, label) == outline.edge_labels.end()) {
            std::string known;
            for (const std::string& one : outline.edge_labels)
                if (known.find("\"" + one + "\"") == std::string::npos) known += (known.empty() ? "\"" : ", \"") + one + "\"";
            throw InputError(
                {.key = "test.fixture"},
                fmt::format("the fixture \"{}\" is on \"{}\", which no edge of the outline is called", fixture.name, label),
                known);
        }
        moves = moves || fixture.moves();
        if (fixture.kind == FixtureKind::plate)
            held += (fixture.pressed ? Vec2{} : Vec2{std::abs(fixture.normal.x), std::abs(fixture.normal.y)}) +
                    (fixture.contact.mu > 0.0 ? Vec2{std::abs(fixture.normal.y), std::abs(fixture.normal.x)} : Vec2{});
        if (fixture.kind == FixtureKind::nodes)
            held +=
                Vec2{fixture.imposes_x || fixture.pins_middle ? 1.0 : 0.0, fixture.imposes_y || fixture.pins_middle ? 1.0 : 0.0};
    }
    if (!moves)
        throw InputError({.key = "test.fixture"}, "no fixture moves, so nothing loads the specimen",
                         "motion = [0, -1] of one fixture at least");
    for (const auto& [component, axis] : {std::pair{held.x, "x"}, {held.y, "y"}})
        if (!(component > 1e-6))
            throw InputError({.key = "test.fixture"},
                             fmt::format("nothing holds the specimen along {}: it is free to move away as a whole", axis),
                             "a fixture that holds it there: friction (mu) of a plate, pin = true, or kind = \"boundary\"");
}

std::vector<GaugeSpec> gauges(const MethodInput& in) { return in.test.custom.gauges; }

}  // namespace

const TestMethod custom{
    .name = "custom",
    .purpose = "a test of your own: fixtures and gauges as the job gives them",
    .words = {"Test of your own", "Load / (width \u00d7 thickness)", "Loading motion / length"},
    .build = {fixtures, length_m, section_m2, gauges, {}, check},
    .start = {.strained_evenly = false, .stays_in_touch = false, .time_of_mode = true},
    .reading = Reading::curve,
    .specimen = {.plates = true, .fixtures_of_job = true},
    .loading = {.control = LoadControl::dissipation},
    .rate =
        {.residual_target = 3.0, .residual_share = 1.0 / 3.0, .travel_times = 150.0, .seconds = 40.0, .fixed_speed_strain = 2e-3},
    .verdict = {.error_a = 1e-2, .imbalance_a = 2e-2, .imbalance_b = 4e-2},
    .job = {.title = "A test of your own: here a beam on four rollers.",
            .gives = "a test of your own: curves, cracks, fields, energies, and no property of the rock",
            .keys = R"(name = "beam-on-four-rollers"       # names its results
# length = "50 mm"                  # strain = loading motion / length: the specimen's extent along the loading unless given
# width = "220 mm"                  # stress = load / (width x thickness): its extent across the loading unless given
# control = "dissipation"           # behind the peak; also "displacement", or a gauge
# until = { gauge = "deflection", at = "0.5 mm" }
# stages = [{ kind = "load", until = "load", at = "10 kN" }, { kind = "unload" }, { kind = "load" }]   # in place of loading until the test ends
)",
            .tables = R"(
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
)",
            .width = beam_width_line,
            .height = beam_height_line},
};

}  // namespace feldspar::methods
