// Direct shear: a specimen in a box of two halves, one of which moves along the other under a normal stress, or behind a spring
// (constant normal stiffness). After Muralha, Grasselli, Tatone, Bluemel, Chryssanthakis and Jiang 2014 (ISRM).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "feldspar/base/angle.hpp"
#include "feldspar/base/error.hpp"
#include "feldspar/base/regression.hpp"
#include "feldspar/geometry/polygon.hpp"
#include "feldspar/methods/method.hpp"
#include "feldspar/methods/platens.hpp"
#include "feldspar/specimen/outline.hpp"

namespace feldspar::methods {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kGauges[]{"dilation", "normal-force"};

// Of the outline, with the free zone between the halves of the box.
struct ShearBox {
    Box around;
    double middle_m = 0.0, gap_m = 0.0;

    double length_m() const { return around.upper.x - around.lower.x; }
};

ShearBox shear_box(std::span<const Vec2> outline, const TestSpec& test, double usual_gap_m) {
    ShearBox box;
    box.around = bounding_box(outline);
    box.middle_m = 0.5 * (box.around.lower.y + box.around.upper.y);
    box.gap_m = test.own_value("gap").value_or(usual_gap_m);
    return box;
}

ShearBox shear_box(const MethodInput& in) {
    return shear_box(in.specimen.outline.vertices, in.test, in.specimen.quality.mean_diameter_m);
}

FixtureSpec side(const MethodInput& in, bool left, bool upper) {
    const ShearBox box = shear_box(in);
    const double far = 10.0 * (box.length_m() + box.around.upper.y - box.around.lower.y);  // beyond every edge
    FixtureSpec wall;
    wall.name = std::string(upper ? "upper" : "lower") + (left ? " left" : " right");
    wall.kind = FixtureKind::plate;
    wall.normal = {left ? -1.0 : 1.0, 0.0};
    wall.part.facing = wall.normal;
    wall.part.inside = upper ? std::array{Vec2{-far, box.middle_m + 0.5 * box.gap_m}, Vec2{far, far}}
                             : std::array{Vec2{-far, -far}, Vec2{far, box.middle_m - 0.5 * box.gap_m}};
    wall.contact = plate_contact(in);
    if (upper) wall.motion = {1.0, 0.0};
    return wall;
}

FixtureSpec end(const MethodInput& in, bool top) {
    FixtureSpec plate;
    plate.name = plate.part.label = top ? top_label : bottom_label;
    plate.kind = FixtureKind::plate;
    plate.normal = {0.0, top ? 1.0 : -1.0};
    plate.contact = plate_contact(in);
    if (!top) return plate;
    plate.motion = {1.0, 0.0};
    plate.pressed = true;
    plate.pressure_Pa = in.test.sigma3_Pa;
    plate.spring_Pa_m = in.test.own_value("normal_stiffness").value_or(0.0);
    return plate;
}

std::vector<FixtureSpec> halves(const MethodInput& in) {
    return {side(in, true, true),   side(in, false, true), side(in, true, false),
            side(in, false, false), end(in, false),        end(in, true)};
}

double length_m(const MethodInput& in) { return shear_box(in).length_m(); }

double section_m2(const MethodInput& in) { return length_m(in) * in.specimen.spec.thickness_m; }

std::vector<GaugeSpec> gauges(const MethodInput&) {
    GaugeSpec dilation, normal;
    dilation.name = kGauges[0];
    dilation.meaning = "by how much the upper plate has been pushed up";
    dilation.fixture = top_label;
    dilation.direction = {0.0, 1.0};
    normal.name = kGauges[1];
    normal.kind = GaugeKind::force;
    normal.meaning = "force of the specimen on the upper plate";
    normal.fixture = top_label;
    normal.direction = {0.0, 1.0};
    return {dilation, normal};
}

void check(const Outline& outline, double, const TestSpec& test) {
    for (const char* label : {top_label, bottom_label})
        if (std::ranges::find(outline.edge_labels, label) == outline.edge_labels.end())
            throw InputError({.key = "test.kind"},
                             fmt::format("the specimen has no edge labelled \"{}\", on which a shear box presses", label),
                             "shape = \"rectangle\", or a polygon with edges labelled \"top\" and \"bottom\" and upright sides");
    const ShearBox box = shear_box(outline.vertices, test, 0.0);
    const double height_m = box.around.upper.y - box.around.lower.y;
    constexpr double kLeastHalf = 0.25;  // of the height, that each half of the box must hold
    if (box.gap_m > (1.0 - 2.0 * kLeastHalf) * height_m)
        throw InputError(
            {.key = "test.gap"},
            fmt::format("a gap of {:.4g} mm leaves little of a specimen {:.4g} mm high to hold", 1e3 * box.gap_m, 1e3 * height_m),
            fmt::format("at most {:.4g} mm", 1e3 * (1.0 - 2.0 * kLeastHalf) * height_m));
    for (std::size_t k = 0; k < outline.vertices.size(); ++k) {
        const Vec2 a = outline.vertices[k], b = outline.vertices[(k + 1) % outline.vertices.size()];
        const bool upright = std::abs(b.x - a.x) <= 1e-6 * height_m, level = std::abs(b.y - a.y) <= 1e-6 * height_m;
        if (!upright && !level && std::abs(b.y - a.y) > std::abs(b.x - a.x))
            throw InputError({.key = "test.kind"},
                             "a side of the specimen is not upright, so the halves of a shear box do not fit it",
                             "shape = \"rectangle\", or a polygon with upright sides");
    }
}

// What a row shows of the plane, whose two faces have moved apart (P59).
struct OnPlane {
    double shear_m = 0.0, dilation_m = 0.0, shear_Pa = 0.0, normal_Pa = 0.0;
};

class ShearRecord {
public:
    explicit ShearRecord(const MethodReading& reading) : r_(reading.result), peak_row_(reading.peak_row) {
        dilation_ = gauge_number(r_.gauges, kGauges[0]);
        normal_ = gauge_number(r_.gauges, kGauges[1]);
        for (std::size_t i = 0; i < r_.history.size(); ++i)
            if (r_.history[i].phase != Phase::consolidation && first_ == kNoRow)
                first_ = i > 0 ? i - 1 : i;  // the row under the normal stress alone
    }
    static constexpr std::size_t kNoRow = static_cast<std::size_t>(-1);

