// A test of the user's own: the fixtures and gauges of the job. It defines no property of the rock, only its curves, cracks, fields and energies.
#include <algorithm>
#include <cmath>

#include "feldspar/geometry/polygon.hpp"
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

double section_m2(const MethodInput& in) { return in.test.custom.width_m.value_or(extent_m(in, true)) * in.specimen.spec.thickness_m; }

std::vector<GaugeSpec> gauges(const MethodInput& in) { return in.test.custom.gauges; }

}  // namespace

const TestMethod custom{
    .kind = TestKind::custom,
    .purpose = "a test of your own: fixtures and gauges as the job gives them",
    .words = {"Test of your own", "Load over width times thickness", "Loading motion over length"},
    .build = {fixtures, length_m, section_m2, gauges},
    .start = {.strained_evenly = false, .stays_in_touch = false, .time_of_mode = true},
    .reading = Reading::curve,
    .specimen = {},
    .loading = {.control = LoadControl::dissipation},
    .rate = {.residual_target = 3.0, .residual_share = 1.0 / 3.0, .travel_times = 150.0, .seconds = 8.0, .fixed_speed_strain = 2e-3},
    .verdict = {.error_a = 1e-2, .imbalance_a = 2e-2, .imbalance_b = 4e-2},
};

}  // namespace feldspar::methods
