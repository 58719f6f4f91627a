// Brazilian test: BTS, the indirect tensile strength of a disc (ISRM 1978; ASTM D3967; flattened: Wang and Xing 1999).
#include <numbers>

#include "feldspar/base/error.hpp"
#include "feldspar/methods/flattened_disc.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/platens.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar::methods {
namespace {

const Outline& disc_of(const MethodInput& in) {
    if (!in.specimen.outline.is_disc) throw InputError({}, "a Brazilian test needs a disc");
    return in.specimen.outline;
}

FixtureSpec jaw(const MethodInput& in, bool top) {
    const Outline& disc = disc_of(in);
    FixtureSpec plate;
    plate.name = top ? top_label : bottom_label;
    plate.kind = FixtureKind::plate;
    plate.normal = {0.0, top ? 1.0 : -1.0};
    plate.part.facing = plate.normal;
    plate.motion = {0.0, top ? -1.0 : 0.0};
    plate.contact = plate_contact(in);
    plate.touch = Touch::under_circle;
    plate.axis = disc.centre;
    plate.flat_label = top ? top_label : bottom_label;  // which the edges of a whole disc do not have
    if (in.test.plates == PlateShape::curved) plate.radius_m = in.test.jaw_radius * disc.radius_m;
    return plate;
}

std::vector<FixtureSpec> jaws(const MethodInput& in) { return {jaw(in, true), jaw(in, false)}; }

double diameter_m(const MethodInput& in) {
    const Outline& disc = disc_of(in);
    return 2.0 * (disc.flattened() ? disc.flat_height_m : disc.radius_m);
}

// pi D t / (2 k), so that stress = k 2P / (pi D t); k = 1 but for flattened discs.
double section_m2(const MethodInput& in) {
    const Outline& disc = disc_of(in);
    double section = 0.5 * std::numbers::pi * 2.0 * disc.radius_m * in.specimen.spec.thickness_m;
    if (disc.flattened()) section /= flat_coefficient(in.specimen, in.model, in.grain, in.contact, in.test);
    return section;
}

}  // namespace

const TestMethod brazilian{
    .name = "brazilian",
    .purpose = "a disc pressed between two jaws until it splits",
    .words = {"Brazilian test", "2P / (πDt)", "Approach of the plates / diameter"},
    .build = {jaws, diameter_m, section_m2, nullptr, {}, nullptr},
    .start = {.stays_in_touch = false},
    .reading = Reading::disc,
    .specimen = {.own_disc = true, .plate_mu = 0.4, .plates = true},
    .loading = {.tensile = true, .failure_state = {{-1.0, 3.0}}},
    .rate = {.residual_target = 3.0, .residual_share = 1.0 / 3.0, .travel_times = 250.0, .seconds = 8.0},
    .verdict = {.error_a = 1e-2, .imbalance_a = 3e-2, .imbalance_b = 5e-2},
    .strength = {"BTS", "Brazilian tensile strength"},
    .job = {.title = "A Brazilian test.",
            .gives = "a disc pressed between two jaws: gives the indirect tensile strength BTS",
            .keys = R"(# diameter = "80 mm"                # of the disc; the specimen's width unless given
# plates = "curved"                 # jaws of 1.5 times the disc's radius (jaw_radius), as ISRM suggests; or "flat"
# plate_Kn = "1600 GPa/m"           # of what lies between jaw and disc: a layer of masking tape. Flat plates are as hard as the contacts unless it is given
# disc = "whole"                    # or "flattened": two flats, each of flat_angle = "20 deg" seen from the centre (10 to 40 deg), between flat plates
# plate_mu = 0.4                    # friction between plates and disc
)"},
};

}  // namespace feldspar::methods