    bool empty() const { return dilation_ < 0 || normal_ < 0 || first_ == kNoRow || peak_row_ <= first_; }
    std::size_t first() const { return first_; }
    std::size_t peak() const { return peak_row_; }
    std::size_t rows() const { return r_.history.size(); }
    OnPlane at(std::size_t row) const {
        const HistoryRow &now = r_.history[row], &start = r_.history[first_];
        OnPlane p;
        p.shear_m = now.platen_displacement_m - start.platen_displacement_m;
        p.dilation_m = value(now, dilation_) - value(start, dilation_);
        const double left = r_.length_m / (r_.length_m - p.shear_m);
        p.shear_Pa = left * now.axial_stress_Pa;
        p.normal_Pa = left * value(now, normal_) / r_.section_m2;
        return p;
    }

private:
    static double value(const HistoryRow& row, int gauge) {
        return static_cast<std::size_t>(gauge) < row.gauges.size() ? row.gauges[static_cast<std::size_t>(gauge)] : 0.0;
    }

    const TestResult& r_;
    std::size_t peak_row_, first_ = kNoRow;
    int dilation_ = -1, normal_ = -1;
};

double shear_strength_Pa(const MethodReading& r) {
    const ShearRecord record(r);
    return record.empty() || !r.peak_reached ? kNone : record.at(record.peak()).shear_Pa;
}

double normal_stress_Pa(const MethodReading& r) {
    const ShearRecord record(r);
    return record.empty() ? kNone : record.at(record.peak()).normal_Pa;
}

// Rows of the end (P60): the last fifth of the way, of a test that has gone to three times that of the peak at least.
constexpr double kEndShare = 0.8, kFarBeyond = 3.0;

template <class Value>
double at_the_end(const MethodReading& r, Value value) {
    const ShearRecord record(r);
    if (record.empty() || !r.peak_reached) return kNone;
    const double whole = record.at(record.rows() - 1).shear_m;
    if (whole < kFarBeyond * record.at(record.peak()).shear_m) return kNone;
    double sum = 0.0, way = 0.0;  // rows come closer where more happens: they count by their way
    for (std::size_t row = record.peak() + 1; row < record.rows(); ++row) {
        const OnPlane before = record.at(row - 1), now = record.at(row);
        const double step = now.shear_m - before.shear_m;
        if (now.shear_m < kEndShare * whole || step <= 0.0) continue;
        sum += step * value(now);
        way += step;
    }
    return way > 0.0 ? sum / way : kNone;
}

double residual_strength_Pa(const MethodReading& r) {
    return at_the_end(r, [](const OnPlane& p) { return p.shear_Pa; });
}
double residual_normal_Pa(const MethodReading& r) {
    return at_the_end(r, [](const OnPlane& p) { return p.normal_Pa; });
}

// (P61): slope of the dilation over the way, by least squares where the shear stress is within 5 % of its peak.
double dilation_angle_deg(const MethodReading& r) {
    constexpr double kNear = 0.95;
    const ShearRecord record(r);
    if (record.empty() || !r.peak_reached) return kNone;
    const double least = kNear * record.at(record.peak()).shear_Pa;
    std::size_t begin = record.peak(), end = record.peak() + 1;
    while (begin > record.first() + 1 && record.at(begin - 1).shear_Pa >= least) --begin;
    while (end < record.rows() && record.at(end).shear_Pa >= least) ++end;
    std::vector<double> shear_m, dilation_m;
    for (std::size_t row = begin; row < end; ++row) {
        const OnPlane p = record.at(row);
        shear_m.push_back(p.shear_m);
        dilation_m.push_back(p.dilation_m);
    }
    constexpr std::size_t kLeast = 3;
    return shear_m.size() >= kLeast ? in_degrees(std::atan(regression_line(shear_m, dilation_m).slope)) : kNone;
}

// (P62): secant at half the peak.
double shear_stiffness_Pa_m(const MethodReading& r) {
    const ShearRecord record(r);
    if (record.empty()) return kNone;
    const double start = record.at(record.first()).shear_Pa, wanted = start + 0.5 * (record.at(record.peak()).shear_Pa - start);
    for (std::size_t row = record.first(); row <= record.peak(); ++row) {
        const OnPlane p = record.at(row);
        if (p.shear_Pa >= wanted && p.shear_m > 0.0) return (p.shear_Pa - start) / p.shear_m;
    }
    return kNone;
}

constexpr QuantityUnit kStiffness{"Pa_m", "GPa_m", GPa, Dimension::stiffness_gradient};

constexpr MethodProperty kProperties[]{
    {"shear_strength", units::stress, "(P59)", shear_strength_Pa, "Shear strength"},
    {"shear_normal_stress", units::stress, "(P59)", normal_stress_Pa, "Normal stress at the shear strength"},
    {"shear_strength_residual", units::stress, "(P60)", residual_strength_Pa, "Residual shear strength"},
    {"shear_normal_stress_residual", units::stress, "(P60)", residual_normal_Pa, "Normal stress of the residual shear strength"},
    {"dilation_angle", units::angle, "(P61)", dilation_angle_deg, "Angle of dilation at the shear strength"},
    {"shear_stiffness", kStiffness, "(P62)", shear_stiffness_Pa_m, "Shear stiffness, secant at half the shear strength"},
};

constexpr MethodKey kKeys[]{
    {.name = "normal_stiffness",
     .dimension = Dimension::stiffness_gradient,
     .range = not_negative,
     .usual = "the normal stress stays",
     .meaning = "of the spring behind the upper plate: the normal stress grows by so much as the specimen dilates"},
    {.name = "gap",
     .dimension = Dimension::length,
     .usual = "the mean grain diameter",
     .meaning = "free height between the halves of the box"},
};

}  // namespace

