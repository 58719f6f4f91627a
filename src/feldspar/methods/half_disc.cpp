#include "feldspar/methods/half_disc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "feldspar/base/error.hpp"
#include "feldspar/methods/beam.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar {

HalfDisc half_disc_of(const Outline& outline, double thickness_m, const TestSpec& test) {
    constexpr double kUsualSpan = 1.2;  // of the radius: q = 0.6
    const bool half =
        !outline.is_disc && outline.radius_m > 0.0 && std::ranges::find(outline.edge_labels, "flat") != outline.edge_labels.end();
    if (!half) throw InputError({.key = "test.kind"}, "the specimen is no half disc", "[specimen] shape = \"half-disc\"");
    const Box box = bounding_box(outline);
    HalfDisc disc;
    disc.radius_m = outline.radius_m;
    disc.thickness_m = thickness_m;
    disc.middle = {outline.centre.x, box.lower.y};
    disc.top_m = box.upper.y;
    disc.span_m = test.own_value("span").value_or(kUsualSpan * disc.radius_m);
    if (disc.span_m >= 2.0 * disc.radius_m)
        throw InputError(
            {.key = "test.span"},
            fmt::format("a span of {:.4g} mm is longer than the flat of {:.4g} mm", 1e3 * disc.span_m, 2e3 * disc.radius_m),
            fmt::format("less than {:.4g} mm; ISRM: 0.5 to 0.8 times the diameter", 2e3 * disc.radius_m));
    const NotchFromBelow notch = notch_from_below(outline, disc.middle.x, disc.middle.y, disc.radius_m);
    if (!(notch.depth_m > 0.0) || notch.otherwise_cut)
        throw InputError({.key = "test.kind"},
                         notch.otherwise_cut ? "the half disc has holes, or notches elsewhere than in the middle of its flat"
                                             : "the half disc has no notch",
                         fmt::format("[specimen] notches = [{{ from = [\"0 mm\", \"0 mm\"], to = [\"0 mm\", \"{:.4g} mm\"], "
                                     "width = \"1 mm\" }}], and nothing else cut out",
                                     1e3 * 0.5 * disc.radius_m));
    disc.notch_m = notch.depth_m;
    disc.notch_width_m = notch.width_m;
    return disc;
}

double half_disc_factor(double beta, double q) {
    return -1.297 + 9.516 * q - (0.47 + 16.457 * q) * beta + (1.071 + 34.401 * q) * beta * beta;
}

}  // namespace feldspar