const TestMethod direct_shear{
    .name = "direct-shear",
    .purpose = "a specimen in a box of two halves, one moved along the other under a normal stress or behind a spring",
    .words = {"Direct shear", "Shear stress on the whole plane", "Shear displacement / length of the plane"},
    .build = {halves, length_m, section_m2, gauges, kGauges, check},
    .start = {.strained_evenly = false, .stays_in_touch = false, .time_of_mode = true},
    .reading = Reading::curve,
    .specimen = {.sheared = true, .plates = true},
    .loading = {.control = LoadControl::dissipation, .stop_fraction = 0.01},
    .rate = {.travel_times = 300.0, .seconds = 60.0, .fixed_speed_strain = 2e-2},
    .verdict = {.error_a = 1e-2, .imbalance_a = 2e-2, .imbalance_b = 4e-2},
    .properties_table = "direct_shear",
    .properties = kProperties,
    .keys = kKeys,
    .job =
        {.title = "Direct shear on the packing of each seed.",
         .gives =
             "one half of the specimen moved along the other under a normal stress: shear strength, residual strength, dilation",
         .keys = R"(normal_stress = ["2 MPa", "5 MPa"] # one test for each; two or more give cohesion and friction angle
# normal_stiffness = "5 GPa/m"      # the normal stress grows by so much as the specimen dilates (constant normal stiffness)
# gap = "3 mm"                      # free height between the halves of the box; the mean grain diameter unless given
# The residual strength needs three times the way of the peak: see maximum_strain, in shares of the length.
)",
         .width = R"(width = "80 mm"                     # length of the plane that is sheared)",
         .height = R"(height = "40 mm"                    # half of it in each half of the box)"},
};

}  // namespace feldspar::methods
